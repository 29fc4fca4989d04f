// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Penalised rows of a ring of 8 nodes, as many as two unknowns of each, that share entries. Proved, of a
// symmetric system and of an unsymmetric one, and of the transposed ones:
// - what is added makes the residual vanish in these rows to 1e-10, and other unknowns stay, for each of 100
//   residuals;
// - also where a Krylov space of the rows is exhausted after one step, and its next direction is nothing but
//   rounding, or nothing: they are multiples of unit rows, or close to that, or the residual is an
//   eigenvector;
// - without a residual, or without rows, all stays bit for bit; so it does where unsymmetric rows are
// singular.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/penalised_rows.h>

#include <algorithm>
#include <functional>
#include <iostream>

using namespace retroforge;

namespace
{
  constexpr unsigned int n_nodes = 8, n = 3 * n_nodes;

  using Values = std::function<double(unsigned int, unsigned int)>;

  Rows<unsigned int> ring()
  {
    Rows<unsigned int> rows;
    for (unsigned int a = 0; a < n_nodes; ++a)
    {
      for (const unsigned int b : {a, a + 1, a + n_nodes - 1})
        rows.entries.push_back(b % n_nodes);
      rows.begin.push_back(rows.entries.size());
    }
    return rows;
  }

  struct Ring
  {
    la::SparseMatrix matrix;
    SaddleSystem     system;

    Ring(const bool symmetric, const std::vector<unsigned int> &rows, const Values &values)
    {
      const NodeRange nodes{0, n_nodes, n_nodes};
      system.A = std::make_unique<NodeMatrix>(
        matrix, std::make_shared<const NodePattern>(nodes, nodes, ring()), 3, 3, MPI_COMM_WORLD);
      system.symmetric        = symmetric;
      system.penalised        = rows;
      system.penalties_couple = true;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int e = 0; e < system.A->row(i).n; ++e)
          system.A->row(i).values[e] = values(i, system.A->row(i).columns[e]);
    }

    /// r - A x,  or r - A^T x.
    std::vector<double>
    rest(const Transposition transposition, std::vector<double> r, const std::vector<double> &x) const
    {
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int e = 0; e < system.A->row(i).n; ++e)
        {
          const unsigned int j     = system.A->row(i).columns[e];
          const double       value = system.A->row(i).values[e];
          if (transposition == Transposition::plain)
            r[i] -= value * x[j];
          else
            r[j] -= value * x[i];
        }
      return r;
    }
  };

  /// The first and the last unknown of each node.
  std::vector<unsigned int> held()
  {
    std::vector<unsigned int> rows;
    for (unsigned int i = 0; i < n; ++i)
      if (i % 3 != 1)
        rows.push_back(i);
    return rows;
  }

  using Residual = std::vector<double>;

  std::vector<Residual> some_residuals()
  {
    std::vector<Residual> residuals(100, Residual(n));
    for (unsigned int k = 0; k < residuals.size(); ++k)
      for (unsigned int i = 0; i < n; ++i)
        residuals[k][i] = std::sin(1. + 2.3 * i + 1.1 * k);
    return residuals;
  }

  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  std::vector<double> change(const Ring &ring, const Transposition transposition, const Residual &r)
  {
    std::vector<double> x(n, 0.);
    solve_penalised_rows(ring.system, transposition, r.data(), x.data());
    return x;
  }

  void check(const std::string &name, const Ring &ring, const std::vector<Residual> &residuals)
  {
    std::cout << (ring.system.symmetric ? "symmetric, " : "unsymmetric, ") << name << ":";
    for (const Transposition transposition : {Transposition::plain, Transposition::transposed})
    {
      bool vanish = true, stay = true;
      for (const Residual &r : residuals)
      {
        const std::vector<double> x = change(ring, transposition, r), rest = ring.rest(transposition, r, x);
        for (unsigned int i = 0; i < n; ++i)
          if (i % 3 != 1)
            vanish = vanish && std::abs(rest[i]) < 1e-10;
          else
            stay = stay && x[i] == 0.;
      }
      std::cout << (transposition == Transposition::plain ? "" : "; transposed:") << " no residual "
                << yes(vanish) << ", others stay " << yes(stay);
    }
    std::cout << "\n";
  }

  void check_still(const std::string &name, const Ring &ring, const Residual &r)
  {
    const std::vector<double> still(n, 0.);
    std::cout << (ring.system.symmetric ? "symmetric, " : "unsymmetric, ") << name << ": all stay "
              << yes(change(ring, Transposition::plain, r) == still &&
                     change(ring, Transposition::transposed, r) == still)
              << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const std::vector<Residual>              residuals = some_residuals();
  const Residual                           none(n, 0.), equal(n, 1.);
  for (const bool symmetric : {true, false})
  {
    const auto of_pair = [symmetric](const unsigned int i, const unsigned int j) {
      return std::sin(1. + 1.7 * (i + j) + (symmetric ? 0. : 0.9 * i));
    };
    const Values coupled     = [&](const auto i, const auto j) { return i == j ? 9. + i : of_pair(i, j); };
    const Values nearly_unit = [&](const auto i, const auto j) {
      return i == j ? 2. + i : 1e-9 * of_pair(i, j);
    };
    const Values unit   = [](const auto i, const auto j) { return i == j ? 2. : 0.; };
    const Values cyclic = [&](const auto i, const auto j) {
      const bool is_next = (i / 3 + 1) % n_nodes == j / 3;
      return i == j ? 8. : is_next && !symmetric ? 0.5 : 1.;
    };
    check("coupled", Ring(symmetric, held(), coupled), residuals);
    check("nearly multiples of unit rows", Ring(symmetric, held(), nearly_unit), residuals);
    check("multiples of unit rows", Ring(symmetric, held(), unit), residuals);
    check("the residual an eigenvector", Ring(symmetric, held(), cyclic), {equal});
    check_still("no residual", Ring(symmetric, held(), coupled), none);
    check_still("no rows", Ring(symmetric, {}, coupled), residuals.front());
  }
  check_still("singular",
              Ring(false, held(), [](const auto i, const auto) { return i < n / 2 ? 1. : 2.; }),
              residuals.front());
}
