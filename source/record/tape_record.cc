// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/record/tape_record.h>

namespace retroforge
{
  void write_tape(const hid_t group, const PositionTape &tape)
  {
    const auto write = [group](const std::string &name, const auto &list) {
      hdf5::write_array(group, name, {list.size()}, list.data());
    };
    std::vector<double> planes;
    for (const Plane &plane : tape.planes)
      for (const Vec3 &v : {plane.point, plane.normal})
        planes.insert(planes.end(), v.begin_raw(), v.end_raw());
    hdf5::write_attribute(group, "inputs", &tape.n_inputs);
    write("rules", tape.rules);
    write("argument_begin", tape.argument_begin);
    write("arguments", tape.arguments);
    write("number_begin", tape.number_begin);
    write("numbers", tape.numbers);
    write("results", tape.results);
    hdf5::write_array(group, "planes", {tape.planes.size(), 6}, planes.data());
  }

  PositionTape read_tape(const hid_t group)
  {
    const auto read = [group](const std::string &name, auto &list) {
      using Entry = typename std::decay_t<decltype(list)>::value_type;
      list        = hdf5::read_array<Entry>(group, name, {hdf5::any});
    };
    PositionTape tape;
    tape.n_inputs = hdf5::read_attribute<unsigned int>(group, "inputs");
    read("rules", tape.rules);
    read("argument_begin", tape.argument_begin);
    read("arguments", tape.arguments);
    read("number_begin", tape.number_begin);
    read("numbers", tape.numbers);
    read("results", tape.results);
    hdf5::check_finite(tape.numbers.data(), tape.numbers.size(), "numbers");
    const auto planes = hdf5::read_array<double>(group, "planes", {hdf5::any, 6});
    hdf5::check_finite(planes.data(), planes.size(), "planes");
    for (std::size_t i = 0; i < planes.size(); i += 6)
    {
      const double *p = &planes[i];
      tape.planes.push_back({Vec3({p[0], p[1], p[2]}), Vec3({p[3], p[4], p[5]})});
    }
    return tape;
  }
} // namespace retroforge
