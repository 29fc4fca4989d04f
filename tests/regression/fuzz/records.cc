// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: damaged records are refused with an Error, or read as numbers a run can go on from: finite, indices
// in range, meshes sound, sizes that fit from increment to increment. Damaged in bytes, of which the
// checksums know, and in their structure by HDF5 itself, of which they do not.
#include "mutate.h"

#include "../../unit/record/record_test_tools.h"

#include <retroforge/mesh/mesh_checks.h>

using namespace retroforge;
namespace fs = std::filesystem;

const RecordHeader header = sample_header(brick(3, 3, 3));
const std::string  folder = "damaged_run";

IncrementRecord increment(const unsigned int i)
{
  RecordHeader later = header;
  later.mesh         = brick(2, 4, 3);
  return i < 2    ? sample_increment(header, i)
         : i == 2 ? sample_remeshed(header, i)
                  : sample_increment(later, i);
}

void write_run(const bool finished)
{
  fresh_folder(folder);
  RecordWriter writer(folder, header);
  for (unsigned int i = 0; i < 4; ++i)
    writer.write(increment(i));
  if (finished)
    writer.finish();
}

using Files = std::map<std::string, std::string>; // contents by name

Files files_of_run(const bool finished)
{
  write_run(finished);
  Files files;
  for (const auto &entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().string()] = bytes_of(entry.path().string());
  return files;
}

/// One of the files, after all are whole again.
std::string restore(const Files &files, fuzz::Random &random)
{
  fresh_folder(folder);
  fs::create_directories(folder + "/record");
  for (const auto &[name, bytes] : files)
    write_bytes(name, bytes);
  return std::next(files.begin(), random.below(files.size()))->first;
}

bool finite(const std::vector<double> &x)
{
  return std::all_of(x.begin(), x.end(), [](const double value) { return std::isfinite(value); });
}

bool finite(const NodalVectors<double> &x)
{
  return std::all_of(x.begin(), x.end(), [](const Vec3 &value) {
    return std::isfinite(value[0]) && std::isfinite(value[1]) && std::isfinite(value[2]);
  });
}

void require_sound_mesh(const TetMesh &mesh)
{
  try
  {
    check_mesh(mesh, "mesh");
  }
  catch (const Error &error)
  {
    throw fuzz::NotSane(std::string("accepted a bad mesh: ") + error.what());
  }
  for (const Patch &patch : mesh.patches)
    if (patch.symmetry)
      fuzz::require(finite({patch.symmetry->point}) && std::abs(patch.symmetry->normal.norm() - 1.) < 1e-6,
                    "a symmetry plane is none");
}

/// @param n  nodes before, and on return after the increment
void require_sane(const IncrementRecord &record, unsigned int &n)
{
  using fuzz::require;
  if (record.remesh)
  {
    const RemeshRecord &remesh = *record.remesh;
    require_sound_mesh(remesh.mesh);
    require(remesh.X_before.size() == n && remesh.transfer.n_old == n, "a remeshing is of another mesh");
    require(remesh.transfer.n_new() == remesh.mesh.n_nodes(), "a transfer is to another mesh");
    require(finite(remesh.X_before) && finite(remesh.transfer.weight) && finite(remesh.transfer.offset) &&
              finite(remesh.positions.numbers),
            "a transfer is not finite");
    require(remesh.positions.defect(remesh.X_before.size(), remesh.mesh.n_nodes(), header.die_facets).empty(),
            "a tape of positions is damaged");
    n = remesh.mesh.n_nodes();
  }
  require(!record.solves.empty(), "there is no solve");
  require(record.forces.size() == header.die_facets.size(), "there are not as many forces as dies");
  require(finite(record.forces) && finite({record.stroke,
                                           record.step,
                                           record.deformation_energy,
                                           record.friction_energy,
                                           record.closing_energy,
                                           record.closing_work}),
          "a number is not finite");
  for (const SolveRecord &solve : record.solves)
  {
    require(solve.V.size() == n && solve.P.size() == n, "a solve is on another mesh");
    require(finite(solve.V) && finite(solve.P), "a solve is not finite");
    require(solve.active.size() == record.pairs.size(), "a solve has other pairs");
  }
  for (const ContactPair &pair : record.pairs)
  {
    const auto &[first, second] = pair.point.nodes;
    require(first < n && pair.die < header.die_facets.size(), "a pair is of nothing");
    require(pair.point.is_node() || (first < second && second < n), "a pair is of no edge");
  }
}

