// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/output/scene_summary.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace retroforge
{
  namespace
  {
    using SceneJson = nlohmann::ordered_json; // which writes numbers that are not finite as null

    SceneJson in_json(const Vec3 &x)
    {
      return {x[0], x[1], x[2]};
    }

    SceneJson in_json(const SceneSummary::Corners &box)
    {
      return {in_json(box.first), in_json(box.second)};
    }

    SceneJson in_json(const SceneSummary::Die::Place &place)
    {
      return {{"distance", place.distance},
              {"place", std::isfinite(place.distance) ? in_json(place.place) : SceneJson()}};
    }

    SceneJson in_json(const SceneSummary::Billet &billet)
    {
      SceneJson patches = SceneJson::array(), planes = SceneJson::array();
      for (const auto &[name, area] : billet.patches)
        patches.push_back({{"name", name}, {"area", area}});
      for (const SceneSummary::SymmetryPlane &plane : billet.symmetry_planes)
        planes.push_back(
          {{"name", plane.name}, {"point", in_json(plane.point)}, {"normal", in_json(plane.normal)}});
      return {{"shape", billet.shape},
              {"extents", in_json(billet.extents)},
              {"nodes", billet.n_nodes},
              {"cells", billet.n_cells},
              {"element_size", billet.element_size},
              {"shortest_edge", billet.shortest_edge},
              {"longest_edge", billet.longest_edge},
              {"smallest_angle", billet.smallest_angle},
              {"volume", billet.volume},
              {"volume_of_shape", billet.volume_of_shape},
              {"whole", {{"copies", billet.whole.copies}, {"force_factor", billet.whole.force}}},
              {"patches", patches},
              {"symmetry_planes", planes}};
    }

    SceneJson in_json(const SceneSummary::Die &die)
    {
      SceneJson json = {{"name", die.name},
                        {"shape", die.shape},
                        {"facets", die.n_facets},
                        {"extents", die.extents ? in_json(*die.extents) : SceneJson()},
                        {"point", in_json(die.point)},
                        {"facing", in_json(die.facing)},
                        {"velocity", in_json(die.velocity)},
                        {"travel", in_json(die.travel)},
                        {"friction", die.friction},
                        {"leads", die.leads},
                        {"smallest_size", die.smallest_size},
                        {"gap", in_json(die.gap)},
                        {"covered", die.covered},
                        {"touches", die.touches},
                        {"mirrored_by", die.mirrored_by}};
      if (!die.friction_law.empty())
        json["friction_law"] = die.friction_law;
      if (die.shear_limit)
        json["shear_limit"] = *die.shear_limit;
      for (const SceneSummary::Die::Zone &zone : die.zones)
      {
        SceneJson of_zone = {
          {"name", zone.name}, {"friction_law", zone.friction_law}, {"friction", zone.friction}};
        if (zone.shear_limit)
          of_zone["shear_limit"] = *zone.shear_limit;
        json["zones"].push_back(of_zone);
      }
      if (die.touches)
        json["contact_area"] = die.contact_area;
      if (die.overlap)
      {
        json["overlap"]               = in_json(*die.overlap);
        json["overlap"]["of_the_die"] = die.is_of_die;
        json["overlap"]["frees"]      = in_json(die.frees);
      }
      if (die.velocity.norm() > 0.)
      {
        json["first_touch"]           = in_json(die.first_touch);
        json["first_touch"]["stroke"] = die.stroke_at_touch;
        json["moves_away"]            = die.moves_away;
      }
      return json;
    }

    /// To a few digits, where more say nothing.
    std::string rounded_text(const double x, const int digits)
    {
      std::ostringstream text;
      text << std::setprecision(digits) << x;
      return as_text(std::isfinite(x) ? std::stod(text.str()) : x);
    }

    /// A coordinate; zero where it is rounding beside `scale`.
    std::string coordinate(const double x, const double scale)
    {
      return as_text(std::abs(x) > 1e-9 * scale ? x : 0.);
    }

    std::string point(const Vec3 &x)
    {
      const double scale = x.norm();
      return "(" + coordinate(x[0], scale) + ", " + coordinate(x[1], scale) + ", " + coordinate(x[2], scale) +
             ")";
    }

    std::string range(const SceneSummary::Corners &box)
    {
      const double scale = box.first.norm() + box.second.norm();
      std::string  text;
      for (unsigned int i = 0; i < 3; ++i)
        text += std::string(i > 0 ? ", " : "") + "xyz"[i] + " " + coordinate(box.first[i], scale) + " to " +
                coordinate(box.second[i], scale);
      return text + " mm";
    }

    /// The part's first, which is what one knows.
    void list_volumes(std::ostream &out, const SceneSummary::Billet &billet)
    {
      const bool   has_measures = std::isfinite(billet.volume_of_shape);
      const double shape        = has_measures ? billet.volume_of_shape : billet.volume;
      if (!billet.whole.is_model() && !std::isnan(billet.whole.copies))
        out << "volume of the part " << as_text(billet.whole.copies * shape) << " mm^3; the model is 1/"
            << as_text(billet.whole.copies) << " of the part, " << as_text(shape) << " mm^3";
      else
        out << "volume " << as_text(shape) << " mm^3";
      if (has_measures)
      {
        out << "; its mesh has " << as_text(billet.volume) << " mm^3";
        const double percent = 100. * (billet.volume / shape - 1.);
        if (std::abs(percent) >= 0.005) // what chords of round sides lack
          out << " (" << as_text(std::round(100. * percent) / 100.) << " %)";
      }
      if (std::isnan(billet.whole.copies))
        out << "; the symmetry planes bound no whole part";
    }

    void list(std::ostream &out, const SceneSummary::Billet &billet)
    {
      out << "  billet, " << billet.shape << "\n    " << range(billet.extents) << "\n    " << billet.n_nodes
          << " nodes, " << billet.n_cells << " tetrahedra; edges of the surface from "
          << rounded_text(billet.shortest_edge, 3) << " to " << rounded_text(billet.longest_edge, 3)
          << " mm, wanted " << rounded_text(billet.element_size, 3) << " mm; smallest angle "
          << rounded_text(billet.smallest_angle, 3) << " degrees\n    ";
      list_volumes(out, billet);
      out << "\n    patches:";
      for (const auto &[name, area] : billet.patches)
        out << (name == billet.patches.front().first ? " " : ", ") << name << " (" << as_text(area)
            << " mm^2)";
      out << '\n';
      for (const SceneSummary::SymmetryPlane &plane : billet.symmetry_planes)
        out << "    symmetry plane `" << plane.name << "' through " << point(plane.point)
            << ", outward normal " << point(plane.normal) << '\n';
    }

    void list_place(std::ostream &out, const SceneSummary::Die &die)
    {
      if (die.overlap)
        out << "    OVERLAPS: " << (die.is_of_die ? "a point of it is " : "the billet is ")
            << as_text(die.overlap->distance) << " mm inside the " << (die.is_of_die ? "billet" : "die")
            << ", at " << point(die.overlap->place)
            << (die.frees.norm() > 0. ? "; free when the die moves by " + point(die.frees) + " mm" : "")
            << '\n';
      else if (die.touches)
        out << "    touches the billet at the start, at " << point(die.gap.place)
            << (die.contact_area > 0. ? ", on " + rounded_text(die.contact_area, 4) + " mm^2" : "") << '\n';
      else if (std::isfinite(die.gap.distance))
        out << "    stands " << as_text(die.gap.distance) << " mm away from the billet, nearest to "
            << point(die.gap.place) << '\n';
      else
        out << "    sees no part of the billet: all of it is beside the die, behind its rim\n";
    }

    /// @param with_billet  whether its place is known
    void list_path(std::ostream &out, const SceneSummary::Die &die, const bool with_billet)
    {
      if (die.velocity.norm() == 0.)
      {
        out << "    stands still\n";
        return;
      }
      out << "    moves at " << point(die.velocity) << " mm/s"
          << (die.leads ? ", and the stroke is measured on it" : "");
      if (with_billet && !die.touches && !die.overlap)
      {
        if (std::isfinite(die.first_touch.distance))
          out << "; touches the billet first at " << point(die.first_touch.place) << " after "
              << as_text(die.first_touch.distance) << " mm, at stroke " << as_text(die.stroke_at_touch)
              << " mm";
        else
          out << (die.moves_away ? "; moves away from the billet"
                                 : "; does not touch the billet, as that stands now, within the stroke");
      }
      if (die.extents)
        out << "; ends " << point(die.travel) << " mm from there\n";
      else
        out << "; ends through " << point(die.point + die.travel) << '\n';
    }

    /// "34 % of the billet's side that faces it"
    std::string covered_side(const SceneSummary::Die &die)
    {
      return rounded_text(100. * die.covered, 3) + " % of the billet's side that faces it";
    }

    void list(std::ostream &out, const SceneSummary::Die &die, const bool with_billet)
    {
      out << "  die " << die.name << ", " << die.shape << ", friction "
          << (die.friction_law.empty() ? "" : "after " + die.friction_law + ", ") << die.friction_name
          << " = " << as_text(die.friction);
      if (die.shear_limit)
        out << ", shear limit " << as_text(*die.shear_limit);
      out << '\n';
      for (const SceneSummary::Die::Zone &zone : die.zones)
      {
        out << "    zone " << zone.name << ", friction after " << zone.friction_law << ", "
            << zone.friction_name << " = " << as_text(zone.friction);
        if (zone.shear_limit)
          out << ", shear limit " << as_text(*zone.shear_limit);
        out << '\n';
      }
      if (die.extents)
        out << "    " << range(*die.extents) << ", " << die.n_facets << " facets\n";
      else
        out << "    through " << point(die.point) << ", facing " << point(die.facing) << '\n';
      for (const std::string &plane : die.mirrored_by)
        out << "    all of it on one side of plane `" << plane
            << "': the whole part has its mirror image, too, as another die\n";
      if (with_billet)
        list_place(out, die);
      if (die.covered > 0.) // else it stands beside, as a guide
        out << "    covers " << covered_side(die) << '\n';
      list_path(out, die, with_billet);
      if (std::isfinite(die.smallest_size))
        out << "    edges near it are wanted down to " << as_text(die.smallest_size) << " mm\n";
    }

    void list(std::ostream &out, const SceneSummary::Metal &metal)
    {
      out << "  metal, sigma = sqrt3^(m+1) K e^m with K = " << as_text(metal.consistency)
          << " MPa s^m, m = " << as_text(metal.rate_sensitivity) << '\n';
    }

    void list(std::ostream &out, const SceneSummary::Press &press)
    {
      out << "  press\n    stroke " << as_text(press.stroke) << " mm of die " << press.leading_die << ", "
          << as_text(press.seconds) << " s";
      if (press.increments > 0) // else they follow from the billet
        out << "; "
            << (press.is_free ? "increments chosen by the program, of at most "
                              : std::to_string(press.increments) + " increments of ")
            << as_text(press.stroke / press.increments) << " mm, "
            << as_text(press.seconds / press.increments) << " s each";
      out << '\n';
    }

    void list(std::ostream                         &out,
              const SceneSummary::Estimate         &estimate,
              const std::vector<SceneSummary::Die> &dies)
    {
      constexpr double narrow = 0.5; // else it is within the factor of two
      out << "  to expect, by the " << estimate.name << "\n    dies close at " << as_text(estimate.speed)
          << " mm/s, strain rate " << rounded_text(estimate.strain_rate, 3) << " /s, flow stress "
          << rounded_text(estimate.stress, 3) << " MPa\n    force on the whole part "
          << rounded_text(estimate.first_force, 3) << " N where the dies first press, "
          << rounded_text(estimate.final_force, 3)
          << " N after the stroke:\n    to a factor of two in open upsetting; metal that a bore or a cavity "
             "holds together, and flash, take three times as much and more\n";
      for (const SceneSummary::Die &die : dies)
        if (die.leads && die.covered < narrow)
          out << "    of dies that cover the billet: die " << die.name << " covers " << covered_side(die)
              << '\n';
    }
  } // namespace

  std::string SceneSummary::to_json() const
  {
    SceneJson json = {{"schema", schema},
                      {"command", "scene"},
                      {"version", version},
                      {"commit", commit},
                      {"case", case_file},
                      {"refusals", refusals},
                      {"warnings", warnings}};
    if (billet)
      json["billet"] = in_json(*billet);
    json["dies"] = SceneJson::array();
    for (const Die &die : dies)
      json["dies"].push_back(in_json(die));
    if (metal)
      json["metal"] = {{"consistency", metal->consistency}, {"rate_sensitivity", metal->rate_sensitivity}};
    if (press)
      json["press"] = {{"leading_die", press->leading_die},
                       {"stroke", press->stroke},
                       {"seconds", press->seconds},
                       {"increments", press->increments},
                       {"increments_chosen", press->is_free}};
    if (estimate)
      json["estimate"] = {{"name", estimate->name},
                          {"speed", estimate->speed},
                          {"strain_rate", estimate->strain_rate},
                          {"stress", estimate->stress},
                          {"first_force", estimate->first_force},
                          {"final_force", estimate->final_force}};
    json["wall_seconds"] = seconds;
    return json.dump(2, ' ', false, SceneJson::error_handler_t::replace) + "\n";
  }

  std::string SceneSummary::listing() const
  {
    std::ostringstream out;
    out << "Retroforge " << version << ' ' << commit << ", scene of " << case_file << '\n';
    for (const std::string &refusal : refusals)
      out << "  REFUSED: " << refusal << '\n';
    for (const std::string &warning : warnings)
      out << "  " << warning << '\n';
    if (billet)
      list(out, *billet);
    for (const Die &die : dies)
      list(out, die, billet.has_value());
    if (metal)
      list(out, *metal);
    if (press)
      list(out, *press);
    if (estimate)
      list(out, *estimate, dies);
    return out.str();
  }
} // namespace retroforge
