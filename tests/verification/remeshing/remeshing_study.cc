// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
//
// Many remeshings of a workpiece that moves in a known way, and fields of nodes and of cells carried through all of them:
//   remeshing_study cylinder|star ELEMENT_SIZE REMESHINGS local|rebuild [WIDTH]
// A billet of height 60 is upset to 20, z -> f z, x, y -> f^(-1/2) x, y with a slight barrel, in equal
// logarithmic steps, and remeshed after each. The star is a prism of eight teeth, like a gear. The fields are a
// Gaussian of standard deviation WIDTH, or twice the mean edge length h, in the material: at a node its exact
// value is known from where the node was at the start, and in a cell from its centre. Drift is the farthest a node of the side is from where
// the side would be, over the width of the workpiece. One line of CSV at remeshings 10, 30, 60, 100 and the
// last. Microseconds are those of the processor per cell of the new mesh, on the average: of a remeshing with
// all that is part of it, and of finding J, which is part of that, and applying it to the seven fields of a
// run.

#include <deal.II/base/mpi.h>

#include <retroforge/billet/billet.h>
#include <retroforge/billet/gmsh_mesher.h>
#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/trigger.h>
#include <retroforge/time/remesher.h>
#include <retroforge/transfer/cell_transfer.h>

#include <ctime>
#include <fstream>
#include <iostream>

using namespace retroforge;

namespace
{
  constexpr double height = 60., final_height = 20.;

  /// Radial stretch of a step by f at the relative height zeta; the mean of its square is 1/f.
  double stretch(const double f, const double zeta)
  {
    return (1. + 0.005 * (zeta * (1. - zeta) - 1. / 6.)) / std::sqrt(f);
  }

  void deform(NodalVectors<double> &X, const double before, const double f)
  {
    for (Vec3 &x : X)
    {
      const double s = stretch(f, x[2] / before);
      x              = Vec3({s * x[0], s * x[1], f * x[2]});
    }
  }

  /// Radius of a star of eight teeth over that of the circle.
  double star(const Vec3 &x)
  {
    return 1. + 0.12 * std::cos(8. * std::atan2(x[1], x[0]));
  }

  /// A prism with a star as base, written as an extruded Gmsh geometry would be: its mesh comes from the
  /// mesher's own cylinder, each node moved radially onto the star.
  void make_star(TetMesh &mesh, const double radius)
  {
    const auto move = [&](const Vec3 &x) {
      const double factor = 1. + (star(x) - 1.) * std::pow(std::hypot(x[0], x[1]) / radius, 4);
      return Vec3({factor * x[0], factor * x[1], x[2]});
    };
    for (Vec3 &x : mesh.X)
      x = move(x);
  }

  double gaussian(const Vec3 &x, const double width)
  {
    const Vec3 d = x - Vec3({5., 3., 0.5 * height});
    return std::exp(-0.5 * d.norm_square() / (width * width));
  }

  template <typename Action>
  double cpu_seconds(const Action &action)
  {
    const auto start = std::clock();
    action();
    return double(std::clock() - start) / CLOCKS_PER_SEC;
  }

  /// Finds J once more and applies it to the seven fields of a run (velocity, pressure, position).
  void transfer_again(const TetMesh              &mesh,
                      const NodalVectors<double> &X,
                      const RemeshRecord         &record,
                      const std::vector<double>  &q)
  {
    std::vector<NodeIndex> old_node(record.mesh.n_nodes(), invalid_index);
    for (NodeIndex k = 0; k < old_node.size(); ++k)
      if (const unsigned int first = record.transfer.begin[k]; record.transfer.begin[k + 1] == first + 1)
        old_node[k] = record.transfer.node[first];
    const TransferOperator J = make_transfer(mesh, X, record.mesh, old_node);
    for (unsigned int field = 0; field < 7; ++field)
      J.apply(q);
  }

  struct Study
  {
    double n_steps, worst_angle = 180., worst_kept = 1., worst_volume = 0., n_cells = 0.;
    double seconds = 0., transfer_seconds = 0.;
    int    done = 0;

    double before(const int step) const { return height * std::pow(final_height / height, step / n_steps); }

    /// Where a point of the last configuration was at the start.
    Vec3 material_point(Vec3 x) const
    {
      const double zeta = x[2] / before(done);
      for (int step = done; step-- > 0;)
      {
        const double f = before(step + 1) / before(step), s = stretch(f, zeta);
        x = Vec3({x[0] / s, x[1] / s, x[2] / f});
      }
      return x;
    }

    /// Farthest a node of the side is from the side, along the radius, over the width at mid-height.
    double
    drift(const TetMesh &mesh, const NodalVectors<double> &X, const bool is_star, const double radius) const
    {
      double farthest = 0., width = 0.;
      for (const auto &face : mesh.faces)
        if (mesh.patches[face.patch].name == "side")
          for (const NodeIndex k : face.nodes)
          {
            const Vec3   x = material_point(X[k]);
            const double r = std::hypot(x[0], x[1]), now = std::hypot(X[k][0], X[k][1]);
            farthest = std::max(farthest, std::abs(r - (is_star ? star(x) : 1.) * radius) * now / r);
            width    = std::max(width, 2. * now);
          }
      return farthest / width;
    }

