// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <string>

namespace retroforge
{
  /// The objects of a kind that parameter files choose from by name, such as laws. Their numbers are those in
  /// which they were added, and stay: users of the library may add others.
  template <typename T>
  class Registry
  {
  public:
    /// @param kind  what an object is, as messages say it: "law of friction"
    Registry(std::string kind, const std::string &first_name, std::unique_ptr<const T> first)
        : kind_(std::move(kind))
    {
      add(first_name, std::move(first));
    }

    /// Adds an object by a new name.
    void add(const std::string &name, std::unique_ptr<const T> object)
    {
      Assert(object != nullptr, dealii::ExcMessage("no " + kind_));
      const auto known = names();
      AssertThrow(std::find(known.begin(), known.end(), name) == known.end(),
                  dealii::ExcMessage("there is a " + kind_ + " of the name " + name));
      entries_.emplace_back(name, std::move(object));
    }

    const T &operator[](const unsigned int i) const
    {
      AssertIndexRange(i, entries_.size());
      return *entries_[i].second;
    }

    std::vector<std::string> names() const
    {
      std::vector<std::string> names;
      for (const auto &entry : entries_)
        names.push_back(entry.first);
      return names;
    }

    /// Returns the number of the object of this name.
    /// @param where  the setting that names it
    /// @throws Error  where there is none
    unsigned int find(const std::string &name, const std::string &where) const
    {
      const std::vector<std::string> known = names();
      const auto                     found = std::find(known.begin(), known.end(), name);
      if (found == known.end())
      {
        const std::string near = nearest_name(name, known, tolerated_edits(name));
        throw Error(where,
                    "'" + name + "' is no " + kind_,
                    "there are: " + join(known),
                    near.empty() ? "name one of these" : "did you mean '" + near + "'?");
      }
      return found - known.begin();
    }

  private:
    std::string                                                  kind_;
    std::deque<std::pair<std::string, std::unique_ptr<const T>>> entries_; ///< references to them stay
  };
} // namespace retroforge
