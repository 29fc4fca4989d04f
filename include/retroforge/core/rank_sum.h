// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>

#include <deal.II/base/mpi.h>

#include <utility>

namespace retroforge
{
  namespace internal
  {
    inline void append(const double x, std::vector<double> &numbers)
    {
      numbers.push_back(x);
    }
    inline void append(const Dual &x, std::vector<double> &numbers)
    {
      numbers.insert(numbers.end(), {x.val(), x.dx(0)});
    }
    inline void extract(std::vector<double>::const_iterator &next, double &x)
    {
      x = *next++;
    }
    inline void extract(std::vector<double>::const_iterator &next, Dual &x)
    {
      x                 = Dual(*next++);
      x.fastAccessDx(0) = *next++;
    }
  } // namespace internal

  /// A sum over the ranks of a communicator of which each rank holds its part: a number, a list, or an
  /// aggregate of numbers (numbers.h), of the same shape on every rank. It is of no use before complete(), so
  /// that a part is never taken for the sum.
  template <typename T>
  class RankSum
  {
  public:
    RankSum(T part, MPI_Comm comm) : part_(std::move(part)), comm_(comm) {}

    /// Returns what this rank adds.
    T       &part() { return part_; }
    const T &part() const { return part_; }

    /// Adds what all ranks know alike, once in the sum.
    /// @param add  is called with the part of the one rank that adds it
    template <typename F>
    void add_once(const F &add)
    {
      if (dealii::Utilities::MPI::this_mpi_process(comm_) == 0)
        add(part_);
    }

    /// Returns the sum over all ranks, the same on each. Collective.
    T complete() const
    {
      std::vector<double> numbers;
      for_each_number([&](const auto &x) { internal::append(x, numbers); }, part_);
      dealii::Utilities::MPI::sum(numbers, comm_, numbers);
      T    sum  = part_;
      auto next = numbers.cbegin();
      for_each_number([&](auto &x) { internal::extract(next, x); }, sum);
      return sum;
    }

  private:
    T        part_;
    MPI_Comm comm_;
  };
} // namespace retroforge
