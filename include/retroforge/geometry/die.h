// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>
#include <retroforge/geometry/friction_zones.h>
#include <retroforge/geometry/smooth_projection.h>

#include <memory>
#include <optional>

namespace retroforge
{
  /// State of a die: the quantities that change with time or design. Everything else about it is geometry.
  template <typename Number>
  struct DieState
  {
    Vector3<Number> velocity;              ///< [mm/s]
    Vector3<Number> displacement;          ///< from the position at the start of the run [mm]
    Number          friction = Number(0.); ///< coefficient of its law of friction, in the law's unit
    /// Vertices of its surface, where a design has moved them or a derivative in them is wanted; empty: as
    /// made [mm].
    NodalVectors<Number> vertices = {};
    /// Number of the friction law that the coefficient belongs to (contact/interface_law.h); 0: Norton's.
    unsigned int interface_law = 0;
    unsigned int in_press      = 1; ///< whether it stands in the press: 0 or 1
    /// Part of the metal's shear flow stress that bounds friction, where its law has a bound of its own
    /// (InterfaceLaw::limit).
    Number shear_limit = Number(0.);
    Number temperature = Number(0.); ///< before it touches metal [C]
    /// Friction in the zones of the die (Die::zones).
    std::vector<ZoneFriction<Number>> zones;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[velocity,
             displacement,
             friction,
             vertices,
             interface_law,
             in_press,
             shear_limit,
             temperature,
             zones] = self;
      return std::tie(
        velocity, displacement, friction, vertices, interface_law, in_press, shear_limit, temperature, zones);
    }

    /// Friction outside of the zones.
    ZoneFriction<Number> own_friction() const { return {friction, shear_limit, interface_law}; }

    /// Whether any friction that is not 0, the die's own or that of a zone, fulfils a condition.
    template <typename Condition>
    bool any_friction(const Condition &condition) const
    {
      bool any = value_of(friction) != 0. && condition(own_friction());
      for (const ZoneFriction<Number> &zone : zones)
        any = any || (value_of(zone.friction) != 0. && condition(zone));
      return any;
    }

