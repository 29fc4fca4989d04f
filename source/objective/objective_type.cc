// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/die_temperature.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/radius.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/stress_maxima.h>
#include <retroforge/objective/temperatures.h>
#include <retroforge/objective/unfilled_volume.h>
#include <retroforge/objective/volume.h>

namespace retroforge
{
  const Choice<ObjectiveType>::Makers &objective_types()
  {
    static const Choice<ObjectiveType>::Makers types = {energy_type(),
                                                        mean_effort_type(),
                                                        maximum_effort_type(),
                                                        fold_type(),
                                                        dimensionless_fold_type(),
                                                        contact_pressure_type(),
                                                        largest_hydrostatic_pressure_type(),
                                                        largest_shear_type(),
                                                        die_wear_type(),
                                                        die_temperature_type(),
                                                        damage_type(),
                                                        filling_type(),
                                                        unfilled_volume_type(),
                                                        shape_distance_type(),
                                                        cylinder_distance_type(),
                                                        mean_radius_type(),
                                                        mean_strain_type(),
                                                        strain_variance_type(),
                                                        maximum_strain_type(),
                                                        largest_temperature_type(),
                                                        least_temperature_type(),
                                                        temperature_spread_type(),
                                                        volume_type()};
    return types;
  }
} // namespace retroforge
