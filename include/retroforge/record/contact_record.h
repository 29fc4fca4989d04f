// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>
#include <retroforge/record/hdf5_tools.h>

namespace retroforge
{
  /// Writes the numerics of contact as attributes of an increment (record_format.h).
  void write_contact(hid_t group, const ContactNumerics &contact);

  /// Reads them.  @throws hdf5::Failure  where they are not there, or not finite
  ContactNumerics read_contact(hid_t group);

  /// Writes what holds the workpiece, and what it bears, alike.
  void write_hold(hid_t group, const RigidHold &hold, const HoldLoad &load);

  /// Reads it.  @throws hdf5::Failure  as read_contact
  std::pair<RigidHold, HoldLoad> read_hold(hid_t group);
} // namespace retroforge
