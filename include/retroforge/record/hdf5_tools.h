// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

/// @file
/// HDF5 with every return code checked. (deal.II's wrapper drops errors in Release builds.)
///
/// Every byte of these files is under a checksum of HDF5's own: metadata by the file format of HDF5 1.10,
/// data by the Fletcher-32 filter. So a damaged file is told from a whole one before its contents are used.
/// Times of creation are left out: the same contents give the same bytes.
namespace retroforge::hdf5
{
  /// Why HDF5 refused. Callers turn it into an Error that names the file.
  struct Failure : std::runtime_error
  {
    /// @param error_number  of the operating system, 0 if it was not asked
    explicit Failure(const std::string &what, const int error_number = 0)
        : std::runtime_error(what), error_number(error_number)
    {
    }

    int error_number;
  };

  /// Turns off HDF5's own printing of errors, for good: Failure tells them, and after a damaged file HDF5
  /// would still complain when the program ends.
  void silence();

  /// Owns an identifier of HDF5.
  class Handle
  {
  public:
    using Close = herr_t (*)(hid_t);

    /// @throws Failure if `id` says that its creation failed, which `what` describes
    Handle(hid_t id, Close close, const std::string &what);
    Handle(Handle &&other) noexcept;
    ~Handle();
    Handle &operator=(Handle &&) = delete;

    operator hid_t() const { return id_; }

    /// @throws Failure  Destruction closes too, but cannot tell what went wrong.
    void close();

  private:
    hid_t id_;
    Close close_;
  };

  /// Throws Failure with HDF5's reason if `result` is negative.
  void check(long long result, const std::string &what);

  Handle open_file(const std::string &file); ///< to read

  /// A file made in memory, whose bytes the caller brings to the disk. HDF5 itself is not let near a disk
  /// that may be full: after a write that failed, its release 1.10.8 crashes.
  class MemoryFile
  {
  public:
    MemoryFile();

    operator hid_t() const { return file_; }

    /// Closes the file: then `data()` and `size()` are its contents.
    void        close();
    const char *data() const { return contents_->get(); }
    std::size_t size() const { return size_; }

  private:
    struct Free
    {
      void operator()(char *memory) const { std::free(memory); }
    };
    using Contents = std::unique_ptr<char, Free>;

    static Handle create(Contents &contents);
    static herr_t take(void *memory, H5FD_file_image_op_t operation, void *contents);

    // HDF5 keeps a pointer to what contents_ points to, until file_ is closed: mind the order.
    std::unique_ptr<Contents> contents_;
    Handle                    file_;
    std::size_t               size_ = 0;
  };

  Handle create_group(hid_t parent, const std::string &name);
  Handle open_group(hid_t parent, const std::string &name);
  bool   has_attribute(hid_t object, const std::string &name);
  bool   has_link(hid_t parent, const std::string &name);

  /// Small values. Numbers are double, unsigned int, std::uint64_t or unsigned char, here and below.
  template <typename Number>
  void write_attribute(hid_t object, const std::string &name, const Number *values, hsize_t size = 1);
  template <typename Number>
  void read_attribute(hid_t object, const std::string &name, Number *values, hsize_t size = 1);
  template <typename Number>
  Number read_attribute(hid_t object, const std::string &name);

  template <typename Number>
  void
  write_array(hid_t parent, const std::string &name, const std::vector<hsize_t> &shape, const Number *values);

  /// As an extent of a shape: whatever the file has.
  inline constexpr hsize_t any = static_cast<hsize_t>(-1);

  /// Entries in row-major order; Failure unless the array has this kind of number and this shape.
  template <typename Number>
  std::vector<Number> read_array(hid_t parent, const std::string &name, const std::vector<hsize_t> &shape);

  /// UTF-8, of any length. May not hold zero bytes.
  void        write_string(hid_t parent, const std::string &name, const std::string &value);
  std::string read_string(hid_t parent, const std::string &name);

  /// Throws Failure unless all n numbers are finite: those of a step that diverged are not written.
  void check_finite(const double *values, std::size_t n, const std::string &name);
} // namespace retroforge::hdf5