void read_all()
{
  const RecordReader reader(folder);
  require_sound_mesh(reader.header().mesh);
  unsigned int n = reader.header().mesh.n_nodes();
  reader.check_increments();
  fuzz::require(reader.header().X_0.size() == n && finite(reader.header().X_0), "X_0 is not finite");
  for (const unsigned int facets : reader.header().die_facets)
    fuzz::require(facets > 0, "a die has no facets");
  for (unsigned int i = 0; i < std::min(reader.n_increments(), 1000u); ++i)
    require_sane(reader.read(i), n);
}

// ---- Damage that HDF5 itself writes, with valid checksums. ----

struct Place
{
  std::string name;
  H5O_type_t  type;
};

std::vector<Place> places_in(const hid_t file)
{
  std::vector<Place> places;
  const auto         add = [](hid_t, const char *name, const H5O_info_t *info, void *places) -> herr_t {
    if (std::string(name) != ".")
      static_cast<std::vector<Place> *>(places)->push_back({name, info->type});
    return 0;
  };
#if H5_VERSION_GE(1, 12, 0) // whose H5O_info_t is what its third version takes
  hdf5::check(H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_INC, add, &places, H5O_INFO_BASIC), "visit");
#else
  hdf5::check(H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, add, &places, H5O_INFO_BASIC), "visit");
#endif
  return places;
}

/// Another kind of number, or none.
hid_t some_type(fuzz::Random &random)
{
  const std::vector<hid_t> types = {
    H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_U32LE, H5T_STD_I32LE, H5T_STD_U8LE, H5T_STD_I64BE, H5T_C_S1};
  return random.one_of(types);
}

std::vector<hsize_t> some_shape(std::vector<hsize_t> shape, fuzz::Random &random)
{
  switch (random.below(6))
  {
    case 0:
      return {};
    case 1:
      shape.push_back(1 + random.below(3));
      return shape;
    case 2:
      shape.pop_back();
      return shape;
    case 3:
      std::reverse(shape.begin(), shape.end());
      return shape;
    default:
      if (!shape.empty())
        shape[random.below(shape.size())] = random.below(3) == 0 ? 0 : random.below(60);
      return shape;
  }
}

hdf5::Handle space_of(const std::vector<hsize_t> &shape, fuzz::Random &random)
{
  const bool none = random.below(10) == 0;
  return {none || shape.empty() ? H5Screate(none ? H5S_NULL : H5S_SCALAR)
                                : H5Screate_simple(shape.size(), shape.data(), nullptr),
          H5Sclose,
          "space"};
}

std::vector<char> some_values(const std::size_t bytes, fuzz::Random &random)
{
  std::vector<char> values(bytes + 8, '\0');
  for (std::size_t i = 0; i < bytes && random.below(2) == 0; ++i)
    values[i] = static_cast<char>(random.below(256));
  return values;
}

void replace_array(const hid_t file, const std::string &name, fuzz::Random &random)
{
  std::vector<hsize_t> shape;
  {
    const hdf5::Handle old(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
    const hdf5::Handle space(H5Dget_space(old), H5Sclose, name);
    shape.resize(std::max(H5Sget_simple_extent_ndims(space), 1));
    H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  }
  hdf5::check(H5Ldelete(file, name.c_str(), H5P_DEFAULT), name);
  const hid_t        type  = some_type(random);
  const hdf5::Handle space = space_of(some_shape(shape, random), random);
  const hdf5::Handle array(
    H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, name);
  const std::size_t bytes = H5Tget_size(type) * H5Sget_simple_extent_npoints(space);
  H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, some_values(bytes, random).data());
}

