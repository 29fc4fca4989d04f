// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/record/contact_record.h>

namespace retroforge
{
  void write_contact(const hid_t group, const ContactNumerics &contact)
  {
    const double       numbers[] = {contact.approach,
                                    contact.layer,
                                    contact.step,
                                    contact.ramp.width,
                                    contact.edge_stiffness,
                                    contact.ramp.wall,
                                    contact.recovery};
    const unsigned int sharp = contact.ramp.sharp ? 1 : 0, counts_closing = contact.counts_closing ? 1 : 0;
    hdf5::write_attribute(group, "contact", numbers, 7);
    hdf5::write_attribute(group, "sharp", &sharp);
    hdf5::write_attribute(group, "counts_closing", &counts_closing);
  }

  ContactNumerics read_contact(const hid_t group)
  {
    double numbers[7];
    hdf5::read_attribute(group, "contact", numbers, 7);
    hdf5::check_finite(numbers, 7, "contact");
    const auto sharp          = hdf5::read_attribute<unsigned int>(group, "sharp");
    const auto counts_closing = hdf5::read_attribute<unsigned int>(group, "counts_closing");
    return {numbers[0],
            numbers[1],
            numbers[2],
            {numbers[3], sharp != 0, numbers[5]},
            numbers[4],
            counts_closing != 0,
            numbers[6]};
  }

  namespace
  {
    /// Rigid motions that there are.
    constexpr unsigned int most_motions = 6;
  } // namespace

  void write_hold(const hid_t group, const RigidHold &hold, const HoldLoad &load)
  {
    const unsigned int n = hold.motions.size();
    hdf5::write_attribute(group, "n_held_motions", &n);
    if (n == 0)
      return;
    std::vector<double> numbers{hold.drag};
    const auto          append = [&](const Vec3 &x) { numbers.insert(numbers.end(), {x[0], x[1], x[2]}); };
    append(load.force);
    append(load.moment);
    for (const RigidMotion &motion : hold.motions)
    {
      append(motion.slide);
      append(motion.turn);
    }
    hdf5::write_attribute(group, "hold", numbers.data(), numbers.size());
  }

  std::pair<RigidHold, HoldLoad> read_hold(const hid_t group)
  {
    std::pair<RigidHold, HoldLoad> read;
    auto &[hold, load] = read;
    const auto n       = hdf5::read_attribute<unsigned int>(group, "n_held_motions");
    if (n > most_motions)
      throw hdf5::Failure("there are " + std::to_string(n) + " rigid motions");
    if (n == 0)
      return read;
    std::vector<double> numbers(7 + 6 * n);
    hdf5::read_attribute(group, "hold", numbers.data(), numbers.size());
    hdf5::check_finite(numbers.data(), numbers.size(), "hold");
    auto       next = numbers.cbegin();
    const auto take = [&](Vec3 &x) {
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = *next++;
    };
    hold.drag = *next++;
    take(load.force);
    take(load.moment);
    hold.motions.resize(n);
    for (RigidMotion &motion : hold.motions)
    {
      take(motion.slide);
      take(motion.turn);
    }
    return read;
  }
} // namespace retroforge
