// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: files that are whole but not a usable record are refused, each with its reason: missing, foreign,
// of another format or run, with arrays of wrong kind or shape, with indices of nodes, dies or patches that
// do not exist; and an increment that begins on a mesh that was not there.
#include "record_test_tools.h"

#include <deal.II/base/exceptions.h>

using namespace retroforge;
namespace fs = std::filesystem;

const RecordHeader header    = sample_header(brick(2, 2, 3));
const std::string  folder    = "bad_records_data";
const std::string  start     = folder + "/record/header.h5";
const std::string  increment = folder + "/record/increment_000001.h5";

void fresh_record()
{
  fresh_folder(folder);
  RecordWriter writer(folder, header);
  for (unsigned int i = 0; i < 3; ++i)
    writer.write(sample_increment(header, i));
}

void read_all()
{
  const RecordReader reader(folder);
  for (unsigned int i = 0; i < reader.n_increments(); ++i)
    reader.read(i);
  std::cout << "  " << reader.n_increments() << " increments, ";
}

/// Changes a group of a fresh record's file and reads the record.
template <typename Change>
void show_changed(const std::string &title,
                  const std::string &file,
                  const std::string &group,
                  const Change      &change)
{
  fresh_record();
  {
    const hdf5::Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, file);
    change(hdf5::open_group(handle, group));
  }
  show_error(title, read_all);
}

template <typename Number>
void replace(const hid_t                 group,
             const std::string          &name,
             const std::vector<hsize_t> &shape,
             const std::vector<Number>  &values)
{
  hdf5::check(H5Ldelete(group, name.c_str(), H5P_DEFAULT), name);
  hdf5::write_array(group, name, shape, values.data());
}

template <typename Number>
void replace_attribute(const hid_t group, const std::string &name, const Number value)
{
  hdf5::check(H5Adelete(group, name.c_str()), name);
  hdf5::write_attribute(group, name, &value);
}

