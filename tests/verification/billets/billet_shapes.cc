// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// billet_shapes CASE.prm: how well the billet of a case follows the parameters of its shape. For each of
// them, changed by up to 10 % of its nominal value, prints the relative difference between dX_0/dmu and
// central differences of fourth order (151), and the relative change of the volume of the mesh; then the
// largest of each as figures.

#include <deal.II/base/mpi.h>

#include <retroforge/case/parameters.h>
#include <retroforge/design/billet_map.h>
#include <retroforge/mesh/mesh_quality.h>

#include <iostream>

using namespace retroforge;

class Study
{
public:
  explicit Study(const BilletParameters &billet)
      : mesh_(make_billet(billet, MPI_COMM_WORLD)), map_(billet, mesh_)
  {
    for (const ShapeParameter &shape : map_.parameters())
      nominal_.push_back(shape.nominal);
  }

  void run()
  {
    std::cout
      << mesh_.n_nodes() << " nodes, " << mesh_.n_cells() << " tetrahedra, volume "
      << volume(mesh_.cells, mesh_.X) << " mm3\n"
      << "| parameter | change | differences | volume | least quality |\n| --- | --- | --- | --- | --- |\n";
    double derivatives = 0., volumes = 0., quality = 1.;
    for (unsigned int j = 0; j < nominal_.size(); ++j)
      for (const double change : {-0.1, -0.03, 0., 0.03, 0.1})
      {
        std::vector<double> mu = nominal_;
        mu[j] += change * map_.parameters()[j].scale;
        const auto   X     = map_.positions(mu);
        const double loss  = std::abs(volume(mesh_.cells, X) / volume(mesh_.cells, mesh_.X) - 1.);
        const double error = derivative_error(mu, j), least = minimum_quality(mesh_.cells, X);
        std::cout << "| " << map_.parameters()[j].name << " | " << mu[j] - nominal_[j] << " mm | " << error
                  << " | " << loss << " | " << least << " |\n";
        derivatives = std::max(derivatives, error);
        volumes     = std::max(volumes, loss);
        quality     = std::min(quality, least);
      }
    std::cout << "FIGURE derivative " << derivatives << "\nFIGURE volume " << volumes << "\nFIGURE quality "
              << quality << std::endl;
  }

private:
  // sqrt( sum |exact - differences|^2 / sum |exact|^2 ) over the nodes
  double derivative_error(const std::vector<double> &mu, const unsigned int j) const
  {
    std::vector<Dual> direction(mu.begin(), mu.end());
    direction[j].fastAccessDx(0) = 1.;
    const auto   exact           = map_.positions(direction);
    const double step            = 1e-3 * map_.parameters()[j].scale;
    const auto   at              = [&](const int multiple) {
      std::vector<double> moved = mu;
      moved[j] += multiple * step;
      return map_.positions(moved);
    };
    const auto far_down = at(-2), down = at(-1), up = at(1), far_up = at(2);
    double     error = 0., size = 0.;
    for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
    {
      const Vec3 differences = (8. * (up[k] - down[k]) - (far_up[k] - far_down[k])) / (12. * step);
      for (unsigned int i = 0; i < 3; ++i)
      {
        error += std::pow(exact[k][i].dx(0) - differences[i], 2);
        size += std::pow(exact[k][i].dx(0), 2);
      }
    }
    return std::sqrt(error / size);
  }

  const TetMesh       mesh_;
  const BilletMap     map_;
  std::vector<double> nominal_;
};

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc != 2)
  {
    std::cerr << "usage: billet_shapes CASE.prm" << std::endl;
    return 2;
  }
  std::string echo;
  Study(Parameters::read(argv[1], {}, echo).billet).run();
}