    /// Relative L2 error of a field of nodes, with lumped masses.
    double error(const TetMesh              &mesh,
                 const NodalVectors<double> &X,
                 const std::vector<double>  &q,
                 const double                width) const
    {
      double square = 0., reference = 0.;
      for (const auto &cell : mesh.cells)
        for (const NodeIndex k : cell)
        {
          const double exact = gaussian(material_point(X[k]), width), V = tet_volume(corners(cell, X));
          square += V * (q[k] - exact) * (q[k] - exact);
          reference += V * exact * exact;
        }
      return std::sqrt(square / reference);
    }

    double
    of_cell(const TetMesh &mesh, const NodalVectors<double> &X, const CellIndex c, const double width) const
    {
      Vec3 centre;
      for (const NodeIndex k : mesh.cells[c])
        centre += 0.25 * X[k];
      return gaussian(material_point(centre), width);
    }

    /// Relative L2 error of a field of cells, and that of its integral.
    std::pair<double, double> errors_in_cells(const TetMesh              &mesh,
                                              const NodalVectors<double> &X,
                                              const std::vector<double>  &q,
                                              const double                width) const
    {
      double square = 0., reference = 0., sum = 0., exact_sum = 0.;
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      {
        const double exact = of_cell(mesh, X, c, width), V = tet_volume(corners(mesh.cells[c], X));
        square += V * (q[c] - exact) * (q[c] - exact);
        reference += V * exact * exact;
        sum += V * q[c];
        exact_sum += V * exact;
      }
      return {std::sqrt(square / reference), sum / exact_sum - 1.};
    }
  };
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc != 5 && argc != 6)
    return 1;
  const std::string shape = argv[1], method = argv[4];
  const double      size = std::stod(argv[2]);
  const int         n    = std::stoi(argv[3]);

  BilletParameters billet;
  billet.shape        = BilletParameters::Shape::cylinder;
  billet.radius       = 20.;
  billet.height       = height;
  billet.element_size = size;
  TetMesh mesh        = make_billet(billet, MPI_COMM_WORLD);
  if (shape == "star")
    make_star(mesh, billet.radius);
  double h = 0.;
  for (const auto &cell : mesh.cells)
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < a; ++b)
        h += (mesh.X[cell[a]] - mesh.X[cell[b]]).norm() / (6. * mesh.n_cells());

  RemesherParameters parameters;
  parameters.when   = RemesherParameters::When::increments;
  parameters.method = RemesherParameters::Method::local;
  const std::vector<Die> dies;
  Timings                timings;
  mesh = Remesher(parameters, h, dies, mesh.patches, MPI_COMM_WORLD)
           .remesh(mesh, mesh.X, {}, {}, 0., timings)
           ->mesh;
  parameters.method =
    method == "rebuild" ? RemesherParameters::Method::rebuild : RemesherParameters::Method::local;
  const Remesher remesher(parameters, h, dies, mesh.patches, MPI_COMM_WORLD);

  Study                study{1. * n};
  const double         V0 = volume(mesh.cells, mesh.X), width = argc == 6 ? std::stod(argv[5]) : 2. * h;
  NodalVectors<double> X = mesh.X;
  std::vector<double>  q, in_cells;
  for (const Vec3 &x : X)
    q.push_back(gaussian(x, width));
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    in_cells.push_back(study.of_cell(mesh, X, c, width));
  std::cout
    << "remeshings,nodes,cells,L2,cells_L2,cells_integral,angle,kept,volume,drift,microseconds,transfer\n";
  for (int step = 0; step < n; ++step)
  {
    const double z = study.before(step), f = study.before(step + 1) / z;
    deform(X, z, f);
    ++study.done;
    const double                        before = volume(mesh.cells, X);
    std::shared_ptr<const RemeshRecord> record;
    study.seconds += cpu_seconds([&]() { record = remesher.remesh(mesh, X, {}, {}, 0., timings); });
    study.transfer_seconds += cpu_seconds([&]() { transfer_again(mesh, X, *record, q); });
    q        = record->transfer.apply(q);
    in_cells = transfer_cells<double>({mesh, X, record->transfer, record->mesh, record->mesh.X}, in_cells);
    mesh     = record->mesh;
    X        = mesh.X;
    unsigned int kept = 0;
    for (unsigned int k = 0; k < mesh.n_nodes(); ++k)
      kept += record->transfer.begin[k + 1] == record->transfer.begin[k] + 1;
    study.worst_kept   = std::min(study.worst_kept, double(kept) / mesh.n_nodes());
    study.worst_angle  = std::min(study.worst_angle, minimum_free_angle(mesh, X));
    study.worst_volume = std::max(study.worst_volume, std::abs(volume(mesh.cells, X) / before - 1.));
    study.n_cells += mesh.n_cells();
    if (const int done = step + 1; done == 10 || done == 30 || done == 60 || done == n)
    {
      const auto [of_cells, of_integral] = study.errors_in_cells(mesh, X, in_cells, width);
      std::cout << done << ',' << mesh.n_nodes() << ',' << mesh.n_cells() << ','
                << study.error(mesh, X, q, width) << ',' << of_cells << ',' << of_integral << ','
                << study.worst_angle << ',' << study.worst_kept << ',' << study.worst_volume << ','
                << study.drift(mesh, X, shape == "star", billet.radius) << ','
                << 1e6 * study.seconds / study.n_cells << ',' << 1e6 * study.transfer_seconds / study.n_cells
                << std::endl;
    }
  }
  std::cerr << "volume from first to last " << volume(mesh.cells, X) / V0 - 1. << "\n";
}
