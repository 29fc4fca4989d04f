// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_stress.h>
#include <retroforge/solver/equilibrium.h>

/// @file
/// The stress of the metal in a cell, for what follows from it point by point: maxima of it, damage.
namespace retroforge
{
  /// Means over a cell, and its law; or derivatives of a scalar in them, number by number.
  template <typename Number>
  struct CellStress
  {
    Symmetric<Number>   s;    ///< deviator [MPa]
    Number              p;    ///< mean of the pressures at the corners [MPa]
    Number              rate; ///< equivalent strain rate e [1/s]
    MaterialLaw<Number> law;

    /// Flow stress  sigma_0 = sqrt(3) k  [MPa], k that of the law at the mean strain rate.
    Number flow_stress() const { return std::sqrt(3.) * law.shear_stress(Number(rate * rate)); }

    /// Largest principal stress of  s - p I  [MPa].
    Number largest_principal_stress() const { return largest_principal(s) - p; }
  };

  /// Returns that of a cell that this rank visits.
  template <typename Number>
  CellStress<Number> cell_stress(const EquilibriumView<Number> &view, CellIndex c);

  /// Adds the derivatives of a scalar to bar, where stress_bar are those in cell_stress().
  void reverse_cell_stress(const EquilibriumView<double> &view,
                           CellIndex                      c,
                           const CellStress<double>      &stress_bar,
                           EquilibriumBar                &bar);

  namespace internal
  {
    template <typename F, typename... Stresses>
    void for_each_stress_number(const F &f, Stresses &...stresses)
    {
      for (unsigned int k = 0; k < 6; ++k)
        f(stresses.s[k]...);
      f(stresses.p...);
      f(stresses.rate...);
      for_each_number(f, stresses.law...);
    }
  } // namespace internal

  /// Derivatives of  weight * f,  f a function of a CellStress of any number type that returns that type, by dual
  /// numbers.
  template <typename F>
  CellStress<double> derivatives(const double weight, const F &f, const CellStress<double> &at)
  {
    constexpr unsigned int n = 8 + sizeof(MaterialLaw<double>) / sizeof(double);
    using Derived            = Sacado::Fad::SFad<double, n>;
    CellStress<Derived> x;
    unsigned int        i = 0;
    internal::for_each_stress_number(
      [&](Derived &number, const double &value) { number = Derived(n, i++, value); }, x, at);
    const Derived      value = f(x);
    CellStress<double> bar;
    i = 0;
    internal::for_each_stress_number([&](double &number) { number = weight * value.dx(i++); }, bar);
    return bar;
  }
} // namespace retroforge
