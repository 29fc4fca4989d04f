// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/gmsh_mesher.h>
#include <retroforge/billet/length_unit.h>
#include <retroforge/billet/tagged_mesh.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <cfenv>
#include <clocale>
#include <cmath>
#include <gmsh.h>
#include <map>
#include <sstream>

namespace retroforge
{
  namespace
  {
    // Gmsh runs between construction and destruction. It resets the locale and divides by zero here and
    // there, so the locale and the floating point traps are put back.
    class GmshSession
    {
    public:
      GmshSession()
      {
        std::feholdexcept(&floating_point_);
        gmsh::initialize(0, nullptr, false);
        for (const auto &[name, value] :
             std::map<std::string, double>{{"General.Terminal", 0},
                                           {"General.Verbosity", 0},
                                           {"General.NumThreads", 1},
                                           {"Mesh.RandomSeed", 1},
                                           {"Mesh.Algorithm", 6},   // frontal-Delaunay
                                           {"Mesh.Algorithm3D", 1}, // Delaunay
                                           {"Mesh.Optimize", 1},
                                           {"Mesh.MeshSizeFromCurvature", 0},
                                           {"Mesh.MeshSizeExtendFromBoundary", 0}})
          gmsh::option::setNumber(name, value);
      }

      ~GmshSession()
      {
        gmsh::finalize();
        std::setlocale(LC_ALL, locale_.c_str());
        std::fesetenv(&floating_point_);
      }

      GmshSession(const GmshSession &)            = delete;
      GmshSession &operator=(const GmshSession &) = delete;

    private:
      std::fenv_t       floating_point_;
      const std::string locale_ = std::setlocale(LC_ALL, nullptr);
    };

    // Runs an operation; whatever Gmsh throws becomes an Error.
    template <typename Operation>
    auto within_gmsh(const std::string &where, const std::string &remedy, const Operation &operation)
    {
      const GmshSession session;
      try
      {
        return operation();
      }
      catch (const Error &)
      {
        throw;
      }
      catch (...)
      {
        std::string message;
        gmsh::logger::getLastError(message);
        throw Error(where,
                    "Gmsh stopped" + (message.empty() ? "" : " with `" + message + "'"),
                    "the mesh must be made without errors",
                    remedy);
      }
    }

    int add_curve(const SplineCurve &curve, const int first, const int last, const Vec3 &c)
    {
      if (curve.is_segment())
        return gmsh::model::occ::addLine(first, last);
      std::vector<int> points = {first};
      for (unsigned int i = 1; i + 1 < curve.control_points().size(); ++i)
      {
        const Vec2 &p = curve.control_points()[i];
        points.push_back(gmsh::model::occ::addPoint(c[0] + p[0], c[1], c[2] + p[1]));
      }
      points.push_back(last);
      std::vector<double> knots;
      std::vector<int>    multiplicities(curve.n_spans() + 1, 1);
      for (unsigned int i = 0; i <= curve.n_spans(); ++i)
        knots.push_back(i / double(curve.n_spans()));
      multiplicities.front() = multiplicities.back() = curve.degree() + 1;
      return gmsh::model::occ::addBSpline(points, -1, curve.degree(), curve.weights(), knots, multiplicities);
    }

    // The section in the half plane y = c_y, x > c_x, revolved about the line through c along z.
    int add_revolved(const Section &section, const double degrees, const Vec3 &c)
    {
      std::vector<int> corners, curves;
      for (const Portion &portion : section)
      {
        const Vec2 p = portion.curve.value(0.);
        corners.push_back(gmsh::model::occ::addPoint(c[0] + p[0], c[1], c[2] + p[1]));
      }
      for (unsigned int i = 0; i < section.size(); ++i)
        curves.push_back(add_curve(section[i].curve, corners[i], corners[(i + 1) % corners.size()], c));
      const int        surface = gmsh::model::occ::addPlaneSurface({gmsh::model::occ::addCurveLoop(curves)});
      gmsh::vectorpair made;
      gmsh::model::occ::revolve({{2, surface}}, c[0], c[1], c[2], 0, 0, 1, degrees * M_PI / 180, made);
      if (degrees == 360) // the section then bounds nothing
        gmsh::model::occ::remove({{2, surface}}, true);
      return std::find_if(made.begin(), made.end(), [](const auto &entity) { return entity.first == 3; })
        ->second;
    }

