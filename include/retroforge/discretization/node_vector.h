// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/lac/la_parallel_vector.h>

#include <retroforge/discretization/node_numbering.h>

#include <type_traits>

namespace retroforge
{
  inline void complete_entries(const ReplicatedEntries &entries, double *values, const unsigned int width)
  {
    entries.complete(values, width);
  }

  /// Completes values and derivatives of dual numbers.
  template <typename Number>
  void complete_entries(const ReplicatedEntries &entries, Number *values, const unsigned int width)
  {
    const std::size_t   n = width * entries.range().n;
    std::vector<double> numbers;
    numbers.reserve(2 * n);
    for (std::size_t i = 0; i < n; ++i)
      numbers.insert(numbers.end(), {values[i].val(), values[i].dx(0)});
    entries.complete(numbers.data(), 2 * width);
    for (std::size_t i = 0; i < n; ++i)
    {
      values[i]                 = Number(numbers[2 * i]);
      values[i].fastAccessDx(0) = numbers[2 * i + 1];
    }
  }

  /// Values at the nodes of a space, `width` of them at each: of double, deal.II's distributed vector on the
  /// partitioner of the space's DoFHandler; of dual numbers, which it does not know, an array on the same
  /// partitioner. A rank has the entries of its own nodes and of those it reads (NodeNumbering).
  template <int width, typename Number>
  class NodeVector
  {
    static constexpr bool of_dealii = std::is_same_v<Number, double>;
    using Storage =
      std::conditional_t<of_dealii, dealii::LinearAlgebra::distributed::Vector<double>, std::vector<Number>>;

  public:
    using Entry = std::conditional_t<width == 1, Number, dealii::Tensor<1, width, Number>>;

    NodeVector() = default;

    /// Zero.
    explicit NodeVector(std::shared_ptr<const NodeNumbering> numbering) : numbering_(std::move(numbering))
    {
      if (!numbering_)
        return;
      if constexpr (of_dealii)
        values_.reinit(numbering_->partitioner());
      else
        values_.assign(width * numbering_->n_places(), Number(0.));
    }

    /// A copy has the ghosts, too, which a copy of deal.II's vector has not.
    NodeVector(const NodeVector &other) : NodeVector(other.numbering_)
    {
      std::copy(other.begin(), other.end(), begin());
    }
    NodeVector(NodeVector &&other) noexcept { swap(other); }
    NodeVector &operator=(NodeVector other) noexcept
    {
      swap(other);
      return *this;
    }

    void swap(NodeVector &other) noexcept
    {
      std::swap(numbering_, other.numbering_);
      if constexpr (of_dealii)
        values_.swap(other.values_);
      else
        std::swap(values_, other.values_);
    }

    bool         empty() const { return !numbering_; }
    unsigned int size() const { return numbering_ ? numbering_->n_places() : 0; }

    const std::shared_ptr<const NodeNumbering> &numbering() const { return numbering_; }

    /// At a place.
    Entry &at_place(const unsigned int place)
    {
      Assert(place < size(), dealii::ExcIndexRange(place, 0, size()));
      return begin()[place];
    }
    const Entry &at_place(const unsigned int place) const
    {
      Assert(place < size(), dealii::ExcIndexRange(place, 0, size()));
      return begin()[place];
    }

    /// At node k, which this rank owns or reads.
    Entry       &operator[](const NodeIndex k) { return at_place(numbering_->place(k)); }
    const Entry &operator[](const NodeIndex k) const { return at_place(numbering_->place(k)); }

    // Entries lie one after the other, and so do the numbers of each.
    Entry       *begin() { return reinterpret_cast<Entry *>(numbers()); }
    const Entry *begin() const { return reinterpret_cast<const Entry *>(numbers()); }
    Entry       *end() { return begin() + size(); }
    const Entry *end() const { return begin() + size(); }

    /// Ghosts from their owners. Collective.
    void update_ghosts()
    {
      static_assert(of_dealii);
      values_.update_ghost_values();
      values_.set_ghost_state(false); // sums may be written again
    }

    /// Owned entries with what others have added to their ghosts of them, in the order of ranks; ghosts are
    /// zero then. Collective.
    void sum_ghosts()
    {
      static_assert(of_dealii);
      values_.compress(dealii::VectorOperation::add);
    }

    /// Values at `nodes`, which are this vector's or the first of them on each rank, in the order of their
    /// numbers, on every rank. Collective.
    std::vector<Entry> complete(const NodeNumbering &nodes) const
    {
      std::vector<Entry> all(nodes.n());
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        all[nodes.owned()[i]] = at_place(i);
      complete_entries(nodes.nodes(), reinterpret_cast<Number *>(all.data()), width);
      return all;
    }

    /// The reverse: from values at the first nodes by number, on every rank, those that it has.
    void take(const std::vector<Entry> &all)
    {
      for (unsigned int place = 0; place < size(); ++place)
        if (const NodeIndex k = numbering_->node_at(place); k < all.size())
          at_place(place) = all[k];
    }

  private:
    Number       *numbers() { return empty() ? nullptr : &*values_.begin(); }
    const Number *numbers() const { return empty() ? nullptr : &*values_.begin(); }

    std::shared_ptr<const NodeNumbering> numbering_;
    Storage                              values_;
  };
} // namespace retroforge
