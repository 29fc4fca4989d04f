// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/record/hdf5_tools.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>

namespace retroforge::hdf5
{
  namespace
  {
    /// Innermost entry of HDF5's stack of errors, which knows the cause.
    std::string innermost_reason()
    {
      std::string reason;
      const auto  take_first = [](const unsigned int n, const H5E_error2_t *entry, void *reason) -> herr_t {
        if (n == 0 && entry->desc != nullptr)
          *static_cast<std::string *>(reason) = entry->desc;
        return 0;
      };
      H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
      return reason;
    }

    /// HDF5 mentions the number of the operating system's error in its text, and nowhere else.
    int error_number_in(const std::string &reason)
    {
      const std::string key   = "errno = ";
      const std::size_t place = reason.find(key);
      return place == std::string::npos ? 0 : std::atoi(reason.c_str() + place + key.size());
    }

    Handle file_access()
    {
      Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access");
      check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "file access");
      check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), "file access");
      check(H5Pset_cache(access, 0, 0, 0, 0.), "file access");
      check(H5Pset_meta_block_size(access, 0), "file access");
      check(H5Pset_small_data_block_size(access, 0), "file access");
#if H5_VERSION_GE(1, 10, 7)
      // Shared file systems of clusters may know no locks, and here none is needed: files appear whole.
      check(H5Pset_file_locking(access, false, true), "file access");