    int add_whole(const CutSolid &solid)
    {
      const Vec3 &c = solid.base_centre;
      if (!solid.section.empty())
        return add_revolved(solid.section, solid.section_angle, c);
      if (solid.is_cylinder)
        return gmsh::model::occ::addCylinder(c[0], c[1], c[2], 0, 0, solid.height, solid.radius);
      return gmsh::model::occ::addBox(c[0] - solid.size[0] / 2,
                                      c[1] - solid.size[1] / 2,
                                      c[2],
                                      solid.size[0],
                                      solid.size[1],
                                      solid.size[2]);
    }

    // A box on the inner side of the plane, its outer face large enough to cut the whole solid.
    int add_half_space(const Plane &plane, const Vec3 &centre, const double size)
    {
      const double length = 4 * size + 4 * std::abs((centre - plane.point) * plane.normal);
      const int    box  = gmsh::model::occ::addBox(-length / 2, -length / 2, -length, length, length, length);
      const Vec3  &n    = plane.normal;
      const double sine = std::hypot(n[0], n[1]);
      if (sine > 0)
        gmsh::model::occ::rotate({{3, box}}, 0, 0, 0, -n[1] / sine, n[0] / sine, 0, std::atan2(sine, n[2]));
      else if (n[2] < 0)
        gmsh::model::occ::rotate({{3, box}}, 0, 0, 0, 1, 0, 0, M_PI);
      const Vec3 foot = centre - ((centre - plane.point) * n) * n;
      gmsh::model::occ::translate({{3, box}}, foot[0], foot[1], foot[2]);
      return box;
    }

    void build_geometry(const CutSolid &solid, const std::string &where)
    {
      const bool is_round = solid.is_cylinder || !solid.section.empty();
      const Vec3 width    = is_round ? Vec3({2 * solid.radius, 2 * solid.radius, solid.height}) : solid.size;
      const Vec3 centre   = solid.base_centre + Vec3({0, 0, width[2] / 2});
      gmsh::vectorpair body = {{3, add_whole(solid)}};
      for (std::size_t i = solid.n_cuts_of_section; i < solid.cuts.size(); ++i)
      {
        const Plane                  &cut = solid.cuts[i];
        gmsh::vectorpair              result;
        std::vector<gmsh::vectorpair> history;
        const int                     half = add_half_space(cut, centre, width.norm());
        gmsh::model::occ::intersect(body, {{3, half}}, result, history);
        if (result.empty())
        {
          std::ostringstream what;
          what << "the cut with outward normal (" << cut.normal << ") leaves nothing of the billet";
          throw Error(where,
                      what.str(),
                      "the material lies opposite to the outward normals of the symmetry planes",
                      "reverse the normal or move the symmetry point");
        }
        body = result;
      }
      gmsh::model::occ::synchronize();
    }

    // What is varied to get rid of slivers: the quality up to which Gmsh optimises (beyond 0.6 it more often
    // ends worse than it began), and the element size.
    struct Attempt
    {
      double threshold;
      double size_factor;
    };
    constexpr Attempt attempts[] =
      {{0.6, 1}, {0.5, 1}, {0.7, 1}, {0.6, 0.98}, {0.6, 1.02}, {0.6, 0.96}, {0.6, 1.04}, {0.6, 0.94}};
    constexpr double good_angle = 15; // degrees

    // Node tags, four for each cell.
    Tags cell_tags(const std::string &where)
    {
      std::vector<int>  types;
      std::vector<Tags> elements, nodes;
      gmsh::model::mesh::getElements(types, elements, nodes, 3);
      Tags tags;
      for (std::size_t i = 0; i < types.size(); ++i)
      {
        constexpr int linear_tetrahedron = 4;
        if (types[i] != linear_tetrahedron && !elements[i].empty())
          throw Error(where,
                      "there are " + std::to_string(elements[i].size()) +
                        " volume elements that are not linear tetrahedra (Gmsh's type " +
                        std::to_string(types[i]) + ")",
                      "all volume elements must be tetrahedra with four nodes",
                      "mesh again with `Mesh.ElementOrder = 1' and without recombination");
        tags.insert(tags.end(), nodes[i].begin(), nodes[i].end());
      }
      return tags;
    }

    // Of Gmsh's present model.
    TetMesh mesh_of_model(const std::string &where)
    {
      Tags                 tags;
      std::vector<double>  coordinates, parameters;
      NodalVectors<double> X;
      gmsh::model::mesh::getNodes(tags, coordinates, parameters);
      for (std::size_t i = 0; i < tags.size(); ++i)
        X.push_back(Vec3({coordinates[3 * i], coordinates[3 * i + 1], coordinates[3 * i + 2]}));
      TagToNode number;
      return cells_and_nodes(cell_tags(where), tags, X, number);
    }

