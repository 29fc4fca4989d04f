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
                                    contact.ramp.wall};
    const unsigned int sharp = contact.ramp.sharp ? 1 : 0, counts_closing = contact.counts_closing ? 1 : 0;
    hdf5::write_attribute(group, "contact", numbers, 6);
    hdf5::write_attribute(group, "sharp", &sharp);
    hdf5::write_attribute(group, "counts_closing", &counts_closing);
  }

  ContactNumerics read_contact(const hid_t group)
  {
    double numbers[6];
    hdf5::read_attribute(group, "contact", numbers, 6);
    hdf5::check_finite(numbers, 6, "contact");
    const auto sharp          = hdf5::read_attribute<unsigned int>(group, "sharp");
    const auto counts_closing = hdf5::read_attribute<unsigned int>(group, "counts_closing");
    return {numbers[0],
            numbers[1],
            numbers[2],
            {numbers[3], sharp != 0, numbers[5]},
            numbers[4],
            counts_closing != 0};
  }
} // namespace retroforge
