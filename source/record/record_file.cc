// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/record/record_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>

#include <fcntl.h>
#include <unistd.h>

namespace retroforge
{
  namespace
  {
    namespace fs = std::filesystem;

    std::string finished_file(const std::string &directory)
    {
      return directory + "/record.h5";
    }

    std::string segments(const std::string &directory)
    {
      return directory + "/record";
    }

    std::string header_file(const std::string &directory)
    {
      return segments(directory) + "/header.h5";
    }

    std::string increment_file(const std::string &directory, const unsigned int i)
    {
      return segments(directory) + "/" + increment_name(i) + ".h5";
    }

    bool is_file(const std::string &file)
    {
      std::error_code ignored;
      return fs::is_regular_file(file, ignored);
    }

    [[noreturn]] void throw_write_error(const std::string &file, const hdf5::Failure &failure)
    {
      const int  number = failure.error_number;
      const bool full   = number == ENOSPC || number == EDQUOT || number == EFBIG;
      throw Error(file,
                  std::string("cannot be written: ") + failure.what(),
                  "the record of a run needs a folder that may be written to and has space",
                  full ? "free space there and go on with --resume: finished increments are kept"
                       : "choose a folder you may write to with --output DIR");
    }

    void check_system(const bool ok)
    {
      if (!ok)
        throw hdf5::Failure(std::strerror(errno), errno);
    }

    /// Brings a file or folder to the disk.
    void sync(const std::string &path)
    {
      const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
      check_system(descriptor >= 0);
      const int result = ::fsync(descriptor), error = errno;
      ::close(descriptor);
      errno = error;
      check_system(result == 0 || error == EINVAL); // some file systems cannot sync a folder
    }

    std::string folder_of(const std::string &file)
    {
      const std::string folder = fs::path(file).parent_path().string();
      return folder.empty() ? "." : folder;
    }

    void write_bytes(const std::string &file, const char *bytes, const std::size_t size)
    {
      const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
      check_system(descriptor >= 0);
      std::size_t done  = 0;
      int         error = 0;
      while (done < size && error == 0)
      {
        const ssize_t n = ::write(descriptor, bytes + done, size - done);
        if (n > 0)
          done += n;
        else if (n == 0 || errno != EINTR)
          error = n == 0 ? ENOSPC : errno;
      }
      if (::close(descriptor) != 0 && error == 0) // network file systems report a full disk here
        error = errno;
      errno = error;
      check_system(error == 0);
    }

    /// Makes the file whole or not at all; on return it is on disk.
    void write_whole(const std::string &file, const std::function<void(hid_t)> &fill)
    {
      hdf5::silence();
      const std::string aside = file + ".tmp";
      try
      {
        hdf5::MemoryFile image;
        fill(image);
        image.close();
        write_bytes(aside, image.data(), image.size());
        sync(aside);
        check_system(std::rename(aside.c_str(), file.c_str()) == 0);
        sync(folder_of(file));
      }
      catch (const hdf5::Failure &failure)
      {
        std::remove(aside.c_str());
        throw_write_error(file, failure);
      }
    }

    /// Opens a file of a record and reads from it.
    template <typename Result>
    Result read_whole(const std::string &file, const std::function<Result(hid_t)> &get)
    {
      hdf5::silence();
      try
      {
        const hdf5::Handle handle = hdf5::open_file(file);
        return get(handle);
      }
      catch (const hdf5::Failure &failure)
      {
        throw Error(file,
                    std::string("cannot be read: ") + failure.what(),
                    "a record must be whole and readable, as retroforge wrote it",
                    "restore it from a copy, or run the simulation again");
      }
    }

    void remove_file(const std::string &file)
    {
      std::error_code error;
      fs::remove(file, error);
      if (error)
        throw_write_error(file, hdf5::Failure(error.message(), error.value()));
    }

    /// Removes what the folder of segments holds of `first` and later increments, and leftovers of writing.
    void remove_increments(const std::string &directory, const unsigned int first)
    {
      std::error_code          error;
      std::vector<std::string> files;
      for (fs::directory_iterator entry(segments(directory), error), end; !error && entry != end;
           entry.increment(error))
      {
        const std::string name    = entry->path().filename().string();
        const bool        is_ours = name.rfind("increment_", 0) == 0 || name == "header.h5.tmp";
        const bool is_late = entry->path().extension() == ".tmp" || name >= increment_name(first) + ".h5";
        if (is_ours && is_late)
          files.push_back(entry->path().string());
      }
      for (const std::string &file : files)
        remove_file(file);
    }

    /// First the header: what remains when this is interrupted is no record, or the finished one.
    void remove_segments(const std::string &directory)
    {
      remove_file(header_file(directory));
      remove_increments(directory, 0);
    }

    void copy_object(const std::string &from, const std::string &name, const hid_t to)
    {
      const hdf5::Handle source = hdf5::open_file(from);
      hdf5::check(H5Ocopy(source, name.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), from);
    }

    void make_folder(const std::string &folder)
    {
      std::error_code error;
      fs::create_directories(folder, error);
      if (error)
        throw_write_error(folder, hdf5::Failure(error.message(), error.value()));
    }
  } // namespace

  RecordWriter::RecordWriter(const std::string &directory, const RecordHeader &header)
      : RecordWriter(directory, RecordShape(header), 0)
  {
    make_folder(segments(directory));
    remove_segments(directory);
    remove_file(finished_file(directory));
    write_whole(header_file(directory), [&](const hid_t file) { write_header(file, header); });
  }

  RecordWriter::RecordWriter(const std::string &directory,
                             const RecordShape &shape,
                             const unsigned int n_increments)
      : directory_(directory), shape_(shape), n_increments_(n_increments)
  {
  }

