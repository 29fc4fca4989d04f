// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/old_surface.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  namespace
  {
    // Symmetry planes at each node, in the order of the patches.
    std::vector<std::vector<unsigned int>> symmetry_patches_by_node(const TetMesh &mesh)
    {
      std::vector<std::vector<unsigned int>> patches(mesh.n_nodes());
      for (const auto &face : mesh.faces)
        if (mesh.patches[face.patch].symmetry)
          for (const NodeIndex node : face.nodes)
            patches[node].push_back(face.patch);
      for (auto &list : patches)
      {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
      }
      return patches;
    }

    // Weight of a face in the normal of its corner: exact for nodes on a sphere (Max 1999).
    Vec3 weighted_normal(const std::array<Vec3, 3> &x, const unsigned int corner)
    {
      const Vec3   u = x[(corner + 1) % 3] - x[corner], v = x[(corner + 2) % 3] - x[corner];
      const double square = u.norm_square() * v.norm_square();
      return square > 0 ? cross_product_3d(u, v) / square : Vec3();
    }

    Vec3 normalised(const Vec3 &v, const Vec3 &otherwise)
    {
      const double length = v.norm();
      return length > 0 ? v / length : otherwise;
    }

    // Whether a surface crosses a plane nearly at a right angle: else the body has an edge there.
    bool lies_across(const Vec3 &normal, const Vec3 &n)
    {
      return std::abs(normalised(normal, normal) * n) < 0.5;
    }

    // A smooth surface crosses a symmetry plane at a right angle.
    Vec3 along_planes(Vec3 normal, const std::vector<unsigned int> &patches, const TetMesh &mesh)
    {
      const Vec3 sum = normal;
      for (const unsigned int patch : patches)
        if (const Vec3 &n = mesh.patches[patch].symmetry->normal; lies_across(sum, n))
          normal -= (normal * n) * n;
      return normal;
    }

    // Tangent of the parabola through three points, at the middle one.
    Vec3 middle_tangent(const Vec3 &before, const Vec3 &x, const Vec3 &after)
    {
      const Vec3   u = x - before, v = after - x;
      const double a = u.norm(), b = v.norm();
      return normalised((b / a) * u + (a / b) * v, v / b);
    }

    // Tangent at the end of a chord, whose other end has the tangent t: that of a circular arc.
    Vec3 end_tangent(const Vec3 &chord, const Vec3 &t)
    {
      const Vec3 unit = chord / chord.norm();
      return normalised(2 * (unit * t) * unit - t, unit);
    }

    NodalVectors<double> curve_tangents(const NodalVectors<double> &x, const bool is_closed)
    {
      const std::size_t    last = x.size() - 1;
      NodalVectors<double> t(x.size());
      for (std::size_t i = 1; i < last; ++i)
        t[i] = middle_tangent(x[i - 1], x[i], x[i + 1]);
      if (is_closed)
        t[0] = t[last] = middle_tangent(x[last - 1], x[0], x[1]);
      else if (last == 1)
        t[0] = t[1] = (x[1] - x[0]) / (x[1] - x[0]).norm();
      else
      {
        t[0]    = end_tangent(x[1] - x[0], t[1]);
        t[last] = end_tangent(x[last] - x[last - 1], t[last - 1]);
      }
      return t;
    }

    bool has_parallel(const std::vector<Plane> &planes, const Vec3 &normal)
    {
      return std::any_of(planes.begin(), planes.end(), [&](const Plane &plane) {
        return std::abs(plane.normal * normal) > 1 - 1e-12;
      });
    }

    // A smooth curve ends on a symmetry plane at a right angle.
    Vec3 end_on_planes(const Vec3                      &tangent,
                       const std::vector<unsigned int> &patches,
                       const std::vector<Plane>        &planes_of_curve,
                       const TetMesh                   &mesh)
    {
      for (const unsigned int patch : patches)
      {
        const Vec3 &n = mesh.patches[patch].symmetry->normal;
        if (!has_parallel(planes_of_curve, n) && std::abs(tangent * n) > 0.8)
          return tangent * n > 0 ? n : -n;
      }
      return tangent;
    }
  } // namespace

  Vec3 snap_to_planes(Vec3 x, const std::vector<Plane> &planes)
  {
    // Twice: the second time removes the rounding of the first.
    for (unsigned int repeat = 0; repeat < 2; ++repeat)
      if (planes.size() == 1)
        x -= ((x - planes[0].point) * planes[0].normal) * planes[0].normal;
      else if (planes.size() == 2)
      {
        const Vec3  &m = planes[0].normal, &n = planes[1].normal;
        const double d = (x - planes[0].point) * m, e = (x - planes[1].point) * n, c = m * n;
        if (1 - c * c > 1e-12)
          x -= ((d - c * e) / (1 - c * c)) * m + ((e - c * d) / (1 - c * c)) * n;
      }
    return x;
  }

  OldSurface::OldSurface(const TetMesh              &mesh,
                         const NodalVectors<double> &X,
                         const SurfaceFeatures      &features,
                         PushOut                     push_out)
      : mesh_(mesh)
      , features_(features)
      , on_planes_(symmetry_patches_by_node(mesh))
      , push_out_(std::move(push_out))
  {
    make_regions(mesh, X, features);
    make_lines(mesh, X, features);
  }

  void OldSurface::make_regions(const TetMesh              &mesh,
                                const NodalVectors<double> &X,
                                const SurfaceFeatures      &features)
  {
    regions_.resize(features.patch_of_region.size());
    std::vector<std::vector<unsigned int>> faces_of_region(regions_.size());
    for (unsigned int f = 0; f < mesh.faces.size(); ++f)
      faces_of_region[features.region_of_face[f]].push_back(f);

    NodalVectors<double> normal(mesh.n_nodes());
    for (unsigned int r = 0; r < regions_.size(); ++r)
    {
      Region &region = regions_[r];
      region.faces   = faces_of_region[r];
      for (const unsigned int f : faces_of_region[r])
      {
        const auto &n = mesh.faces[f].nodes;
        region.corners.push_back({{X[n[0]], X[n[1]], X[n[2]]}});
        for (const NodeIndex node : n)
          normal[node] = Vec3();
      }
      for (unsigned int i = 0; i < region.corners.size(); ++i)
        for (unsigned int corner = 0; corner < 3; ++corner)
          normal[mesh.faces[faces_of_region[r][i]].nodes[corner]] +=
            weighted_normal(region.corners[i], corner);

      const auto &plane = mesh.patches[features.patch_of_region[r]].symmetry;
      if (plane)
        region.planes.push_back(*plane);
      for (const unsigned int f : faces_of_region[r])
      {
        std::array<Vec3, 3> at_corners;
        for (unsigned int corner = 0; corner < 3; ++corner)
        {
          const NodeIndex node = mesh.faces[f].nodes[corner];
          const Vec3      sum  = plane ? plane->normal : along_planes(normal[node], on_planes_[node], mesh);
          at_corners[corner]   = normalised(sum, Vec3());
        }
        region.normals.push_back(at_corners);
      }
      region.tree = TriangleTree(region.corners);
    }
  }

  void
  OldSurface::make_lines(const TetMesh &mesh, const NodalVectors<double> &X, const SurfaceFeatures &features)
  {
    for (const auto &curve : features.curves)
    {
      Line line;
      for (const NodeIndex node : curve.nodes)
        line.points.push_back(X[node]);
      for (const unsigned int region : curve.regions)
        for (const Plane &plane : regions_[region].planes)
          if (!has_parallel(line.planes, plane.normal))
            line.planes.push_back(plane);
      line.is_closed = curve.is_closed();
      line.tangents  = curve_tangents(line.points, line.is_closed);
      if (!curve.is_closed())
      {
        line.tangents.front() =
          end_on_planes(line.tangents.front(), on_planes_[curve.nodes.front()], line.planes, mesh);
        line.tangents.back() =
          end_on_planes(line.tangents.back(), on_planes_[curve.nodes.back()], line.planes, mesh);
      }
      lines_.push_back(line);
    }
  }

  Vec3 OldSurface::finish(const Vec3 &x, const std::vector<Plane> &planes) const
  {
    return snap_to_planes(push_out_ ? push_out_(x) : x, planes);
  }

  Vec3 OldSurface::on_region(const unsigned int region, const Vec3 &x) const
  {
    const Region &r       = regions_[region];
    const auto    hit     = r.tree.closest(x);
    const auto   &corners = r.corners[hit.triangle];
    const auto   &normals = r.normals[hit.triangle];
    Vec3          lift;
    for (unsigned int i = 0; i < 3; ++i)
      lift += hit.at.lambda[i] * ((corners[i] - hit.at.point) * normals[i]) * normals[i];
    return finish(hit.at.point + 0.5 * lift, r.planes);
  }

  OldSurface::LinePoint OldSurface::closest_on_line(const Line &line, const Vec3 &x) const
  {
    double    distance = std::numeric_limits<double>::max();
    LinePoint closest  = {};
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
    {
      const double t = nearest_on_segment(x, line.points[i], line.points[i + 1]);
      const Vec3   p = (1 - t) * line.points[i] + t * line.points[i + 1];
      if ((x - p).norm_square() < distance)
      {
        distance = (x - p).norm_square();
        closest  = {i, t, p};
      }
    }
    return closest;
  }

  Vec3 OldSurface::on_curve(const unsigned int curve, const Vec3 &x) const
  {
    const Line     &line    = lines_[curve];
    const LinePoint closest = closest_on_line(line, x);
    Vec3            lift;
    for (unsigned int end = 0; end < 2; ++end)
    {
      const Vec3 &tangent = line.tangents[closest.segment + end];
      const Vec3  to_end  = line.points[closest.segment + end] - closest.x;
      lift += (end == 0 ? 1 - closest.t : closest.t) * (to_end - (to_end * tangent) * tangent);
    }
    return finish(closest.x + 0.5 * lift, line.planes);
  }

  TapeWriter::Slot
  OldSurface::write_on_planes(const TapeWriter::Slot x, const std::vector<Plane> &planes, TapeWriter &tape)
  {
    if (planes.empty() || planes.size() > 2)
      return x;
    if (planes.size() == 2 && std::abs(planes[0].normal * planes[1].normal) > 1 - 5e-13)
      return x; // as snap_to_planes()
    std::vector<unsigned int> arguments = {x};
    for (const Plane &plane : planes)
      arguments.push_back(tape.plane(plane));
    return tape.add(PlacingRule::snap, arguments);
  }

  TapeWriter::Slot
  OldSurface::write_finish(TapeWriter::Slot x, const std::vector<Plane> &planes, TapeWriter &tape) const
  {
    if (push_out_)
    {
      const Vec3 out   = push_out_(tape.value(x));
      const auto steps = push_out_.steps(tape.value(x));
      for (const PushStep &step : steps)
        x = tape.add(PlacingRule::push_out, {x, step.die, step.feature.facet, step.feature.kind}, {}, step.x);
      if (const Vec3 away = out - tape.value(x); steps.empty() && away != Vec3())
        x = tape.add(PlacingRule::sum, {x}, {1., away[0], away[1], away[2]});
    }
    return write_on_planes(x, planes, tape);
  }

  TapeWriter::Slot
  OldSurface::write_normal(const unsigned int region, const NodeIndex node, TapeWriter &tape) const
  {
    return tape.once(0, region, node, [&]() {
      const auto constant = [&](const Vec3 &n) {
        return tape.add(PlacingRule::constant, {}, {n[0], n[1], n[2]});
      };
      if (const auto &plane = mesh_.patches[features_.patch_of_region[region]].symmetry)
        return constant(plane->normal);
      std::vector<unsigned int> arguments = {tape.node_at_start(node)};
      Vec3                      sum;
      for (unsigned int i = 0; i < regions_[region].faces.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
        {
          const auto &nodes = mesh_.faces[regions_[region].faces[i]].nodes;
          const Vec3  part  = nodes[c] == node ? weighted_normal(regions_[region].corners[i], c) : Vec3();
          if (part == Vec3())
            continue;
          sum += part;
          for (const unsigned int other : {(c + 1) % 3, (c + 2) % 3})
            arguments.push_back(tape.node_at_start(nodes[other]));
        }
      std::vector<double> numbers;
      for (const unsigned int patch : on_planes_[node])
        if (const Vec3 &n = mesh_.patches[patch].symmetry->normal; lies_across(sum, n))
          numbers.insert(numbers.end(), {n[0], n[1], n[2]});
      if (!(along_planes(sum, on_planes_[node], mesh_).norm() > 0))
        return constant(Vec3());
      return tape.add(PlacingRule::normal, arguments, numbers);
    });
  }

  TapeWriter::Slot
  OldSurface::write_tangent(const unsigned int curve, const std::size_t i, TapeWriter &tape) const
  {
    const Line       &line  = lines_[curve];
    const auto       &nodes = features_.curves[curve].nodes;
    const std::size_t last  = nodes.size() - 1;
    const auto        at    = [&](const std::size_t k) { return tape.node_at_start(nodes[k]); };
    const Vec3       &t     = line.tangents[i];
    return tape.once(1, curve, i, [&]() {
      if (0 < i && i < last)
        return tape.add(PlacingRule::middle_tangent, {at(i - 1), at(i), at(i + 1)});
      if (line.is_closed)
        return tape.add(PlacingRule::middle_tangent, {at(last - 1), at(0), at(1)});
      const bool on_plane =
        std::any_of(on_planes_[nodes[i]].begin(), on_planes_[nodes[i]].end(), [&](const unsigned int patch) {
          const Vec3 &n = mesh_.patches[patch].symmetry->normal;
          return t == n || t == -n;
        });
      if (on_plane)
        return tape.add(PlacingRule::constant, {}, {t[0], t[1], t[2]});
      if (last == 1)
        return tape.add(PlacingRule::chord, {at(0), at(1)});
      return i == 0 ? tape.add(PlacingRule::end_tangent, {at(0), at(1), write_tangent(curve, 1, tape)})
                    : tape.add(PlacingRule::end_tangent,
                               {at(last - 1), at(last), write_tangent(curve, last - 1, tape)});
    });
  }

  TapeWriter::Slot
  OldSurface::write_on_region(const unsigned int region, TapeWriter::Slot x, TapeWriter &tape) const
  {
    const Region &r     = regions_[region];
    const auto    hit   = r.tree.closest(tape.value(x));
    const auto   &nodes = mesh_.faces[r.faces[hit.triangle]].nodes;
    // The corners that count: of a face all, of an edge two, or one.
    std::vector<NodeIndex> corners;
    for (unsigned int i = 0; i < 3; ++i)
      if (hit.at.lambda[i] != 0.)
        corners.push_back(nodes[i]);
    std::vector<unsigned int> arguments = {x};
    for (const NodeIndex node : corners)
      arguments.push_back(tape.node_at_start(node));
    if (corners.size() == 1)
      x = arguments[1];
    else
    {
      for (const NodeIndex node : corners)
        arguments.push_back(write_normal(region, node, tape));
      x = tape.add(corners.size() == 3 ? PlacingRule::on_face : PlacingRule::on_face_edge, arguments);
    }
    return write_finish(x, r.planes, tape);
  }

  TapeWriter::Slot
  OldSurface::write_on_curve(const unsigned int curve, TapeWriter::Slot x, TapeWriter &tape) const
  {
    const Line     &line    = lines_[curve];
    const LinePoint closest = closest_on_line(line, tape.value(x));
    const auto     &nodes   = features_.curves[curve].nodes;
    const auto at = [&](const unsigned int end) { return tape.node_at_start(nodes[closest.segment + end]); };
    if (closest.t == 0. || closest.t == 1.)
      x = at(closest.t == 0. ? 0 : 1);
    else
    {
      const auto t_a = write_tangent(curve, closest.segment, tape),
                 t_b = write_tangent(curve, closest.segment + 1, tape);
      x              = tape.add(PlacingRule::on_ridge, {x, at(0), at(1), t_a, t_b});
    }
    return write_finish(x, line.planes, tape);
  }
} // namespace retroforge
