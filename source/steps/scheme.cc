// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/steps/scheme.h>

namespace retroforge
{
  const std::vector<Scheme> &Scheme::all()
  {
    static const std::vector<Scheme> schemes = {
      {"midpoint", "is of second order and solves twice per increment", {{}, {0.5}}, {0., 1.}},
      {"euler", "of first order", {{}}, {1.}}};
    return schemes;
  }

  const Scheme &Scheme::by_name(const std::string &name)
  {
    std::vector<std::string> names;
    for (const Scheme &scheme : all())
    {
      if (scheme.name == name)
        return scheme;
      names.push_back(scheme.name);
    }
    throw Error("Press/scheme",
                "there is no time scheme '" + legible(name) + "'",
                "the schemes are " + join(names),
                "name one of them");
  }
} // namespace retroforge