    TetMesh attempt_mesh(const Attempt &attempt, const double element_size, const std::string &where)
    {
      gmsh::model::mesh::clear();
      gmsh::option::setNumber("Mesh.OptimizeThreshold", attempt.threshold);
      gmsh::option::setNumber("Mesh.MeshSizeMin", attempt.size_factor * element_size);
      gmsh::option::setNumber("Mesh.MeshSizeMax", attempt.size_factor * element_size);
      gmsh::model::mesh::generate(3);
      return mesh_of_model(where);
    }

    // A discrete surface with the given triangles, node tags from 1, and the volume it encloses.
    void build_enclosed_volume(const NodalVectors<double>                  &X,
                               const std::vector<std::array<NodeIndex, 3>> &triangles)
    {
      constexpr int       linear_triangle = 2;
      const int           surface         = gmsh::model::addDiscreteEntity(2);
      Tags                tags, nodes;
      std::vector<double> coordinates;
      for (NodeIndex node = 0; node < X.size(); ++node)
      {
        tags.push_back(node + 1);
        coordinates.insert(coordinates.end(), X[node].begin_raw(), X[node].end_raw());
      }
      for (const auto &triangle : triangles)
        for (const NodeIndex node : triangle)
          nodes.push_back(node + 1);
      gmsh::model::mesh::addNodes(2, surface, tags, coordinates);
      gmsh::model::mesh::addElementsByType(surface, linear_triangle, {}, nodes);
      gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop({surface})});
      gmsh::model::geo::synchronize();
    }

  } // namespace

  TetMesh mesh_with_gmsh(const CutSolid                               &solid,
                         const double                                  element_size,
                         const std::function<void(TetMesh &, double)> &improve,
                         const std::string                            &where)
  {
    return within_gmsh(
      where, "check the sizes and planes of the billet, or choose another element size", [&]() {
        gmsh::model::add("billet");
        build_geometry(solid, where);
        TetMesh best;
        double  best_angle = -1;
        for (const Attempt &attempt : attempts)
        {
          TetMesh mesh  = attempt_mesh(attempt, element_size, where);
          double  angle = minimum_dihedral_angle(mesh.cells, mesh.X);
          if (angle < good_angle)
          {
            improve(mesh, good_angle);
            angle = minimum_dihedral_angle(mesh.cells, mesh.X);
          }
          if (angle > best_angle)
          {
            best       = std::move(mesh);
            best_angle = angle;
          }
          if (best_angle >= good_angle)
            break;
        }
        return best;
      });
  }

  double volume_with_gmsh(const CutSolid &solid, const std::string &where)
  {
    return within_gmsh(where, "check the sizes and planes of the billet", [&]() {
      gmsh::model::add("billet");
      build_geometry(solid, where);
      gmsh::vectorpair bodies;
      gmsh::model::getEntities(bodies, 3);
      double volume = 0.;
      for (const auto &[dimension, tag] : bodies)
      {
        double part = 0.;
        gmsh::model::occ::getMass(dimension, tag, part);
        volume += part;
      }
      return volume;
    });
  }

  TetMesh fill_with_gmsh(const NodalVectors<double>                  &X,
                         const std::vector<std::array<NodeIndex, 3>> &triangles,
                         const std::function<double(const Vec3 &)>   &size,
                         const std::string                           &where)
  {
    return within_gmsh(where, "check that the surface is closed and does not cross itself", [&]() {
      const auto [low, high]     = bounding_box(X);
      const Vec3           sides = high - low;
      const LengthUnit     unit(std::max({sides[0], sides[1], sides[2]}));
      NodalVectors<double> in_unit;
      for (const Vec3 &x : X)
        in_unit.push_back(unit.from_mm(x));
      gmsh::model::add("enclosed");
      build_enclosed_volume(in_unit, triangles);
      gmsh::option::setNumber("Mesh.MeshSizeFromPoints", 0);
      gmsh::option::setNumber("Mesh.OptimizeThreshold", attempts[0].threshold);
      // From Gmsh 4.9 on, a last argument says what size Gmsh itself would take.
      gmsh::model::mesh::setSizeCallback(
        [&](int, int, const double x, const double y, const double z, const auto...) {
          return unit.from_mm(size(unit.to_mm(Vec3({x, y, z}))));
        });
      gmsh::model::mesh::generate(3);
      TetMesh mesh = mesh_of_model(where);
      put_in_mm(unit, mesh);
      std::copy_n(
        X.begin(), std::min(X.size(), mesh.X.size()), mesh.X.begin()); // the surface to the last bit
      return mesh;
    });
  }
} // namespace retroforge