  RecordWriter RecordWriter::resume(const std::string &directory)
  {
    const RecordReader reader(directory);
    if (reader.finished())
      throw Error(finished_file(directory),
                  "is the record of a finished run",
                  "only a run that was stopped can go on",
                  "leave out --resume, or choose another folder with --output DIR");
    remove_increments(directory, reader.n_increments());
    return RecordWriter(directory, RecordShape(reader.header()), reader.n_increments());
  }

  void RecordWriter::reopen(const std::string &directory)
  {
    const unsigned int n    = RecordReader(directory).n_increments();
    const std::string  from = finished_file(directory);
    make_folder(segments(directory));
    remove_segments(directory);
    for (unsigned int i = 0; i < n; ++i)
      write_whole(increment_file(directory, i),
                  [&](const hid_t file) { copy_object(from, increment_name(i), file); });
    write_whole(header_file(directory), [&](const hid_t file) { copy_object(from, "header", file); });
    remove_file(from);
  }

  void RecordWriter::write(const IncrementRecord &increment)
  {
    write_whole(increment_file(directory_, n_increments_),
                [&](const hid_t file) { write_increment(file, n_increments_, increment, shape_); });
    ++n_increments_;
  }

  void RecordWriter::finish()
  {
    write_whole(finished_file(directory_), [&](const hid_t file) {
      copy_object(header_file(directory_), "header", file);
      for (unsigned int i = 0; i < n_increments_; ++i)
        copy_object(increment_file(directory_, i), increment_name(i), file);
      hdf5::write_attribute(file, "n_increments", &n_increments_);
    });
    tidy(directory_);
  }

  void RecordWriter::tidy(const std::string &directory)
  {
    remove_segments(directory);
    std::error_code ignored;
    fs::remove(segments(directory), ignored); // unless someone keeps files there
  }

  std::uint64_t RecordWriter::bytes() const
  {
    const auto size = [](const std::string &file) {
      return is_file(file) ? static_cast<std::uint64_t>(fs::file_size(file)) : 0;
    };
    std::uint64_t sum = size(finished_file(directory_)) + size(header_file(directory_));
    for (unsigned int i = 0; i < n_increments_; ++i)
      sum += size(increment_file(directory_, i));
    return sum;
  }

  std::optional<std::uint64_t> RecordWriter::finished_bytes(const std::string &directory)
  {
    if (directory.empty() || !is_file(finished_file(directory)))
      return {};
    return fs::file_size(finished_file(directory));
  }

  RecordReader::RecordReader(const std::string &path)
  {
    if (is_file(path) || is_file(finished_file(path)))
      file_ = is_file(path) ? path : finished_file(path);
    else if (is_file(header_file(path)))
      directory_ = path;
    else
      throw Error(path,
                  "holds no record",
                  "a run leaves its record in the file record.h5 or the folder record of its output folder",
                  "check the path, or run the simulation first");

    const std::string file = finished() ? file_ : header_file(directory_);
    header_ = read_whole<RecordHeader>(file, [&](const hid_t f) { return read_header(f, file); });
    shape_  = RecordShape(header_);
    if (finished())
      n_increments_ = read_whole<unsigned int>(
        file, [](const hid_t f) { return hdf5::read_attribute<unsigned int>(f, "n_increments"); });
    else
      while (is_file(increment_file(directory_, n_increments_)))
        ++n_increments_;
  }

  IncrementHead RecordReader::head(const unsigned int i) const
  {
    return read_whole<IncrementHead>(finished() ? file_ : increment_file(directory_, i),
                                     [&](const hid_t f) { return read_increment_head(f, i, shape_); });
  }

  std::vector<RecordedInput> RecordReader::inputs() const
  {
    std::vector<RecordedInput> inputs = {{0, 0., header_.parameters, 0}};
    for (unsigned int i = 0; i < n_increments_; ++i)
      if (IncrementHead increment = head(i); increment.parameters)
        inputs.push_back({i, increment.stroke, std::move(*increment.parameters), increment.operation});
    return inputs;
  }

  std::pair<unsigned int, double> RecordReader::end() const
  {
    if (n_increments_ == 0)
      return {0, 0.};
    const IncrementHead last = head(n_increments_ - 1);
    return {last.operation, last.stroke + last.step};
  }

  IncrementRecord RecordReader::read(const unsigned int i) const
  {
    const std::string file = finished() ? file_ : increment_file(directory_, i);
    return read_whole<IncrementRecord>(file, [&](const hid_t f) { return read_increment(f, i, shape_); });
  }

  void RecordReader::check_increments() const
  {
    const auto n_nodes = [](const IncrementRecord &increment) {
      return increment.solves.empty() ? 0 : increment.solves.front().P.size();
    };
    std::size_t n = header_.mesh.n_nodes();
    for (unsigned int i = 0; i < n_increments_; ++i)
    {
      const IncrementRecord increment = read(i);
      const std::string     file      = finished() ? file_ : increment_file(directory_, i);
      if (increment.remesh)
        check_mesh(increment.remesh->mesh, file + ", " + increment_name(i));
      const std::size_t begins_on = increment.remesh ? increment.remesh->X_before.size() : n_nodes(increment);
      if (begins_on != n)
        throw Error(file,
                    increment_name(i) + " begins on a mesh of " + std::to_string(begins_on) +
                      " nodes where there is one of " + std::to_string(n),
                    "an increment goes on with the mesh of the one before, or remeshes it",
                    "restore the record from a copy, or run the simulation again");
      n = n_nodes(increment);
    }
  }
} // namespace retroforge