#endif
      return access;
    }

    Handle untimed(const hid_t list_class)
    {
      Handle properties(H5Pcreate(list_class), H5Pclose, "properties");
      check(H5Pset_obj_track_times(properties, false), "properties");
      return properties;
    }

    template <typename Number>
    hid_t memory_type()
    {
      if constexpr (std::is_same_v<Number, double>)
        return H5T_NATIVE_DOUBLE;
      else if constexpr (std::is_same_v<Number, unsigned int>)
        return H5T_NATIVE_UINT;
      else if constexpr (std::is_same_v<Number, std::uint64_t>)
        return H5T_NATIVE_UINT64;
      else
        return H5T_NATIVE_UCHAR;
    }

    template <typename Number>
    hid_t file_type()
    {
      if constexpr (std::is_same_v<Number, double>)
        return H5T_IEEE_F64LE;
      else if constexpr (std::is_same_v<Number, unsigned int>)
        return H5T_STD_U32LE;
      else if constexpr (std::is_same_v<Number, std::uint64_t>)
        return H5T_STD_U64LE;
      else
        return H5T_STD_U8LE;
    }

    template <typename Number>
    void check_type(const hid_t found, const std::string &name)
    {
      const Handle native(H5Tget_native_type(found, H5T_DIR_ASCEND), H5Tclose, "type of " + name);
      if (H5Tequal(native, memory_type<Number>()) <= 0)
        throw Failure(name + " holds another kind of number than expected");
    }

    std::string shape_string(const std::vector<hsize_t> &shape)
    {
      std::string text;
      for (const hsize_t extent : shape)
        text += (text.empty() ? "" : " x ") + (extent == any ? "any" : std::to_string(extent));
      return shape.empty() ? "scalar" : text;
    }

    std::vector<hsize_t> shape_of(const hid_t space, const std::string &name)
    {
      const int rank = H5Sget_simple_extent_ndims(space);
      check(rank, "shape of " + name);
      std::vector<hsize_t> shape(rank);
      check(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "shape of " + name);
      return shape;
    }

    /// The shape found, if it agrees.
    std::vector<hsize_t>
    check_shape(const hid_t space, const std::string &name, const std::vector<hsize_t> &expected)
    {
      const std::vector<hsize_t> found = shape_of(space, name);
      const auto                 agree = [](const hsize_t a, const hsize_t b) { return a == b || b == any; };
      if (!std::equal(found.begin(), found.end(), expected.begin(), expected.end(), agree))
        throw Failure("the shape of " + name + " is " + shape_string(found) + " instead of " +
                      shape_string(expected));
      return found;
    }

    /// Entries of an array, as many as the file can hold: nothing is allocated on the word of a damaged file.
    std::size_t
    safe_size(const hid_t dataset, const std::vector<hsize_t> &shape, const std::size_t entry_bytes)
    {
      hsize_t      file_bytes = 0;
      const Handle file(H5Iget_file_id(dataset), H5Fclose, "file");
      check(H5Fget_filesize(file, &file_bytes), "size of the file");
      hsize_t size = 1;
      for (const hsize_t extent : shape)
      {
        if (extent != 0 && size > file_bytes / entry_bytes / extent)
          throw Failure("an array is larger than its file");
        size *= extent;
      }
      return size;
    }

    /// Layout of an array: one chunk, as the checksum asks for chunks.
    Handle array_layout(const std::vector<hsize_t> &shape)
    {
      Handle properties = untimed(H5P_DATASET_CREATE);
      if (std::find(shape.begin(), shape.end(), 0) == shape.end())
      {
        check(H5Pset_chunk(properties, shape.size(), shape.data()), "layout");
        check(H5Pset_fletcher32(properties), "layout");
      }
      check(H5Pset_fill_time(properties, H5D_FILL_TIME_NEVER), "layout");
      return properties;
    }

    void write_dataset(const hid_t                 parent,
                       const std::string          &name,
                       const hid_t                 in_file,
                       const hid_t                 in_memory,
                       const std::vector<hsize_t> &shape,
                       const void                 *values)
    {
      const Handle layout = array_layout(shape);
      const Handle space(H5Screate_simple(shape.size(), shape.data(), nullptr), H5Sclose, name);
      Handle       dataset(
        H5Dcreate2(parent, name.c_str(), in_file, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose, name);
      check(H5Dwrite(dataset, in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), name);
      dataset.close();
    }

    Handle open_dataset(const hid_t parent, const std::string &name)
    {
      return Handle(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, name);
    }

    Handle string_type(const std::size_t length)
    {
      Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "text");
      check(H5Tset_size(type, std::max<std::size_t>(length, 1)), "text");
      check(H5Tset_strpad(type, H5T_STR_NULLPAD), "text");
      check(H5Tset_cset(type, H5T_CSET_UTF8), "text");
      return type;
    }
  } // namespace

  void silence()
  {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }

  void check(const long long result, const std::string &what)
  {
    if (result >= 0)
      return;
    const std::string reason = innermost_reason();
    if (const int error_number = error_number_in(reason))
      throw Failure(std::strerror(error_number), error_number);
    throw Failure(what + ": " + (reason.empty() ? "HDF5 gives no reason" : reason));
  }

  Handle::Handle(const hid_t id, const Close close, const std::string &what) : id_(id), close_(close)
  {
    check(id, what);
  }

  Handle::Handle(Handle &&other) noexcept : id_(other.id_), close_(other.close_)
  {
    other.id_ = -1;
  }

  Handle::~Handle()
  {
    if (id_ >= 0)
      close_(id_);
  }

  void Handle::close()
  {
    const hid_t id = id_;
    id_            = -1;
    check(close_(id), "closing");
  }

  MemoryFile::MemoryFile() : contents_(std::make_unique<Contents>()), file_(create(*contents_)) {}

  /// HDF5 calls this to free its memory; when it closes the file, the memory holds the final contents.
  herr_t MemoryFile::take(void *memory, const H5FD_file_image_op_t operation, void *contents)
  {
    if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE)
      static_cast<Contents *>(contents)->reset(static_cast<char *>(memory));
    else
      std::free(memory);
    return 0;
  }

  Handle MemoryFile::create(Contents &contents)
  {
    constexpr std::size_t       growth = 1 << 20;
    H5FD_file_image_callbacks_t callbacks;
    callbacks.image_malloc = [](size_t size, H5FD_file_image_op_t, void *) { return std::malloc(size); };
    callbacks.image_memcpy = [](void *to, const void *from, size_t size, H5FD_file_image_op_t, void *) {
      return std::memcpy(to, from, size);
    };
    callbacks.image_realloc = [](void *old, size_t size, H5FD_file_image_op_t, void *) {
      return std::realloc(old, size);
    };
    callbacks.image_free = take;
    callbacks.udata_copy = [](void *contents) { return contents; };
    callbacks.udata_free = [](void *) -> herr_t { return 0; };
    callbacks.udata      = &contents;

    const Handle access = file_access(), creation = untimed(H5P_FILE_CREATE);
    check(H5Pset_fapl_core(access, growth, false), "file in memory");
    check(H5Pset_file_image_callbacks(access, &callbacks), "file in memory");
    return Handle(H5Fcreate("record", H5F_ACC_TRUNC, creation, access), H5Fclose, "file in memory");
  }

  void MemoryFile::close()
  {
    check(H5Fflush(file_, H5F_SCOPE_LOCAL), "file in memory");
    const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
    check(size, "file in memory");
    file_.close();
    if (*contents_ == nullptr)
      throw Failure("file in memory: HDF5 gave no contents");
    size_ = size;
  }

  Handle open_file(const std::string &file)
  {
    const Handle access = file_access();
    return Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "not a whole HDF5 file");
  }

  Handle create_group(const hid_t parent, const std::string &name)
  {
    const Handle creation = untimed(H5P_GROUP_CREATE);
    return Handle(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, name);
  }

  Handle open_group(const hid_t parent, const std::string &name)
  {
    return Handle(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, name);
  }

  bool has_link(const hid_t parent, const std::string &name)
  {
    const htri_t exists = H5Lexists(parent, name.c_str(), H5P_DEFAULT);
    check(exists, name);
    return exists > 0;
  }

  bool has_attribute(const hid_t object, const std::string &name)
  {
    const htri_t exists = H5Aexists(object, name.c_str());
    check(exists, name);
    return exists > 0;
  }

  template <typename Number>
  void write_attribute(const hid_t object, const std::string &name, const Number *values, const hsize_t size)
  {
    const Handle space(
      size == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose, name);
    Handle attribute(
      H5Acreate2(object, name.c_str(), file_type<Number>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
    check(H5Awrite(attribute, memory_type<Number>(), values), name);
    attribute.close();
  }

  template <typename Number>
  void read_attribute(const hid_t object, const std::string &name, Number *values, const hsize_t size)
  {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, name);
    const Handle type(H5Aget_type(attribute), H5Tclose, name), space(H5Aget_space(attribute), H5Sclose, name);
    check_type<Number>(type, name);
    check_shape(space, name, size == 1 ? std::vector<hsize_t>() : std::vector<hsize_t>{size});
    if (H5Sget_simple_extent_npoints(space) !=
        static_cast<hssize_t>(size)) // a null space has no extents either
      throw Failure(name + " holds no value");
    check(H5Aread(attribute, memory_type<Number>(), values), name);
  }

  template <typename Number>
  Number read_attribute(const hid_t object, const std::string &name)
  {
    Number value;
    read_attribute(object, name, &value);
    return value;
  }

  template <typename Number>
  void write_array(const hid_t                 parent,
                   const std::string          &name,
                   const std::vector<hsize_t> &shape,
                   const Number               *values)
  {
    write_dataset(parent, name, file_type<Number>(), memory_type<Number>(), shape, values);
  }

  template <typename Number>
  std::vector<Number>
  read_array(const hid_t parent, const std::string &name, const std::vector<hsize_t> &shape)
  {
    const Handle dataset = open_dataset(parent, name);
    const Handle type(H5Dget_type(dataset), H5Tclose, name), space(H5Dget_space(dataset), H5Sclose, name);
    check_type<Number>(type, name);
    const std::size_t   size = safe_size(dataset, check_shape(space, name, shape), sizeof(Number));
    std::vector<Number> values(size);
    check(H5Dread(dataset, memory_type<Number>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
    return values;
  }

  void write_string(const hid_t parent, const std::string &name, const std::string &value)
  {
    const Handle type = string_type(value.size());
    write_dataset(parent, name, type, type, {1}, value.c_str());
  }

  std::string read_string(const hid_t parent, const std::string &name)
  {
    const Handle dataset = open_dataset(parent, name);
    const Handle type(H5Dget_type(dataset), H5Tclose, name), space(H5Dget_space(dataset), H5Sclose, name);
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0)
      throw Failure(name + " is not text");
    const std::size_t length = H5Tget_size(type);
    if (length == 0)
      throw Failure(name + " is text without a length");
    std::string value(safe_size(dataset, check_shape(space, name, {1}), length) * length, '\0');
    check(H5Dread(dataset, string_type(length), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()), name);
    value.resize(std::strlen(value.c_str()));
    return value;
  }

  void check_finite(const double *values, const std::size_t n, const std::string &name)
  {
    if (!std::all_of(values, values + n, [](const double value) { return std::isfinite(value); }))
      throw Failure(name + " holds a number that is not finite");
  }

#define RETROFORGE_INSTANTIATE(Number)                                                                   \
  template void   write_attribute(hid_t, const std::string &, const Number *, hsize_t);                  \
  template void   read_attribute(hid_t, const std::string &, Number *, hsize_t);                         \
  template Number read_attribute(hid_t, const std::string &);                                            \
  template void   write_array(hid_t, const std::string &, const std::vector<hsize_t> &, const Number *); \
  template std::vector<Number> read_array(hid_t, const std::string &, const std::vector<hsize_t> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(unsigned int)
  RETROFORGE_INSTANTIATE(std::uint64_t)
  RETROFORGE_INSTANTIATE(unsigned char)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge::hdf5