/// Some entries become extreme, the rest stays.
void change_values(const hid_t file, const std::string &name, fuzz::Random &random)
{
  const hdf5::Handle array(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
  const hdf5::Handle type(H5Dget_type(array), H5Tclose, name), space(H5Dget_space(array), H5Sclose, name);
  const std::size_t  size = H5Tget_size(type), n = H5Sget_simple_extent_npoints(space);
  std::vector<char>  values(size * n + 8);
  hdf5::check(H5Dread(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
  for (std::size_t changes = 1 + random.below(3); n > 0 && changes > 0; --changes)
  {
    const std::size_t   at    = random.below(n);
    const std::uint64_t nasty = random.one_of(fuzz::nasty_integers);
    if (random.below(3) == 0)
      std::memcpy(&values[size * at], &values[size * random.below(n)], size);
    else
      std::memcpy(&values[size * at], &nasty, std::min<std::size_t>(size, 8));
  }
  hdf5::check(H5Dwrite(array, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

void change_attribute(const hid_t file, const std::string &name, fuzz::Random &random)
{
  const hdf5::Handle object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose, name);
  const int          n = H5Aget_num_attrs(object);
  if (n <= 0)
    return;
  char attribute[64];
  H5Aget_name_by_idx(
    object, ".", H5_INDEX_NAME, H5_ITER_INC, random.below(n), attribute, sizeof attribute, H5P_DEFAULT);
  if (random.below(2) == 0) // another value
  {
    const hdf5::Handle old(H5Aopen(object, attribute, H5P_DEFAULT), H5Aclose, attribute);
    const hdf5::Handle type(H5Aget_type(old), H5Tclose, attribute);
    std::uint64_t      values[8];
    for (std::uint64_t &value : values)
      value = random.one_of(fuzz::nasty_integers);
    hdf5::check(H5Awrite(old, type, values), attribute);
    return;
  }
  hdf5::check(H5Adelete(object, attribute), attribute);
  if (random.below(3) == 0)
    return;
  const hid_t        type = some_type(random);
  const hdf5::Handle space =
    space_of(random.below(2) == 0 ? std::vector<hsize_t>() : std::vector<hsize_t>{random.below(5)}, random);
  const hdf5::Handle made(
    H5Acreate2(object, attribute, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, attribute);
  H5Awrite(made, type, some_values(8 * 8, random).data());
}

void change_links(const hid_t file, const Place &a, const Place &b, fuzz::Random &random)
{
  if (a.name == b.name || b.name.rfind(a.name + "/", 0) == 0)
    return;
  hdf5::check(H5Ldelete(file, a.name.c_str(), H5P_DEFAULT), a.name);
  const std::size_t how = random.below(4);
  if (how == 0)
    hdf5::create_group(file, a.name);
  else if (how == 1 && H5Lexists(file, b.name.c_str(), H5P_DEFAULT) > 0)
    H5Lcreate_hard(file, b.name.c_str(), file, a.name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  else if (how == 2)
    H5Lcreate_soft(("/" + a.name).c_str(), file, a.name.c_str(), H5P_DEFAULT, H5P_DEFAULT); // to itself
}

void change_structure(const std::string &file, fuzz::Random &random)
{
  hdf5::silence();
  const hdf5::Handle handle(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, file);
  const auto         places = places_in(handle);
  const Place        place = random.one_of(places), other = random.one_of(places);
  const std::size_t  how = random.below(10);
  if (how == 0)
    change_links(handle, place, other, random);
  else if (place.type == H5O_TYPE_GROUP || how < 3)
    change_attribute(handle, place.name, random);
  else if (how < 5)
    replace_array(handle, place.name, random);
  else
    change_values(handle, place.name, random);
}

/// What may lie in a folder under the name of a record's file.
void put_foreign_file(const std::string &file, const Files &files, fuzz::Random &random)
{
  hdf5::silence();
  fs::remove(file);
  const std::size_t how = random.below(8);
  if (how == 0)
    write_bytes(file, "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  else if (how == 1)
    write_bytes(file, random.one_of(files).second); // that of another increment, or the header
  else if (how == 2)
    fs::create_directory(file);
  else
  {
    { // HDF5 as other programs write it, without checksums
      const hdf5::Handle handle(
        H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, file);
      const hdf5::Handle group(
        H5Gcreate2(handle, how < 5 ? "header" : "increment_000001", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Gclose,
        file);
      const unsigned int format = 4;
      hdf5::write_attribute(group, "format", &format);
      for (const char *name : {"program", "commit", "parameters"})
        hdf5::write_string(group, name, "some text");
      for (const char *name : {"X", "X_0"})
        hdf5::write_array(group, name, {18, 3}, std::vector<double>(54).data());
      hdf5::write_array(group, "cells", {4, 4}, std::vector<unsigned int>(16).data());
    }
    if (random.below(4) > 0)
      write_bytes(file, fuzz::mutate(bytes_of(file), random));
  }
}

int main()
{
  const Files running = files_of_run(false), finished = files_of_run(true);
  const auto  some_run = [&](fuzz::Random &random) -> const Files  &{
    return random.below(3) == 0 ? finished : running;
  };
  fuzz::run("record, bytes", folder, [&](fuzz::Random &random) {
    const Files      &files = some_run(random);
    const std::string file  = restore(files, random);
    write_bytes(file, fuzz::mutate(files.at(file), random));
    read_all();
  });
  fuzz::run("record, structure", folder, [&](fuzz::Random &random) {
    change_structure(restore(some_run(random), random), random);
    read_all();
  });
  fuzz::run("record, foreign files", folder, [&](fuzz::Random &random) {
    const Files &files = some_run(random);
    put_foreign_file(restore(files, random), files, random);
    read_all();
  });
}
