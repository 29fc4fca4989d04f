// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/core/types.h>

#include <deal.II/base/exceptions.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>

/// @file
/// Aggregates of numbers, visited one number after the other, so that sums, copies to another number type and
/// products of derivatives are loops. An aggregate `template <typename Number> struct A` has
/// `template <typename Self> static auto members(Self &self) { auto &[a, b] = self; return std::tie(a, b); }`
/// where the structured binding does not compile when a member is forgotten. Members are numbers, vectors of
/// space, lists, aggregates, and integers and shared data, which are decisions: they are copied, and have no
/// derivative.
namespace retroforge
{
  template <typename T>
  struct IsNumber : std::is_floating_point<T>
  {
  };
  template <int N>
  struct IsNumber<Sacado::Fad::SFad<double, N>> : std::true_type
  {
  };

  namespace internal
  {
    template <typename T>
    struct IsVector : std::false_type
    {
    };
    template <int dim, typename Number>
    struct IsVector<dealii::Tensor<1, dim, Number>> : std::true_type
    {
    };

    template <typename T>
    struct IsShared : std::false_type
    {
    };
    template <typename T>
    struct IsShared<std::shared_ptr<const T>> : std::true_type
    {
    };

    template <typename T>
    std::true_type  is_list(const std::vector<T> *);
    std::false_type is_list(const void *);

    /// A list is a std::vector or made from one.
    template <typename T>
    using IsList = decltype(is_list(static_cast<const T *>(nullptr)));

    template <std::size_t i, typename F, typename... Tuples>
    void visit_member(const F &f, const Tuples &...members)
    {
      f(std::get<i>(members)...);
    }

    template <typename F, std::size_t... i, typename... Tuples>
    void visit_members(const F &f, std::index_sequence<i...>, const Tuples &...members)
    {
      (visit_member<i>(f, members...), ...);
    }

    /// f(member of a, the same member of b, ...) of each member.
    template <typename F, typename First, typename... Others>
    void for_each_member(const F &f, First &a, Others &...others)
    {
      const auto members = std::remove_const_t<First>::members(a);
      visit_members(f,
                    std::make_index_sequence<std::tuple_size_v<decltype(members)>>(),
                    members,
                    std::remove_const_t<Others>::members(others)...);
    }
  } // namespace internal

  /// f(x, y, ...) of each number of a and its partners in aggregates of the same shape. Of lists, one may be
  /// empty where others are not: then there is nothing to visit.
  template <typename F, typename First, typename... Others>
  void for_each_number(const F &f, First &a, Others &...others)
  {
    using T = std::remove_const_t<First>;
    if constexpr (IsNumber<T>::value)
      f(a, others...);
    else if constexpr (internal::IsVector<T>::value)
      for (unsigned int i = 0; i < T::dimension; ++i)
        for_each_number(f, a[i], others[i]...);
    else if constexpr (internal::IsList<T>::value)
    {
      const std::size_t n = std::min({a.size(), others.size()...});
      AssertThrow(n == 0 || n == std::max({a.size(), others.size()...}),
                  dealii::ExcMessage("aggregates of different shapes"));
      for (std::size_t k = 0; k < n; ++k)
        for_each_number(f, a[k], others[k]...);
    }
    else if constexpr (!std::is_integral_v<T> && !internal::IsShared<T>::value)
      internal::for_each_member([&f](auto &...member) { for_each_number(f, member...); }, a, others...);
  }

  /// Copies all of `from` into `to`, which takes its shape; derivatives are lost on the way to double, and
  /// zero on the way from it.
  template <typename From, typename To>
  void convert(const From &from, To &to)
  {
    if constexpr (std::is_same_v<From, To>)
      to = from;
    else if constexpr (std::is_same_v<To, double>)
      to = value_of(from);
    else if constexpr (IsNumber<To>::value)
      to = To(from);
    else if constexpr (internal::IsVector<To>::value)
      for (unsigned int i = 0; i < To::dimension; ++i)
        convert(from[i], to[i]);
    else if constexpr (internal::IsList<To>::value)
    {
      to.resize(from.size());
      for (std::size_t k = 0; k < from.size(); ++k)
        convert(from[k], to[k]);
    }
    else
      internal::for_each_member([](const auto &a, auto &b) { convert(a, b); }, from, to);
  }

  /// Returns the aggregate with another number type.
  template <typename To, template <typename> class Aggregate, typename From>
  Aggregate<To> converted(const Aggregate<From> &from)
  {
    Aggregate<To> to;
    convert(from, to);
    return to;
  }

  /// Name, unit and range of a number of an aggregate, which users may choose as a design parameter. An
  /// aggregate with a static `info()` returns those of all its numbers, in their order.
  struct NumberInfo
  {
    std::string name, unit;
    bool        may_vanish = false; ///< else it is positive
    double      largest    = std::numeric_limits<double>::infinity();
    /// The value of one that is not given; none: it must be.
    std::optional<double> otherwise = {};
    bool                  any_sign  = false; ///< it may be negative, too
  };

  /// Number i of an aggregate.
  template <typename Number, template <typename> class Aggregate>
  Number &number_of(Aggregate<Number> &x, const unsigned int i)
  {
    std::vector<Number *> numbers;
    for_each_number([&](Number &number) { numbers.push_back(&number); }, x);
    return *numbers.at(i);
  }

  /// sum += part, number by number.
  template <typename Aggregate>
  void add_numbers(const Aggregate &part, Aggregate &sum)
  {
    for_each_number([](const double &x, double &y) { y += x; }, part, sum);
  }
} // namespace retroforge
