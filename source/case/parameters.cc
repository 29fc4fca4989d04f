// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/parameters.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/parameter_input.h>
#include <retroforge/core/parameter_list.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/time/closing_speed.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <limits>
#include <sstream>
#include <tuple>

namespace retroforge
{
  using namespace dealii::Patterns;

  namespace
  {
    /// Below it the friction of a sticking node is infinitely stiff, in the dies' closing speed.
    constexpr double least_slip = 1e-20;
  } // namespace

  void ContactParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Contact");
    prm.add_parameter(
      "law",
      law,
      "smooth: friction sets in over a ramp of the gap, the objective is differentiable as nodes arrive. "
      "sharp: friction acts where the gap is below the ramp's width, decided once per increment. "
      "Units: none.",
      Selection("smooth|sharp"));
    prm.add_parameter(
      "points",
      points,
      "Where dies that are no planes are felt: nodes and edges adds the middles of edges that the die bulges "
      "into, which nodes alone let into it. Units: none.",
      Selection("nodes|nodes and edges"));
    prm.add_parameter(
      "largest depth",
      largest_depth,
      "The run says so at its end when a point of the surface was deeper in a die than this part of the "
      "element size. Units: none.",
      Double(0.));
    prm.add_parameter(
      "edge sinking",
      edge_sinking,
      "Part of the dies' closing speed at which an edge sinks into a die under the mean pressure: the "
      "penalty of edges, softer than the nodes'. Units: none.",
      Double(1e-14, 1.));
    prm.add_parameter(
      "approach",
      approach,
      "Approach time in increments: a gap closes within this many. 1 closes it in one, larger values "
      "smooth the objective and bias the energy. Units: none.",
      Double(1., 100.));
    prm.add_parameter(
      "layer",
      layer,
      "Bends the speed at which a gap may close, so that the force on an arriving node sets in gradually: "
      "smooths the objective at less bias than `approach' does. 0.5 is moderate, 0.3 strong, 0.1 the least; "
      "0, or the sharp law, for none. In units of approach times the path by which the dies close in an "
      "increment: its stroke, where one die moves. Units: none.",
      Double(0.));
    prm.add_parameter(
      "ramp width",
      ramp_width,
      "Gap over which friction sets in, in units of approach times the path by which the dies close in an "
      "increment: its stroke, where one die moves. Units: none.",
      Double(1e-6, 100.));
    prm.add_parameter(
      "penetration",
      penetration,
      "Part of the dies' closing speed at which a node sinks into a die under the mean pressure: sets the "
      "penalty. Units: none.",
      Double(1e-14, 1.));
    prm.add_parameter(
      "penalty",
      penalty,
      "rho, which is then the same in every design; 0 takes it from `penetration`, the material, the speed "
      "at which the dies close and the height of the billet, and gradients by the first three know it. "
      "Units: "
      "MPa s/mm.",
      Double(0.));
    prm.add_parameter(
      "slip regularisation",
      slip_fraction,
      "v0 in |dv|^2 -> |dv|^2 + v0^2, as a part of the speed at which the dies close, that of the moving die "
      "where there is one. Part of the model. Units: none.",
      Double(0.));
    prm.leave_subsection();
  }

  void ContactParameters::check() const
  {
    constexpr double least = 0.1;
    if (law == "smooth" && layer > 0. && layer < least)
      throw Error("Contact/layer",
                  "is " + as_text(layer) + ", with which a die is felt over thousands of increments' strokes",
                  "it is 0, or " + as_text(least) + " at least",
                  "use 0.3 for a strong layer, 0 for none");
  }

  void AdjointParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Adjoint");
    prm.add_parameter("method",
                      method,
                      "How `gradient` differentiates: adjoint, one backward sweep for all parameters and "
                      "every node; or direct, "
                      "one forward sweep per parameter for all objectives, without the nodes. Units: none.",
                      Selection("adjoint|direct"));
    prm.add_parameter("tolerance",
                      tolerance,
                      "Relative tolerance of the adjoint and tangent linear systems. Units: none.",
                      Double(1e-14, 1e-2));
    prm.add_parameter(
      "derivatives",
      derivatives,
      "How residual and dissipation are differentiated in the positions of the nodes: exact, or by "
      "differences inside the elements (semi-analytic), to compare with. Units: none.",
      Selection("exact|semi-analytic|semi-analytic central"));
    prm.add_parameter(
      "perturbation",
      perturbation,
      "Step of the semi-analytic derivatives, relative to the size of the element. Units: none.",
      Double(1e-15, 1e-1));
    prm.leave_subsection();
  }

  ShapeDerivatives AdjointParameters::shape_derivatives() const
  {
    using Method = ShapeDerivatives::Method;
    return {derivatives == "exact"           ? Method::exact
            : derivatives == "semi-analytic" ? Method::forward
                                             : Method::central,
            perturbation};
  }

  namespace
  {
    /// Increments between pictures; nothing for `auto'.
    std::optional<unsigned int> pictures_in(const std::string &text)
    {
      if (text == "auto")
        return {};
      try
      {
        return Tools::Convert<unsigned int>::to_value(text, Integer(0));
      }
      catch (const dealii::ExceptionBase &)
      {
        throw Error("Output/fields every",
                    "is '" + legible(text) + "'",
                    "it is `auto' or a number of increments",
                    "write auto for some 20 pictures over the stroke, 1 for every increment, 0 for none");
      }
    }
  } // namespace

  void OutputParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Output");
    prm.declare_entry(
      "fields every",
      "auto",
      Anything(),
      "When the fields for viewing are written: auto, at most 20 times, evenly over the stroke; or every so "
      "many increments, 0 for never. The billet, the end of the stroke, and the workpiece where a run failed "
      "come along. Units: none.");
    prm.add_action("fields every", [this](const std::string &text) { every = pictures_in(text); });
    prm.add_parameter(
      "record", record, "Keep the record that a later gradient or replay needs. Units: none.");
    prm.leave_subsection();
  }

  namespace
  {
    /// `NAME: VALUE, NAME: VALUE; NAME: VALUE'.
    std::vector<std::multimap<std::string, double>> designs_in(const std::string &text)
    {
      using Values = std::multimap<std::string, double>;
      std::vector<Values> designs;
      try
      {
        for (const std::string &design : dealii::Utilities::split_string_list(text, ';'))
          designs.push_back(Tools::Convert<Values>::to_value(design));
      }
      catch (const dealii::ExceptionBase &)
      {
        throw Error("Design/meshed at",
                    "is '" + legible(text) + "'",
                    "it holds `NAME: VALUE, NAME: VALUE', and semicolons between designs",
                    "correct it, or leave it empty for a mesh at the nominal values");
      }
      return designs;
    }
  } // namespace

  void DesignParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Design");
    prm.add_parameter(
      "parameters",
      names,
      "Parameters whose gradient is wanted: material/K, material/m, material/e0, contact/rho, contact/v0, "
      "dies/friction, `die NAME/friction`, `die NAME/speed`, `die NAME/offset`, and of the billet's "
      "shape: of a box billet/stretch, billet/height, of a cylinder billet/radius, billet/height, of a ring "
      "billet/mu1 to billet/mu4, of a profile `billet/control point I r', `billet/control point I z'; modes "
      "of free forms are `billet/free form I' and `die NAME/free form I'. "
      "The gradient by every node of the billet is always computed, too. Units: none.");
    prm.add_parameter(
      "at",
      at,
      "Design parameters and values they have instead of the nominal ones, `NAME: VALUE, NAME: VALUE'; any "
      "that "
      "the scene offers. The mesh stays that of the nominal design, its nodes moved, and so do increments "
      "and sizes that follow from the nominal billet; the penalty and the regularisation of slip follow the "
      "material and the speed at which the dies close. Their gradients are computed, too. Units: those of "
      "the "
      "parameters.");
    prm.declare_entry(
      "meshed at",
      "",
      Anything(),
      "Parameters of the billet's shape and values at which the billet is meshed instead of at the nominal "
      "ones, `NAME: VALUE, NAME: VALUE': for designs that the nominal mesh cannot follow. A billet with "
      "measures is meshed with these; one from a file or with a free form is remeshed there, with edges as "
      "long as they were, and by designs in between where several stand one after the other, separated by "
      "semicolons. Values of design parameters mean what they meant. Units: those of the parameters.");
    prm.add_action("meshed at", [this](const std::string &text) { meshed_at = designs_in(text); });
    prm.leave_subsection();
  }

  std::vector<std::string> DesignParameters::all_names() const
  {
    std::vector<std::string> all = names;
    for (const auto &[name, value] : at)
      if (std::find(all.begin(), all.end(), name) == all.end())
        all.push_back(name);
    return all;
  }

  void ObjectivesParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Objectives");
    prm.declare_entry("names",
                      "energy",
                      Anything(),
                      "Names of the objectives; each has a section `Objective NAME`, and if the name is that "
                      "of a type needs no more. Units: none.");
    prm.add_parameter(
      "gradients",
      gradients,
      "each: one adjoint per objective, all in one backward sweep; combined: one of their weighted sum. "
      "Units: none.",
      Selection("each|combined"));
    prm.add_parameter(
      "history every",
      every,
      "Evaluate the objectives of the run so far every so many increments; 0 for the end only. Units: none.");
    prm.leave_subsection();
    for (ObjectiveParameters &objective : all)
      objective.add_parameters(prm);
  }

  void Parameters::add_parameters(dealii::ParameterHandler       &prm,
                                  const std::vector<std::string> &die_names,
                                  const std::vector<std::string> &objective_names)
  {
    billet.add_parameters(prm);
    prm.enter_subsection("Dies");
    prm.declare_entry(
      "names", "", Anything(), "Names of the dies; each has a section `Die NAME`. Units: none.");
    prm.leave_subsection();
    dies.clear();
    for (const std::string &name : die_names)
      dies.emplace_back(name);
    for (DieParameters &die : dies)
      die.add_parameters(prm);
    material.add_parameters(prm);
    press.add_parameters(prm);
    discretization.add_parameters(prm);
    contact.add_parameters(prm);
    newton.add_parameters(prm);
    linear_solver.add_parameters(prm);
    remeshing.add_parameters(prm);
    adjoint.add_parameters(prm);
    objectives.all.clear();
    for (const std::string &name : objective_names)
      objectives.all.emplace_back(name);
    objectives.add_parameters(prm);
    design.add_parameters(prm);
    check.add_parameters(prm);
    scan.add_parameters(prm);
    optimization.add_parameters(prm);
    output.add_parameters(prm);
  }

  namespace
  {
    /// Names become sections of the parameter file, names of files, and parts of the names of parameters.
    void check_name(const std::string &where, const std::string &name)
    {
      const bool is_sound = !name.empty() && name.size() <= 64 &&
                            std::all_of(name.begin(), name.end(), [](const unsigned char c) {
                              return std::isalnum(c) != 0 || c == ' ' || c == '_' || c == '-' || c == '.';
                            });
      if (!is_sound)
        throw Error(where,
                    "holds the name '" + legible(name) + "'",
                    "a name has 1 to 64 of the characters a-z, A-Z, 0-9, blank, '_', '-' and '.'",
                    "rename it and its section");
    }

    /// The names that a parameter lists. Those of dies and objectives must be known before their sections can
    /// be declared.
    std::vector<std::string> names_in(const std::map<std::string, std::string> &values,
                                      const std::string                        &where,
                                      const std::string                        &by_default)
    {
      const auto                     given = values.find(where);
      const std::vector<std::string> all =
        dealii::Utilities::split_string_list(given == values.end() ? by_default : given->second);
      constexpr std::size_t most = 100;
      if (all.size() > most)
        throw Error(where,
                    "holds " + std::to_string(all.size()) + " names",
                    "there may be " + std::to_string(most),
                    "name each once");
      for (unsigned int i = 0; i < all.size(); ++i)
      {
        check_name(where, all[i]);
        if (std::find(all.begin(), all.begin() + i, all[i]) != all.begin() + i)
          throw Error(where, "'" + all[i] + "' stands twice", "names must differ", "rename one");
      }
      return all;
    }

    std::vector<std::string> objective_names(const std::map<std::string, std::string> &values)
    {
      const std::string              where = "Objectives/names";
      const std::vector<std::string> names = names_in(values, where, "energy"),
                                     types = ObjectiveParameters::types();
      for (const std::string &name : names)
        if (std::find(types.begin(), types.end(), name) == types.end() &&
            values.count("Objective " + name + "/type") == 0)
        {
          const std::string meant = nearest_name(name, types, tolerated_edits(name));
          throw Error(where,
                      "'" + name + "' is no type of objective, and `Objective " + name + "' sets none",
                      "the types are " + join(types),
                      meant.empty() ? "name one of them, or set the type in that section"
                                    : "did you mean '" + meant + "'?");
        }
      return names;
    }

    /// Sections `Die NAME' or `Objective NAME' of files whose name is not in the list: left there for a
    /// time. One that may be meant by a name of the list that has no section is none of them, but misspelt.
    std::vector<std::string> unlisted_sections(const std::vector<ParameterLine> &lines,
                                               const std::string                &kind,
                                               const std::vector<std::string>   &names)
    {
      std::vector<std::string> sections, without_section;
      for (const ParameterLine &line : lines)
        if (!line.value && line.path.rfind(kind + " ", 0) == 0 && line.path.find('/') == std::string::npos)
          sections.push_back(line.path);
      const auto has_section = [&](const std::string &path) {
        return std::find(sections.begin(), sections.end(), path) != sections.end();
      };
      for (const std::string &name : names)
        if (!has_section(kind + " " + name))
          without_section.push_back(name);
      std::vector<std::string> unlisted;
      for (const std::string &section : sections)
        if (const std::string name = section.substr(kind.size() + 1);
            std::find(names.begin(), names.end(), name) == names.end() &&
            std::find(unlisted.begin(), unlisted.end(), section) == unlisted.end() &&
            nearest_name(name, without_section, tolerated_edits(name)).empty())
          unlisted.push_back(section);
      return unlisted;
    }

    std::vector<ParameterLine> without_section(std::vector<ParameterLine> lines, const std::string &section)
    {
      lines.erase(std::remove_if(lines.begin(),
                                 lines.end(),
                                 [&](const ParameterLine &line) {
                                   return line.path == section || line.path.rfind(section + "/", 0) == 0;
                                 }),
                  lines.end());
      return lines;
    }

    /// A relative name of a file that stands beside the case's parameter file is that file, wherever the
    /// program is started; others are left as they are.
    std::string beside(const std::string &case_file, const std::filesystem::path &name)
    {
      const std::filesystem::path there = std::filesystem::path(case_file).parent_path() / name;
      std::error_code             ignored;
      return !name.empty() && name.is_relative() && std::filesystem::is_regular_file(there, ignored)
               ? there.lexically_normal().string()
               : name.string();
    }

    /// A relative name of a file that is there, for a parameter file in another folder; others are left as
    /// they are.
    std::string seen_from(const std::string &folder, const std::filesystem::path &name)
    {
      std::error_code             failed;
      const std::filesystem::path there =
        !name.empty() && name.is_relative() && std::filesystem::is_regular_file(name, failed)
          ? std::filesystem::relative(name, folder, failed)
          : std::filesystem::path();
      return failed || there.empty() ? name.string() : there.string();
    }

    /// A list of names, where the entry has one, each of which becomes another; else one name, with commas
    /// that it may have.
    template <typename Rename>
    std::string renamed(const std::string &entry, const std::string &names, const Rename &one)
    {
      if (entry != "operations")
        return one(names);
      std::vector<std::string> files = dealii::Utilities::split_string_list(names);
      std::transform(files.begin(), files.end(), files.begin(), one);
      return join(files);
    }
  } // namespace

  void Parameters::print_template(std::ostream &out)
  {
    dealii::ParameterHandler prm;
    Parameters               parameters;
    parameters.add_parameters(prm, {"lower", "upper"}, {"energy"});
    set_parameters(prm,
                   parameter_lines_of(R"(subsection Dies
  set names = lower, upper
end
subsection Die lower
  set facing   = 0, 0, 1
  set friction = 0.3
end
subsection Die upper
  set point    = 0, 0, 50
  set facing   = 0, 0, -1
  set velocity = 0, 0, -100
  set friction = 0.3
end
)",
                                      "template"));
    print_parameters(prm, out);
  }

  Parameters Parameters::read(const std::string                                      &file,
                              const std::vector<std::pair<std::string, std::string>> &overrides,
                              std::string                                            &echo)
  {
    return of_lines(file, read_parameter_lines(file, overrides), echo);
  }

  Parameters Parameters::read(const CommandLine &command, std::string &echo)
  {
    if (command.case_text.empty())
      return read(command.case_file, command.settings(), echo);
    std::vector<ParameterLine>       lines = parameter_lines_of(command.case_text, command.case_file);
    const std::vector<ParameterLine> more  = override_lines(command.settings());
    lines.insert(lines.end(), more.begin(), more.end());
    return of_lines("", lines, echo);
  }

  Parameters Parameters::of_record(const std::string &text)
  {
    std::string ignored;
    return of_lines("", parameter_lines_of(text, "parameters of the record"), ignored);
  }

  Parameters
  Parameters::of_lines(const std::string &file, std::vector<ParameterLine> lines, std::string &echo)
  {
    const auto               values     = parameter_values(lines);
    const auto               dies       = names_in(values, "Dies/names", "");
    const auto               objectives = objective_names(values);
    Parameters               parameters;
    dealii::ParameterHandler prm;
    parameters.add_parameters(prm, dies, objectives);
    for (const auto &[kind, list, names] : {std::make_tuple("Die", "Dies/names", dies),
                                            std::make_tuple("Objective", "Objectives/names", objectives)})
      for (const std::string &section : unlisted_sections(lines, kind, names))
      {
        lines = without_section(std::move(lines), section);
        parameters.without_effect.push_back("section `" + section + "' is not read, as " + list +
                                            " does not name it");
      }
    set_parameters(prm, lines);
    for (const auto &[section, entry] : parameters.entries_of_files())
    {
      prm.enter_subsection(section);
      prm.set(entry,
              renamed(entry, prm.get(entry), [&](const std::string &name) { return beside(file, name); }));
      prm.leave_subsection();
    }
    parameters.check_all();
    parameters.find_without_effect(declared_parameters(prm));
    std::ostringstream text;
    print_parameters(prm, text);
    echo = text.str();
    return parameters;
  }

  std::vector<std::pair<std::string, std::string>> Parameters::entries_of_files() const
  {
    std::vector<std::pair<std::string, std::string>> entries = {{"Billet", "file name"},
                                                                {"Optimisation", "operations"}};
    for (const DieParameters &die : dies)
      entries.emplace_back("Die " + die.name, "file");
    for (const ObjectiveParameters &objective : objectives.all)
      entries.emplace_back("Objective " + objective.name, "target");
    return entries;
  }

  std::vector<std::pair<std::string, std::string>> Parameters::files_seen_from(const std::string &folder,
                                                                               const std::string &echo) const
  {
    std::vector<std::pair<std::string, std::string>> overrides;
    const auto values = parameter_values(parameter_lines_of(echo, "parameters"));
    for (const auto &[section, entry] : entries_of_files())
      if (const auto found = values.find(section + "/" + entry); found != values.end())
      {
        const std::string there =
          renamed(entry, found->second, [&](const std::string &name) { return seen_from(folder, name); });
        if (there != found->second)
          overrides.emplace_back(section + "/" + entry, there);
      }
    return overrides;
  }

  void Parameters::find_without_effect(const std::vector<ParameterEntry> &entries)
  {
    const auto add = [&](const std::string &chooser, const ReadBy &read_by) {
      const auto found = settings_without_effect(entries, chooser, read_by);
      without_effect.insert(without_effect.end(), found.begin(), found.end());
    };
    add("Billet/shape", BilletParameters::read_by_shape());
    for (const DieParameters &die : dies)
      add("Die " + die.name + "/shape", Choice<DieKind>::read_by(die_kinds()));
    for (const ObjectiveParameters &objective : objectives.all)
      add("Objective " + objective.name + "/type", Choice<ObjectiveType>::read_by(objective_types()));
    add("Remeshing/when", {{"increments", {"every"}}});
    add("Adjoint/derivatives",
        {{"semi-analytic", {"perturbation"}}, {"semi-analytic central", {"perturbation"}}});
    if (objectives.gradients == "each")
      for (const ParameterEntry &entry : entries)
        if (entry.name == "weight" && entry.value != entry.default_value)
          without_effect.push_back(entry.path() + " = " + entry.value +
                                   " has no effect: Objectives/gradients = each makes no weighted sum");
  }

  void Parameters::check_all()
  {
    billet.check();
    contact.check();
    remeshing.check();
    scan.check();
    optimization.check();
    if (dies.empty())
      throw Error(
        "Dies/names", "names no die", "a billet is forged by at least one die", "set names = lower, upper");
    if (objectives.all.empty())
      throw Error("Objectives/names",
                  "names no objective",
                  "a run is judged by at least one",
                  "leave the line out for the energy");
    for (unsigned int d = 0; d < dies.size(); ++d)
    {
      dies[d].check();
      const DieState<double> state = initial_state(dies[d]);
      if (contact.slip_fraction < least_slip && needs_regularisation(state, material.law))
        throw Error("Contact/slip regularisation",
                    "is " + as_text(contact.slip_fraction) +
                      " with friction and a strain rate sensitivity below 1",
                    "the friction of a sticking node would be infinitely stiff",
                    "use 1e-2, or 1e-3 for a sharper law");
    }
    leading_die();
  }

  unsigned int Parameters::leading_die() const
  {
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (press.leading_die.empty() ? dies[d].velocity.norm() > 0. : dies[d].name == press.leading_die)
      {
        if (dies[d].velocity.norm() == 0.)
          throw Error("Press/leading die",
                      "'" + dies[d].name + "' does not move",
                      "the stroke is the path of the leading die",
                      "give it a velocity or name another");
        return d;
      }
    std::vector<std::string> names;
    for (const DieParameters &die : dies)
      names.push_back(die.name);
    if (press.leading_die.empty())
      throw Error("Dies", "no die moves", "one at least must", "give a die a velocity" + unlisted_dies());
    throw Error("Press/leading die",
                "there is no die '" + press.leading_die + "'",
                "the dies are: " + join(names),
                "name one of them, or leave it empty for the first die that moves");
  }

  BilletSize Parameters::size_of(const TetMesh &mesh) const
  {
    const double side = std::cbrt(volume(mesh.cells, mesh.X));
    if (billet.shape != "file")
      return {side, billet.whole_height()};
    const Vec3 &velocity = dies[leading_die()].velocity;
    const Vec3  way      = velocity / velocity.norm();
    double      lowest = std::numeric_limits<double>::max(), highest = std::numeric_limits<double>::lowest();
    for (const Vec3 &x : mesh.X)
    {
      lowest  = std::min(lowest, x * way);
      highest = std::max(highest, x * way);
    }
    const bool halved = std::any_of(mesh.patches.begin(), mesh.patches.end(), [&](const Patch &patch) {
      return patch.symmetry && std::abs(patch.symmetry->normal * way) > 1. - 1e-6;
    });
    return {side, (halved ? 2. : 1.) * (highest - lowest)};
  }

  void Parameters::check_derived(const BilletSize &size) const
  {
    const auto is_sound = [](const double x) { return x > 1e-50 && x < 1e50; };
    const auto require  = [](const bool sound, const std::string &where, const std::string &what) {
      if (!sound)
        throw Error(where,
                    "makes " + what + " zero or infinite",
                    "what follows from the parameters must be between 1e-50 and 1e50",
                    "use values of the usual size: lengths in mm, speeds in mm/s, stresses in MPa");
    };
    const StepModel model = step_model();
    require(is_sound(press.stroke / press.increments), "Press/stroke", "the increments of stroke");
    require(is_sound(model.reach) && is_sound(model.contact.ramp.width),
            "Contact",
            "the reach of contact (approach, layer, ramp width)");
    const Process<double> made = process(size);
    require(is_sound(made.speed()), "Dies", "the speed of the leading die");
    require(is_sound(mean_pressure(size)), "Material", "the flow stress");
    require(is_sound(made.contact.rho), "Contact", "the penalty (with the speed and the material)");
    // In words of Contact/penetration, and within its bounds.
    const double penetration = mean_pressure(size) / (made.contact.rho * closing_speed(made.dies));
    if (contact.penalty > 0. && !(penetration >= 1e-14 && penetration <= 1.))
      throw Error("Contact/penalty",
                  "is " + as_text(contact.penalty) + " MPa s/mm, with which nodes sink in at " +
                    as_text(penetration) + " times the speed at which the dies close",
                  "as for Contact/penetration that must be from 1e-14 to 1",
                  "leave it 0 and set Contact/penetration");
    const double n_cells =
      remeshing.element_size > 0. ? 8. * std::pow(size.side / remeshing.element_size, 3) : 0.;
    if (!(n_cells <= 1e9))
      throw Error("Remeshing/element size",
                  "is " + as_text(remeshing.element_size) + ", which makes about " + as_text(n_cells) +
                    " tetrahedra",
                  "a mesh may have 1e9",
                  "choose a larger element size, or 0 for that of the billet");
  }

  void Parameters::leave_out_idle_parameters()
  {
    for (const auto &[name, reason] : idle_parameters(dies, material.law))
      if (const auto found = std::find(design.names.begin(), design.names.end(), name);
          found != design.names.end())
      {
        design.names.erase(found);
        without_effect.push_back("Design/parameters: '" + name + "' changes nothing, as " + reason);
      }
  }

  std::string Parameters::unlisted_dies() const
  {
    std::string text;
    for (const std::string &sentence : without_effect)
      if (sentence.rfind("section `Die ", 0) == 0)
        text += "; " + sentence;
    return text;
  }

  Parameters &Parameters::settle(const BilletSize &size)
  {
    const double smooth_step = 2.5e-3 * size.height;
    if (press.increments == 0)
    {
      constexpr double most   = 1e9;
      const double     number = std::max(1., std::ceil(closing_path() / smooth_step - 1e-9));
      if (!(number <= most))
        throw Error("Press/stroke",
                    "is so long that it takes " + as_text(number) + " increments",
                    "there may be 1e9",
                    "shorten the stroke, or set Press/increments");
      press.increments = number;
    }
    check_derived(size);
    const Process<double> made = process(size);
    edge_stiffness_            = std::min(
      1., mean_pressure(size) / (contact.edge_sinking * closing_speed(made.dies)) / made.contact.rho);
    return *this;
  }

  double Parameters::closing_path() const
  {
    return press.stroke * (closing_speed(initial_states()) / dies[leading_die()].velocity.norm());
  }

  std::vector<DieState<double>> Parameters::initial_states() const
  {
    std::vector<DieState<double>> states;
    for (const DieParameters &die : dies)
      states.push_back(initial_state(die));
    return states;
  }

  double Parameters::mean_pressure(const BilletSize &size) const
  {
    const double speed = closing_speed(initial_states());
    return open_contact(size).mean_pressure(material.metal(speed / size.height).law, speed);
  }

  OpenContact Parameters::open_contact(const BilletSize &size) const
  {
    return {size.height, contact.penetration, contact.penalty, contact.slip_fraction};
  }

  Process<double> Parameters::process(const BilletSize &size) const
  {
    Process<double> process;
    process.dies        = initial_states();
    process.leading_die = leading_die();
    const double speed  = closing_speed(process.dies);
    process.material    = material.metal(speed / size.height);
    process.contact     = open_contact(size).law(process.material.law, speed);
    return process;
  }

  Objectives Parameters::make_objectives(const std::vector<Die> &made_dies, const TetMesh &made_billet) const
  {
    Objectives made;
    for (const ObjectiveParameters &objective : objectives.all)
      made.push_back(objective.make({made_dies,
                                     initial_states(),
                                     leading_die(),
                                     press.stroke,
                                     material.law.K,
                                     made_billet,
                                     step_model().contact.ramp}));
    return made;
  }

  std::vector<Combination> Parameters::combinations(const Objectives &made_objectives) const
  {
    return objectives.gradients == "each" ? each(made_objectives)
                                          : std::vector<Combination>{combined(made_objectives)};
  }

  StepModel Parameters::step_model() const
  {
    StepModel    model;
    const double step            = press.stroke / press.increments;
    const double closing         = closing_path() / press.increments;
    model.scheme                 = Scheme::by_name(press.scheme);
    model.edges_touch            = contact.points == "nodes and edges";
    model.contact.approach       = contact.approach;
    model.contact.ramp.sharp     = contact.law == "sharp";
    model.contact.edge_stiffness = edge_stiffness_;
    model.contact.ramp.width     = contact.ramp_width * contact.approach * closing;
    const double layer           = model.contact.ramp.sharp ? 0. : contact.layer;
    model.contact.layer          = layer * contact.approach * closing;
    model.contact.step           = step;
    // Where a node meets the approach speed that closes at that of the dies.
    const double arrival = layer == 0. ? 1. : layer * std::sinh(1. / layer);
    model.reach = std::max({3., 3. * contact.ramp_width, 1.5 * arrival}) * contact.approach * closing;
    model.adjoint_tolerance = adjoint.tolerance;
    model.shape_derivatives = adjoint.shape_derivatives();
    return model;
  }

  double Parameters::edge_length(const TetMesh &mesh) const
  {
    if (remeshing.element_size > 0.)
      return remeshing.element_size;
    if (billet.shape != "file")
      return billet.element_size;
    double sum = 0.;
    for (const auto &cell : mesh.cells)
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < a; ++b)
          sum += (mesh.X[cell[a]] - mesh.X[cell[b]]).norm();
    return sum / (6. * mesh.n_cells());
  }
} // namespace retroforge