/// Increments that can be read, of which one begins on a mesh that was not there.
void show_lost_remeshing()
{
  const RecordHeader larger = sample_header(brick(3, 3, 3));
  fresh_folder(folder);
  RecordWriter writer(folder, larger);
  writer.write(sample_increment(larger, 0));
  writer.write(sample_remeshed(larger, 1));
  show_error("remeshed", []() {
    RecordReader(folder).check_increments();
    std::cout << "  each begins on the mesh that was there, ";
  });
  {
    const hdf5::Handle handle(H5Fopen(increment.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, increment);
    const hdf5::Handle group = hdf5::open_group(handle, "increment_000001");
    hdf5::check(H5Ldelete(group, "remesh", H5P_DEFAULT), "remesh");
  }
  show_error("remeshing lost", []() { RecordReader(folder).check_increments(); });
}

/// Positions by operations that cannot be.
void show_bad_tapes()
{
  const RecordHeader larger = sample_header(brick(3, 3, 3));
  const auto         show   = [&](const std::string &title, const auto &change) {
    fresh_folder(folder);
    RecordWriter writer(folder, larger);
    writer.write(sample_increment(larger, 0));
    IncrementRecord remeshed = sample_remeshed(larger, 1);
    RemeshRecord    changed  = *remeshed.remesh;
    change(changed.positions);
    remeshed.remesh = std::make_shared<RemeshRecord>(changed);
    writer.write(remeshed);
    show_error(title, read_all);
  };
  show("positions of another mesh", [](PositionTape &tape) { tape.results.pop_back(); });
  show("a node that is nowhere", [](PositionTape &tape) { tape.results[0] = 1000000; });
  show("no rule", [](PositionTape &tape) { tape.rules[3] = 200; });
  show("a rule without its numbers", [](PositionTape &tape) {
    tape.numbers.pop_back();
    tape.numbers.pop_back();
    for (unsigned int i = 1; i < 4; ++i)
      tape.number_begin[tape.number_begin.size() - i] -= 2;
  });
  show("an operation of a later one", [](PositionTape &tape) { tape.arguments[0] = tape.n_inputs + 1; });
  show("no such plane", [](PositionTape &tape) { tape.planes.clear(); });
  show("no such facet", [](PositionTape &tape) { tape.arguments[tape.arguments.size() - 2] = 1000000; });
}

void show_bad_files()
{
  show_error("no such folder", []() { RecordReader("no/such/folder"); });
  fresh_record();
  write_bytes(start, "set K = 1\n");
  show_error("not HDF5", read_all);
  fresh_record();
  write_bytes(increment, "");
  show_error("empty", read_all);
  fresh_record();
  const std::string whole = bytes_of(increment);
  write_bytes(increment, whole.substr(0, whole.size() - 100));
  show_error("cut off", read_all);
  show_error("a segment taken for a record", []() { RecordReader reader(start); });
  fresh_record();
  fs::remove(increment);
  show_error("one missing: those before it count", read_all);
  fresh_record();
  fs::copy_file(folder + "/record/increment_000000.h5", increment, fs::copy_options::overwrite_existing);
  show_error("increment of another number", read_all);
  {
    fresh_folder(folder + "_2");
    RecordWriter other(folder + "_2", sample_header(header.mesh, "set K = 2\n"));
    for (unsigned int i = 0; i < 2; ++i)
      other.write(sample_increment(header, i));
    fs::copy_file(folder + "_2/record/increment_000001.h5", increment, fs::copy_options::overwrite_existing);
  }
  show_error("increment of another run", read_all);
}

void show_bad_headers()
{
  show_changed("other format", start, "header", [](const hid_t g) { replace_attribute(g, "format", 13u); });
  show_changed(
    "format is no integer", start, "header", [](const hid_t g) { replace_attribute(g, "format", 1.); });
  show_changed("cells of five nodes", start, "header", [](const hid_t g) {
    replace(g, "cells", {2, 5}, std::vector<unsigned int>(10));
  });
  show_changed("no cells", start, "header", [](const hid_t g) { H5Ldelete(g, "cells", H5P_DEFAULT); });
  show_changed("node that is not there", start, "header", [](const hid_t g) {
    replace(g, "cells", {1, 4}, std::vector<unsigned int>{0, 1, 2, 12});
  });
  show_changed("too few positions", start, "header", [](const hid_t g) {
    replace(g, "X_0", {11, 3}, std::vector<double>(33));
  });
  show_changed(
    "patch missing", start, "header", [](const hid_t g) { replace_attribute(g, "n_patches", 3u); });
  show_changed("fewer patches than faces use", start, "header", [](const hid_t g) {
    replace_attribute(g, "n_patches", 1u);
  });
  show_changed("parameters are numbers", start, "header", [](const hid_t g) {
    replace(g, "parameters", {1}, std::vector<double>(1));
  });
}

void show_bad_increments()
{
  const auto show = [](const std::string &title, const auto &change) {
    show_changed(title, increment, "increment_000001", change);
  };
  show("velocity of other node count", [](const hid_t g) {
    replace(g, "V", {2, 11, 3}, std::vector<double>(66));
  });
  show("velocity of integers", [](const hid_t g) {
    replace(g, "V", {2, 12, 3}, std::vector<unsigned int>(72));
  });
  show("one pressure, two velocities", [](const hid_t g) {
    replace(g, "P", {1, 12}, std::vector<double>(12));
  });
  constexpr unsigned int none = invalid_index;
  show("pair of a node that is not there", [](const hid_t g) {
    replace(g,
            "pairs",
            {4, 4},
            std::vector<unsigned int>{0, none, 0, 1, 1, none, 1, 1, 12, none, 12, 1, 3, none, 3, 1});
  });
  show("pair of an edge whose second node is not there", [](const hid_t g) {
    replace(g,
            "pairs",
            {4, 4},
            std::vector<unsigned int>{0, none, 0, 1, 1, none, 1, 1, 2, 12, none, 1, 3, none, 3, 1});
  });
  show("pair of an edge from a node to itself", [](const hid_t g) {
    replace(g,
            "pairs",
            {4, 4},
            std::vector<unsigned int>{0, none, 0, 1, 1, none, 1, 1, 2, 2, none, 1, 3, none, 3, 1});
  });
  show("pair of a die that is not there", [](const hid_t g) {
    replace(g,
            "pairs",
            {4, 4},
            std::vector<unsigned int>{0, none, 0, 1, 1, none, 1, 1, 2, none, 2, 2, 3, none, 3, 1});
  });
  show("a velocity that is another node's", [](const hid_t g) {
    replace(g,
            "pairs",
            {4, 4},
            std::vector<unsigned int>{0, none, 0, 1, 1, none, 1, 1, 2, none, 3, 1, 3, none, 3, 1});
  });
  show("fewer nodes of the velocity than of the mesh",
       [](const hid_t g) { replace_attribute(g, "n_velocity_nodes", 11u); });
  show("facet that is not there", [](const hid_t g) {
    replace(g, "facet", {4}, std::vector<unsigned int>{0, 0, 96, 0});
  });
  show("kind of feature that is not there", [](const hid_t g) {
    replace(g, "kind", {4}, std::vector<unsigned char>{0, 0, DieFeature::n_kinds, 0});
  });
  show("fewer kinds than pairs",
       [](const hid_t g) { replace(g, "kind", {3}, std::vector<unsigned char>(3)); });
  show("more pairs than flags", [](const hid_t g) {
    replace(g, "pairs", {5, 4}, std::vector<unsigned int>(20));
  });
  show("flag of 2", [](const hid_t g) {
    replace(g, "touching", {4}, std::vector<unsigned char>{0, 1, 2, 0});
  });
  show("huge array, never written", [](const hid_t g) {
    const hsize_t      shape[] = {hsize_t(1) << 40, 12, 3};
    const hdf5::Handle space(H5Screate_simple(3, shape, nullptr), H5Sclose, "V");
    H5Ldelete(g, "V", H5P_DEFAULT);
    const hdf5::Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "V");
    const hsize_t      chunk[] = {1, 12, 3};
    H5Pset_chunk(layout, 3, chunk);
    const hdf5::Handle array(
      H5Dcreate2(g, "V", H5T_IEEE_F64LE, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose, "V");
  });
}

void show_bad_writing()
{
  fresh_folder(folder);
  write_bytes(folder + "/file", "");
  show_error("folder below a file", []() { RecordWriter(folder + "/file/run", header); });
  show_error("resume without record", []() { RecordWriter::resume(folder); });
  fresh_record();
  RecordWriter::resume(folder).finish();
  show_error("resume a finished run", []() { RecordWriter::resume(folder); });

  RecordWriter    writer(folder, header);
  IncrementRecord bad = sample_increment(header, 0);
  bad.solves[1].active.pop_back();
  try
  {
    writer.write(bad);
  }
  catch (const dealii::ExceptionBase &)
  {
    std::cout << "sizes that disagree are not written: " << yes(RecordReader(folder).n_increments() == 0)
              << '\n';
  }
}

int main()
{
  show_bad_files();
  show_lost_remeshing();
  show_bad_tapes();
  show_bad_headers();
  show_bad_increments();
  show_bad_writing();
}
