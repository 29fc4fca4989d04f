// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/scene_checks.h>
#include <retroforge/case/scene_estimate.h>
#include <retroforge/contact/die_approach.h>
#include <retroforge/core/text.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/whole_part.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    /// What metals are forged at, with a decade to spare on either side: of soft lead or a model material at
    /// creep, and of cold steel under a hammer.
    constexpr double least_stress = 1e-2, largest_stress = 5e3;
    constexpr double least_rate = 1e-2, largest_rate = 3e3, largest_speed = 2e4;
    constexpr double least_extent = 1., largest_extent = 1e4;

    /// Times the traction that shears the metal. A sticking die has 1; some users set a few for that.
    constexpr double largest_friction = 3.;

    /// Extents of an STL die or one by measures over that of a cube of the whole part's volume. A die as
    /// large as this in a file in inches has 0.04, one of two and a half times its size 0.1.
    constexpr double small_die = 0.1, large_die = 20.;

    /// Over the height of the billet.
    constexpr double least_path = 1e-3, largest_step = 0.1;

    /// Regularising strain rate over that of the scene: the stress is 4 % off where m is small.
    constexpr double largest_regularisation = 0.3;

    /// What a scene looks like as a whole.
    struct View
    {
      const Parameters           &parameters;
      const Scene                &scene;
      const Process<double>      &process;
      const NodalVectors<double> &X;
      Vec3                        low, high;   ///< corners of the billet's box
      Vec3                        way;         ///< unit vector in which the leading die faces the billet
      double                      speed  = 0.; ///< at which the dies close along it [mm/s]
      double                      path   = 0.; ///< by which they do so over the stroke [mm]
      double                      gaps   = 0.; ///< between dies and billet along it, on both sides [mm]
      double                      volume = 0.; ///< of the model [mm^3]

      double extent() const { return (high - low).norm(); }
      /// By which the billet gets shorter.
      double               closing() const { return std::max(0., path - gaps); }
      const Die           &leading() const { return scene.dies[process.operations.front().leading_die]; }
      std::string          name(const unsigned int d) const { return "Die " + scene.dies[d].name; }
      const DieParameters &given(const unsigned int d) const { return parameters.dies[d]; }
    };

    /// What a die faces: as it is told or, of a file, by its facets, and then roughly.
    Vec3 facing(const View &view, const unsigned int d)
    {
      return view.given(d).shape.name == "stl" ? mean_normal(*view.scene.dies[d].surface())
                                               : view.given(d).facing;
    }

    /// Whether a die moves at less than 45 degrees to what it faces; a die that looks to all sides does.
    bool moves_as_it_faces(const Vec3 &velocity, const Vec3 &facing)
    {
      return !(facing.norm() > 0.5 && velocity * facing < std::sqrt(0.5) * velocity.norm() * facing.norm());
    }

    /// The direction in which the leading die presses: what it faces; or the way it moves, where its facets
    /// tell only roughly what it faces, and where it presses with a side.
    Vec3 pressing_direction(const View &view)
    {
      constexpr double   least    = 1e-2; // cosine of the angle between the two
      const unsigned int lead     = view.process.operations.front().leading_die;
      const Vec3        &velocity = view.process.dies[lead].velocity;
      const Vec3         normal   = facing(view, lead);
      const bool is_rough = view.given(lead).shape.name == "stl" && moves_as_it_faces(velocity, normal);
      return is_rough || velocity * normal < least * velocity.norm() * normal.norm()
               ? velocity / velocity.norm()
               : normal / normal.norm();
    }

    /// As closing_speed(), of the velocities' parts along a unit vector.
    double closing_speed_along(const std::vector<DieState<double>> &dies, const Vec3 &way)
    {
      double speed = 0.;
      for (std::size_t a = 0; a < dies.size(); ++a)
      {
        speed = std::max(speed, std::abs(dies[a].velocity * way));
        for (std::size_t b = 0; b < a; ++b)
          speed = std::max(speed, std::abs((dies[a].velocity - dies[b].velocity) * way));
      }
      return speed;
    }

    /// Whether a plane of symmetry across the way stands for the other die.
    bool is_halved(const View &view)
    {
      const auto &patches = view.scene.mesh.patches;
      return std::any_of(patches.begin(), patches.end(), [&](const Patch &patch) {
        return patch.symmetry && std::abs(patch.symmetry->normal * view.way) > 1. - 1e-6;
      });
    }

    /// The ways that the leading die and the nearest of those against it have to the billet.
    double gaps_of(const View &view)
    {
      const MetalSurface metal    = metal_surface(view.scene.mesh, view.X);
      const double       touching = touching_distance(view.scene.mesh, view.X);
      const auto         gap      = [&](const unsigned int d, const Vec3 &way) {
        const auto met =
          first_meeting(view.scene.dies[d], view.process.dies[d].displacement, way, metal, touching);
        return met ? met->travel : std::numeric_limits<double>::max();
      };
      double against = std::numeric_limits<double>::max();
      for (const unsigned int d : view.process.operations.front().dies)
        if (d != view.process.operations.front().leading_die)
          against = std::min(against, gap(d, -view.way));
      const double ahead = gap(view.process.operations.front().leading_die, view.way);
      return (ahead < std::numeric_limits<double>::max() ? ahead : 0.) +
             (is_halved(view) || against == std::numeric_limits<double>::max() ? 0. : against);
    }

    View view_of(const Parameters           &parameters,
                 const Scene                &scene,
                 const Process<double>      &process,
                 const NodalVectors<double> &X)
    {
      View view{parameters, scene, process, X, {}, {}, {}};
      std::tie(view.low, view.high) = bounding_box(X);
      view.way                      = pressing_direction(view);
      view.speed                    = closing_speed_along(process.dies, view.way);
      view.path                     = process.nominal_time(parameters.press.stroke) * view.speed;
      view.volume                   = volume(scene.mesh.cells, X);
      view.gaps                     = gaps_of(view);
      return view;
    }

    double height_along(const NodalVectors<double> &X, const Vec3 &way)
    {
      const auto [low, high] = std::minmax_element(
        X.begin(), X.end(), [&](const Vec3 &a, const Vec3 &b) { return a * way < b * way; });
      return (*high - *low) * way;
    }

    /// Equivalent stress at an equivalent strain rate.
    double flow_stress(const MaterialLaw<double> &law, const double rate)
    {
      return law(1.5 * rate * rate) * 1.5 * rate;
    }

    /// Traction of friction at the rim of a disc that is upset, which sticking does not bound yet.
    double rim_friction(const DieState<double>    &die,
                        const MaterialLaw<double> &law,
                        const double               rate,
                        const double               radius)
    {
      return friction_traction(die.own_friction(), {0.5 * rate * radius, flow_stress(law, rate), rate}, law);
    }

    double or_one(const double copies)
    {
      return std::isfinite(copies) ? copies : 1.;
    }

    /// Radius of the disc of the whole part.
    double radius_of(const View &view, const double height)
    {
      const double copies = or_one(whole_part(view.scene.mesh, view.way).force);
      return std::sqrt(copies * view.volume / height / dealii::numbers::PI);
    }

    /// Diagonal of the cube that has the volume of the whole part, whatever its shape and its planes.
    double size_of_whole(const View &view)
    {
      const double copies = or_one(whole_part(view.scene.mesh, view.way).copies);
      return std::sqrt(3.) * std::cbrt(copies * view.volume);
    }

    double slab_force(const View &view, const double height)
    {
      const Process<double> &process = view.process;
      const double           rate = view.speed / height, radius = radius_of(view, height),
                   stress = flow_stress(process.material.initial_law(), rate), most = stress / std::sqrt(3.);
      const auto tau = [&](const DieState<double> &die) {
        return std::min(most, rim_friction(die, process.material.initial_law(), rate, radius));
      };
      double other = 0.;
      if (!is_halved(view))
        for (const unsigned int d : process.operations.front().dies)
          if (d != process.operations.front().leading_die)
            other = std::max(other, tau(process.dies[d]));
      const double friction = (tau(process.dies[process.operations.front().leading_die]) + other) * radius /
                              ((process.material.initial_law().m + 3.) * height);
      return dealii::numbers::PI * radius * radius * (stress + friction);
    }

    using Warnings = std::vector<std::string>;

    void warn_of_sizes(const View &view, Warnings &warnings)
    {
      const BilletParameters &billet = view.parameters.billet;
      if (const double extent = view.extent(); !(extent >= least_extent && extent <= largest_extent))
        warnings.push_back((billet.is_from_file() ? "Billet/scale" : "Billet") +
                           std::string(": the billet's extent is ") + as_text(extent) +
                           " mm; lengths are in mm: is it in metres?");
      const Vec3   size     = view.high - view.low;
      const double smallest = std::min({size[0], size[1], size[2]});
      const auto   coarse   = [&](const std::string &setting, const double element_size) {
        if (element_size > 1.01 * smallest)
          warnings.push_back(
            setting + " = " + as_text(element_size) + ": the billet is " + as_text(smallest) +
            " mm across where it is thinnest, less than an element; several are wanted there");
      };
      if (!billet.is_from_file())
        coarse("Billet/element size", billet.element_size);
      if (view.parameters.remeshing.enabled())
        coarse("Remeshing/element size", view.parameters.remeshing.element_size);
      for (unsigned int d = 0; d < view.scene.dies.size(); ++d)
        if (const TriangleSurface *surface = view.scene.dies[d].surface())
          if (const double size = size_of_whole(view), ratio = surface->diagonal() / size;
              !(ratio >= small_die && ratio <= large_die))
          {
            const std::string &shape   = view.given(d).shape.name;
            const bool         of_file = shape == "stl";
            warnings.push_back(
              view.name(d) + (of_file ? "/scale" : "/shape = " + shape) + ": the die's extent is " +
              as_text(surface->diagonal()) + " mm, that of a cube of the whole part's volume " +
              as_text(size) + " mm; " +
              (of_file ? "a file in inches wants scale = 25.4, in metres 1000" : "its measures are in mm"));
          }
    }

    void warn_of_press(const View &view, const SceneEstimate &estimate, Warnings &warnings)
    {
      const Parameters &given = view.parameters;
      if (estimate.speed > largest_speed || estimate.strain_rate < least_rate ||
          estimate.strain_rate > largest_rate)
        warnings.push_back(view.name(view.process.operations.front().leading_die) +
                           "/velocity: the dies close at " + as_text(estimate.speed) +
                           " mm/s, which strains the billet at " + as_text(estimate.strain_rate) +
                           " /s; forging has 0.01 to 3000 /s, and velocities are in mm/s: 0.2 m/s are 200");
      if (view.closing() < least_path * estimate.height)
        warnings.push_back("Press/stroke = " + as_text(given.press.stroke) + ": the dies close by " +
                           as_text(view.closing()) + " mm on a billet of " + as_text(estimate.height) +
                           " mm; the stroke is in mm");
      else if (const double step = view.path / given.press.increments; step > largest_step * estimate.height)
        warnings.push_back("Press/increments = " + std::to_string(given.press.increments) + ": each takes " +
                           as_text(100. * step / estimate.height) +
                           " % of the billet's height; 0 takes as many as are wanted");
    }

    /// Of a table of flow stresses.
    void warn_of_table(const FlowTable &table, const double temperature, Warnings &warnings)
    {
      constexpr double much = 0.02;
      if (table.misfit() > much)
        warnings.push_back(
          "Material/table: the power laws of the strain rate that are fitted to it miss stresses by up "
          "to " +
          as_text(100. * table.misfit()) +
          " %; give the rates of the scene only, two of them are met exactly");
      if (temperature < table.least_temperature() || temperature > table.largest_temperature())
        warnings.push_back("Material/temperature = " + as_text(temperature) + ": the table is from " +
                           as_text(table.least_temperature()) + " to " +
                           as_text(table.largest_temperature()) +
                           " C, beyond which stresses are those at its edge");
    }

    void warn_of_material(const View &view, const SceneEstimate &estimate, Warnings &warnings)
    {
      constexpr double          melting = 1400.; // of steel, about [C]
      const Material<double>   &metal   = view.process.material;
      const MaterialLaw<double> law     = metal.initial_law();
      if (const double T = metal.initial.temperature; T > melting)
        warnings.push_back(
          "Material/temperature = " + as_text(T) +
          ": temperatures are in C, and steel melts near 1450: is it in K? Then subtract 273.15");
      if (metal.table)
        warn_of_table(*metal.table, metal.initial.temperature, warnings);
      const MaterialParameters &given = view.parameters.material;
      if (const double T = metal.initial.temperature; is_beyond(given.valid_temperatures, T))
        warnings.push_back("Material/temperature = " + as_text(T) + ": the law's numbers hold from " +
                           as_text(given.valid_temperatures[0]) + " to " +
                           as_text(given.valid_temperatures[1]) + " C (Material/valid temperatures)");
      if (is_beyond(given.valid_rates, estimate.strain_rate))
        warnings.push_back(view.name(view.process.operations.front().leading_die) +
                           "/velocity: the billet is strained at " + as_text(estimate.strain_rate) +
                           " /s, and the law's numbers hold from " + as_text(given.valid_rates[0]) + " to " +
                           as_text(given.valid_rates[1]) + " /s (Material/valid strain rates)");
      if (!(estimate.flow_stress >= least_stress && estimate.flow_stress <= largest_stress))
        warnings.push_back(
          (material_type(metal.type).reads_consistency() ? "Material/consistency = " + as_text(metal.law.K)
                                                         : "Material/law") +
          ": the flow stress is " + as_text(estimate.flow_stress) + " MPa at " +
          as_text(estimate.strain_rate) + " /s, the press force about " + as_text(estimate.first_force) +
          " N; stresses are in MPa, the consistency in MPa s^m: divide those in Pa by 1e6");
      if (!law.is_linear() && law.e0 > largest_regularisation * estimate.strain_rate)
        warnings.push_back(
          "Material/regularising strain rate = " + as_text(law.e0) + ": the scene's strain rate is " +
          as_text(estimate.strain_rate) +
          " /s, where the metal would flow at a lower stress than the law's; 0 chooses a rate "
          "that does not matter");
    }

    /// Numbers in units other than asked for, by powers of ten beyond those of any metal.
    void warn_of_heat(const HeatLaw<double> &heat, Warnings &warnings)
    {
      struct Usual
      {
        const char *name, *unit, *of_metals;
        double      value, least, largest;
      };
      const auto warn = [&](const Usual &of) {
        if (of.value != 0. && !(of.value >= of.least && of.value <= of.largest))
          warnings.push_back("Heat/" + std::string(of.name) + " = " + as_text(of.value) + ": " +
                             of.of_metals + ", in " + of.unit);
      };
      if (!heat.warms())
        return;
      warn({"heat capacity",
            "MPa/K, which is MJ/(m^3 K): divide J/(m^3 K) by 1e6",
            "metals have 1 to 10",
            heat.capacity,
            0.3,
            30.});
      if (!heat.conducts())
        return;
      warn({"conductivity", "W/(m K)", "metals have 5 to 430", heat.conductivity, 1., 2000.});
      for (const auto &[name, film] :
           {std::make_pair("contact film", heat.contact_film), std::make_pair("dwell film", heat.dwell_film)})
        warn({name, "kW/(m^2 K): divide W/(m^2 K) by 1000", "contacts have 0.1 to 100", film, 1e-3, 500.});
      warn({"air film",
            "kW/(m^2 K): divide W/(m^2 K) by 1000",
            "still air has 0.01, a water jet 10",
            heat.air_film,
            1e-4,
            100.});
      warn({"die effusivity",
            "kW s^(1/2)/(m^2 K): divide W s^(1/2)/(m^2 K) by 1000",
            "metals have 2 to 40",
            heat.die_effusivity,
            0.1,
            1e3});
    }

    void warn_of_friction(const View &view, const SceneEstimate &estimate, Warnings &warnings)
    {
      const double radius = radius_of(view, estimate.height), shear = estimate.flow_stress / std::sqrt(3.);
      for (unsigned int d = 0; d < view.scene.dies.size(); ++d)
        if (const double part =
              rim_friction(
                view.process.dies[d], view.process.material.initial_law(), estimate.strain_rate, radius) /
              shear;
            part > largest_friction)
          warnings.push_back(
            view.name(d) + "/friction = " + as_text(view.process.dies[d].friction) + ": its traction is " +
            as_text(part) +
            " times the stress that shears the metal, and 1 sticks; it is no percentage, and 0.1 "
            "to 1 is usual");
    }

    void warn_of_ways(const View &view, Warnings &warnings)
    {
      for (unsigned int d = 0; d < view.scene.dies.size(); ++d)
      {
        const Vec3  &velocity = view.process.dies[d].velocity;
        const Vec3   normal   = facing(view, d);
        const double along    = velocity * normal;
        if (!moves_as_it_faces(velocity, normal))
          warnings.push_back(view.name(d) + "/velocity: the die moves at " +
                             as_text(std::acos(std::max(-1., along / (velocity.norm() * normal.norm()))) *
                                     180. / dealii::numbers::PI) +
                             " degrees to the direction it faces: it shears the billet, or leaves it");
      }
    }

    /// How a die stands to a plane of symmetry, and how far a surface and its mirror image are apart at the
    /// billet. Of a die on the model's side only, the image is another die.
    struct Asymmetry
    {
      bool   is_inside = false, is_outside = false; ///< whether there is a part of it on either side
      double distance = 0.;
      Vec3   place;
    };

    Asymmetry asymmetry(const View &view, const unsigned int d, const Plane &plane)
    {
      const Die             &die     = view.scene.dies[d];
      const TriangleSurface *surface = die.surface();
      if (!surface)
      {
        const bool spans = std::abs(view.given(d).facing * plane.normal) < 1e-6;
        return {spans, spans, 0., {}};
      }
      constexpr std::size_t most_samples = 5000;
      const Vec3           &displacement = view.process.dies[d].displacement;
      const double          size = view.extent(), near = 1e-2 * size;
      const Vec3            middle = (view.low + view.high) / 2.;
      const auto           &x      = surface->vertices();
      const std::size_t     stride = x.size() / most_samples + 1;
      Asymmetry             found;
      for (std::size_t v = 0; v < x.size(); v += stride)
      {
        const Vec3   at     = x[v] + displacement;
        const double beyond = (at - plane.point) * plane.normal;
        found.is_inside |= beyond < -near;
        found.is_outside |= beyond > near;
        const Vec3 image = at - 2. * beyond * plane.normal, from = image - middle;
        if (!(beyond > near) || (from - (from * view.way) * view.way).norm() > 0.5 * size)
          continue;
        if (const double distance = std::abs(die.signed_distance(image, displacement));
            distance > found.distance)
        {
          found.distance = distance;
          found.place    = at;
        }
      }
      return found;
    }

    void warn_of_symmetry(const View &view, Warnings &warnings)
    {
      const std::vector<Plane> planes = symmetry_planes(view.scene.mesh);
      for (unsigned int d = 0; d < view.scene.dies.size(); ++d)
        for (const Plane &plane : planes)
        {
          const Vec3       &velocity = view.process.dies[d].velocity;
          const Asymmetry   found    = asymmetry(view, d, plane);
          const auto       &n        = plane.normal;
          const std::string where =
            "the symmetry plane of normal " + as_text(n[0]) + ", " + as_text(n[1]) + ", " + as_text(n[2]);
          if (!found.is_outside)
            continue;
          if (!found.is_inside)
            warnings.push_back(view.name(d) + "/point: the die stands beyond " + where +
                               " alone, where there is no metal: its mirror image, which would press, is no "
                               "part of the model; move the die");
          else if (std::abs(velocity * n) > 1e-6 * velocity.norm())
            warnings.push_back(view.name(d) + "/velocity: the die lies across " + where +
                               " and moves through it: whole part and model differ");
          else if (found.distance > 2e-2 * view.extent())
            warnings.push_back(
              view.name(d) + "/point: the die is not its own mirror image in " + where + ": at (" +
              as_text(found.place[0]) + ", " + as_text(found.place[1]) + ", " + as_text(found.place[2]) +
              ") they are " +
              (std::isfinite(found.distance) ? as_text(found.distance) + " mm apart"
                                             : "without a counterpart") +
              ", so the whole part is not what is told; move the die, or leave the plane out");
        }
    }
  } // namespace

  SceneEstimate estimate_scene(const Parameters           &parameters,
                               const Scene                &scene,
                               const Process<double>      &process,
                               const NodalVectors<double> &X)
  {
    constexpr double thinnest = 0.1; // of the height: dies of a cavity meet where flat ones would not
    const View       view     = view_of(parameters, scene, process, X);
    SceneEstimate    estimate;
    estimate.speed       = view.speed;
    estimate.height      = height_along(X, view.way);
    estimate.strain_rate = estimate.speed / estimate.height;
    estimate.flow_stress = flow_stress(process.material.initial_law(), estimate.strain_rate);
    estimate.first_force = slab_force(view, estimate.height);
    estimate.final_force =
      slab_force(view, std::max(thinnest * estimate.height, estimate.height - view.closing()));
    warn_of_sizes(view, estimate.warnings);
    warn_of_material(view, estimate, estimate.warnings);
    warn_of_heat(view.process.heat, estimate.warnings);
    warn_of_press(view, estimate, estimate.warnings);
    warn_of_friction(view, estimate, estimate.warnings);
    warn_of_ways(view, estimate.warnings);
    warn_of_symmetry(view, estimate.warnings);
    return estimate;
  }

  SceneEstimate estimate_scene(const Case &forging_case)
  {
    const Scene scene(
      forging_case.billet, forging_case.model.discretization, forging_case.model.dies, forging_case.comm);
    return estimate_scene(forging_case.parameters, scene, forging_case.process, forging_case.X_0);
  }
} // namespace retroforge