    /// Whether there is friction anywhere on it.
    bool rubs() const
    {
      return any_friction([](const ZoneFriction<Number> &) { return true; });
    }
  };

  /// The surface that the facets of a triangulated die stand for.
  struct DieSurfaceLaw
  {
    bool   smooth        = true; ///< they stand for a smooth surface; else they are the surface
    double feature_angle = 25.;  ///< edges where a smooth surface turns by more are sharp [degrees]
    /// Or where it would be farther from its facets than this part of their extent: a fold between large
    /// faces.
    double largest_sagitta = 3e-3;
  };

  /// A rigid die: a plane in closed form, or a triangulated surface whose normals point to the workpiece.
  ///
  /// A triangulated die stands for a smooth one (project_smoothly). On facets as they are the normal does not
  /// change with the point, the die's curvature is missing from every derivative, and gradients are off
  /// however fine the facets. A smooth die falls back to a facet's plane beyond its centre of curvature.
  ///
  /// Which feature a point sees is a decision (`closest`), the distance to it a formula (`project`): replays
  /// and derivatives pass the recorded feature.
  class Die
  {
  public:
    /// @param facing  normal of the working face, from the die towards the workpiece
    Die(std::string name, const Vec3 &point, const Vec3 &facing)
        : name(std::move(name)), point_(point), into_(-facing / facing.norm())
    {
    }

    /// @param depth  points deeper than this behind the surface are not in contact [mm]
    Die(std::string name, TriangleSurface surface, double depth, const DieSurfaceLaw &law = {});

    /// The closest feature seen from X, or none: none of it within `reach`, or X deeper inside than `depth`,
    /// or behind the rim of an open surface. A plane is always found.
    DieFeature
    closest(const Vec3 &X, const Vec3 &displacement, double reach = std::numeric_limits<double>::max()) const;

    /// Returns the signed distance, however far or deep [mm]; infinite behind the rim of an open surface.
    double signed_distance(const Vec3 &X, const Vec3 &displacement) const;

    /// Returns the signed distance to the facets as they are, whatever surface they stand for [mm].
    double facet_distance(const Vec3 &X, const Vec3 &displacement) const;

    /// Returns the depth of X inside the die [mm]; 0 outside, and where it is deeper than `within`.
    double depth_of(const Vec3 &X, const Vec3 &displacement, double within) const;

    /// Signed distance and normal of a feature seen from X. Of a plane:  delta = n·(point + displacement -
    /// X).
    template <typename Number>
    Projection<Number>
    project(const Vector3<Number> &X, const Vector3<Number> &displacement, const DieFeature &feature) const
    {
      Assert(feature.found(), dealii::ExcMessage("a point is projected on a feature that was found"));
      if (surface_)
        return project_on_surface<Number, double>(nullptr, feature, X, displacement);
      Projection<Number> projection;
      projection.delta = Number(0.);
      for (unsigned int i = 0; i < 3; ++i)
      {
        projection.n[i] = Number(into_[i]);
        projection.delta += into_[i] * (point_[i] + displacement[i] - X[i]);
      }
      return projection;
    }

    /// Projects onto the die in a given state, its vertices included.
    template <typename Number>
    Projection<Number>
    project(const Vector3<Number> &X, const DieState<Number> &state, const DieFeature &feature) const
    {
      if (state.vertices.empty())
        return project(X, state.displacement, feature);
      Assert(surface_ && state.vertices.size() == surface_->shape.vertices().size(),
             dealii::ExcMessage("a state has all vertices of its die, or none"));
      Assert(feature.found(), dealii::ExcMessage("a point is projected on a feature that was found"));
      return project_on_surface(&state.vertices, feature, X, state.displacement);
    }

    /// Returns the die with its surface's vertices elsewhere [mm].
    Die moved(NodalVectors<double> vertices) const;

    /// Adds the pull-back of project to X_bar and displacement_bar, and to vertices_bar if given. The normal
    /// of a plane depends on neither.
    void reverse_project(const Vec3           &X,
                         const Vec3           &displacement,
                         const DieFeature     &feature,
                         double                delta_bar,
                         const Vec3           &n_bar,
                         Vec3                 &X_bar,
                         Vec3                 &displacement_bar,
                         NodalVectors<double> *vertices_bar = nullptr) const;

    /// Edges where its surface turns by more are sharp [degrees].
    double feature_angle() const { return surface_ ? surface_->feature_angle : 0.; }

    /// Null for a plane.
    const TriangleSurface *surface() const { return surface_ ? &surface_->shape : nullptr; }

    /// Number of facets; 1 for a plane.
    unsigned int n_facets() const { return surface_ ? surface_->shape.n_facets() : 1; }

    std::string   name;
    FrictionZones zones; ///< where friction is another than its own

  private:
    struct Surface
    {
      TriangleSurface              shape;
      ClosestFeature               closest;
      double                       depth, feature_angle;
      std::optional<CornerNormals> normals; ///< normals of a smooth surface

      Surface(TriangleSurface              made,
              const double                 depth,
              const double                 feature_angle,
              std::optional<CornerNormals> normals)
          : shape(std::move(made))
          , closest(shape)
          , depth(depth)
          , feature_angle(feature_angle)
          , normals(std::move(normals))
      {
      }
    };

    template <typename Number, typename VertexNumber>
    Projection<Number> project_on_surface(const NodalVectors<VertexNumber> *vertices,
                                          const DieFeature                 &feature,
                                          const Vector3<Number>            &X,
                                          const Vector3<Number>            &displacement) const
    {
      const TriangleSurface &shape = surface_->shape;
      if (surface_->normals)
        return project_smoothly(shape, *surface_->normals, vertices, feature, X, displacement);
      return vertices ? project_on_feature(shape, *vertices, feature, X, displacement)
                      : project_on_feature(shape, shape.vertices(), feature, X, displacement);
    }

    /// Whatever the distance, but for what is farther away than `within`.
    DieFeature closest_on_surface(const Vec3 &x, double within) const;

    Vec3                           point_;
    Vec3                           into_; ///< unit normal into the die
    std::shared_ptr<const Surface> surface_;
  };
} // namespace retroforge
