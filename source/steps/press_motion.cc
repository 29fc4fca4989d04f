// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/registry.h>
#include <retroforge/steps/press_motion.h>

namespace retroforge
{
  namespace
  {
    class ConstantSpeed : public PressMotionOf<ConstantSpeed>
    {
    public:
      template <typename Number>
      Number compute_path(const std::vector<Number> &, double, const double step) const
      {
        return Number(step);
      }
    };

    Registry<PressMotionType> &press_motions()
    {
      static Registry<PressMotionType> motions(
        "motion of the press", "constant speed", std::make_unique<ConstantSpeed>());
      return motions;
    }
  } // namespace

  const PressMotionType &press_motion_type(const unsigned int i)
  {
    return press_motions()[i];
  }

  unsigned int find_press_motion(const std::string &name, const std::string &where)
  {
    return press_motions().find(name, where);
  }

  void add_press_motion(const std::string &name, std::unique_ptr<const PressMotionType> type)
  {
    press_motions().add(name, std::move(type));
  }

  template <typename Number>
  Number PressMotion<Number>::path(const double stroke, const double step) const
  {
    return press_motion_type(type).path(numbers, stroke, step);
  }

  template struct PressMotion<double>;
  template struct PressMotion<Dual>;

  void reverse_path(const PressMotion<double> &motion,
                    const double               stroke,
                    const double               step,
                    const double               path_bar,
                    PressMotion<double>       &bar)
  {
    bar.numbers.resize(motion.numbers.size(), 0.);
    auto moving = converted<Dual>(motion);
    for (std::size_t i = 0; i < moving.numbers.size(); ++i)
    {
      Dual &x           = moving.numbers[i];
      x.fastAccessDx(0) = 1.;
      bar.numbers[i] += path_bar * moving.path(stroke, step).dx(0);
      x.fastAccessDx(0) = 0.;
    }
  }
} // namespace retroforge
