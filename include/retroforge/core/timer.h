// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace retroforge
{
  /// Wall-clock time by name, on this rank:  `const auto scope = timings.scope("assembly");`
  ///
  /// Scopes may nest; each name accumulates its own inclusive time, and a name nested in itself counts once.
  /// The clock never jumps backwards.
  class Timings
  {
    struct Entry
    {
      double                                seconds = 0;
      unsigned int                          depth   = 0; ///< open scopes of this name
      std::chrono::steady_clock::time_point start;
    };

  public:
    /// Adds its own lifetime to a name.
    class [[nodiscard]] Scope
    {
    public:
      Scope(Timings &timings, const std::string &name) : entry_(timings.entries_[name])
      {
        if (entry_.depth++ == 0)
          entry_.start = std::chrono::steady_clock::now();
      }
      ~Scope()
      {
        if (--entry_.depth == 0)
          entry_.seconds += elapsed(entry_);
      }
      Scope(const Scope &)            = delete;
      Scope &operator=(const Scope &) = delete;

    private:
      Entry &entry_;
    };

    Scope scope(const std::string &name) { return Scope(*this, name); }

    /// Accumulated time, open scopes included; zero for a name never seen. Units: s.
    double seconds(const std::string &name) const
    {
      const auto found = entries_.find(name);
      return found == entries_.end() ? 0. : total(found->second);
    }

    std::map<std::string, double> all() const
    {
      std::map<std::string, double> times;
      for (const auto &[name, entry] : entries_)
        times[name] = total(entry);
      return times;
    }

  private:
    std::map<std::string, Entry> entries_; // a map: references to its entries stay valid

    static double elapsed(const Entry &entry)
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - entry.start).count();
    }

    static double total(const Entry &entry)
    {
      return entry.seconds + (entry.depth > 0 ? elapsed(entry) : 0.);
    }
  };
} // namespace retroforge
