// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/exceptions.h>

#include <retroforge/core/error.h>
#include <retroforge/output/safe_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

namespace retroforge
{
  namespace
  {
    std::string remedy_for(const int error_number)
    {
      switch (error_number)
      {
        case ENOSPC:
        case EDQUOT:
        case EFBIG:
          return "free space there, or choose another folder with --output DIR";
        case ENOENT:
        case ENOTDIR:
          return "make the folder, or choose another one with --output DIR";
        case EISDIR:
          return "remove the folder of that name, or choose another place with --output DIR";
        case EACCES:
        case EPERM:
        case EROFS:
          return "choose a folder you may write to with --output DIR";
        default:
          return "check the disk, or choose another folder with --output DIR";
      }
    }

    /// Whole contents or an error number (0: all is well). A full disk may show as late as in fclose.
    int write_directly(const std::string &file, const std::string &contents)
    {
      std::FILE *stream = std::fopen(file.c_str(), "wb");
      if (stream == nullptr)
        return errno;
      int error = 0;
      if (std::fwrite(contents.data(), 1, contents.size(), stream) != contents.size())
        error = errno;
      if (std::fclose(stream) != 0 && error == 0)
        error = errno;
      return error;
    }

    /// All of the text, or an error number (0: all is well).
    int write_at(const int descriptor, const off_t position, const std::string &text)
    {
      for (std::size_t done = 0; done < text.size();)
      {
        const ssize_t n = ::pwrite(descriptor, text.data() + done, text.size() - done, position + done);
        if (n > 0)
          done += n;
        else if (n == 0 || errno != EINTR)
          return n == 0 ? ENOSPC : errno;
      }
      return 0;
    }
  } // namespace

  void throw_write_error(const std::string &file, const int error_number)
  {
    throw Error(file,
                std::string("cannot be written: ") + std::strerror(error_number),
                "results need a folder that exists, may be written to and has space",
                remedy_for(error_number));
  }

  void write_file(const std::string &file, const std::string &contents)
  {
    std::error_code ignored;
    const bool      is_device =
      std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
    const std::string written = is_device ? file : file + ".tmp";
    int               error   = write_directly(written, contents);
    if (!is_device)
    {
      if (error == 0 && std::rename(written.c_str(), file.c_str()) != 0)
        error = errno;
      if (error != 0)
        std::remove(written.c_str());
    }
    if (error != 0)
      throw_write_error(file, error);
  }

  void replace_end(const std::string &file, const std::string &old_end, const std::string &new_end)
  {
    Assert(new_end.size() >= old_end.size(), dealii::ExcMessage("A file does not become shorter."));
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0)
      throw_write_error(file, errno);
    const off_t length   = ::lseek(descriptor, 0, SEEK_END);
    const off_t position = length - static_cast<off_t>(old_end.size());
    int         error    = position < 0 ? EINVAL : write_at(descriptor, position, new_end);
    if (error != 0 && ::ftruncate(descriptor, length) == 0)
      write_at(descriptor, position, old_end); // which its place is still there for
    if (::close(descriptor) != 0 && error == 0)
      error = errno;
    if (error != 0)
      throw_write_error(file, error);
  }

  void check_writable(const std::string &file)
  {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored))
      throw_write_error(file, EISDIR);
    const std::string written = file + ".tmp";
    if (const int error = write_directly(written, ""); error != 0)
      throw_write_error(file, error);
    std::remove(written.c_str());
  }

  std::string read_file(const std::string &file)
  {
    errno = 0;
    std::ifstream      in(file, std::ios::binary);
    std::ostringstream contents;
    std::error_code    ignored;
    // An empty file is no failure, though copying nothing is one to a stream.
    if (!in || std::filesystem::is_directory(file, ignored) ||
        (in.peek() != EOF && !(contents << in.rdbuf())))
      throw Error(file,
                  std::string("cannot be read: ") + std::strerror(errno != 0 ? errno : EISDIR),
                  "the results of an earlier run are expected there",
                  "check the folder given with --output DIR");
    return contents.str();
  }

  void make_directory(const std::string &directory)
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error)
      throw_write_error(directory, error.value());
  }
} // namespace retroforge
