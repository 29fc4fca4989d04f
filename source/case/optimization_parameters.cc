// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/optimization_parameters.h>
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>

#include <algorithm>

namespace retroforge
{
  void OptimizationParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Optimisation");
    prm.add_parameter(
      "objective",
      objective,
      "Names of the objectives whose sum, by their weights, `optimize' makes small; empty for "
      "all that no limit is set on. Units: none.");
    prm.add_parameter("at most",
                      at_most,
                      "Objectives that may not be larger, and by how much, `NAME: VALUE, NAME: VALUE'. "
                      "Units: those of the objectives.");
    prm.add_parameter(
      "at least", at_least, "Objectives that may not be smaller. Units: those of the objectives.");
    prm.add_parameter(
      "data",
      data,
      "Measured values of objectives, `NAME: VALUE, NAME: VALUE': `optimize' then looks for the "
      "parameters with which the forging agrees with them best, by least squares, instead of "
      "making an objective small. Units: those of the objectives.");
    prm.add_parameter(
      "uncertainties",
      uncertainties,
      "Standard deviations of the data, one for each of them. Units: those of the objectives.");
    prm.add_parameter("lower bounds",
                      lower,
                      "Least values of design parameters, `NAME: VALUE, NAME: VALUE'. Units: those of the "
                      "parameters.");
    prm.add_parameter(
      "upper bounds", upper, "Largest values of design parameters. Units: those of the parameters.");
    prm.add_parameter(
      "relations",
      relations,
      "Linear relations of design parameters that hold for every design, `2 NAME - NAME <= 5, "
      "NAME = NAME': sums of parameters, with factors, on both sides of <=, >= or =. Units: "
      "those of the parameters.");
    prm.add_parameter("scales",
                      scales,
                      "Changes of design parameters that are of the same weight, `NAME: VALUE, NAME: VALUE': "
                      "steps are measured in them. Those not named get 2 % of the size that steps of theirs "
                      "are relative to. Units: those of the parameters.");
    prm.add_parameter("first step",
                      first_step,
                      "Largest change of any parameter in the first step, in scales. Units: none.",
                      Double(1e-6, 1e6));
    prm.add_parameter("largest step",
                      largest_step,
                      "Largest change of any parameter in a step, in scales. Units: none.",
                      Double(1e-6, 1e6));
    prm.add_parameter("iterations", iterations, "Steps that may be tried. Units: none.", Integer(1, 100000));
    prm.add_parameter("simulations",
                      simulations,
                      "Forgings that may be run, confirmation not counted: no design is begun beyond. "
                      "Units: none.",
                      Integer(1, 100000));
    prm.add_parameter(
      "gradient tolerance",
      gradient_tolerance,
      "The optimum is reached when the gradient, without what bounds hold, is this part of "
      "that at the start; with data, and a step promises to bring them nearer by less than a tenth of "
      "their deviations. Units: none.",
      Double(0., 1.));
    prm.add_parameter(
      "least gain",
      least_gain,
      "A search ends where eight designs in a row have gained less than this part of the objective together, "
      "as along a kink of it; 0: it goes on. Not with data. Units: none.",
      Double(0., 1.));
    prm.add_parameter(
      "limit tolerance",
      limit_tolerance,
      "Part of a limit by which it may be exceeded at the optimum: 1e-4 of 1185 C is 0.12 K. Of a limit "
      "of 0, part of the value at the start. Units: none.",
      Double(1e-8, 0.1));
    prm.add_parameter(
      "noise runs",
      noise_runs,
      "Forgings around the start, 0.001 scales away, that measure how rough the objective "
      "is: steps that promise less than this are not taken. As many again where the search ends "
      "for it. 0 for no noise. Units: none.",
      Integer(0, 100));
    prm.add_parameter(
      "mesh quality",
      mesh_quality,
      "The billet is meshed anew at a design that was accepted when its cells there, moved from where they "
      "were made, have become worse than this: the least sine of an angle between two faces of a cell, 0.94 "
      "for the regular tetrahedron. 0 leaves the first mesh as it is. Units: none.",
      Double(0., 0.5));
    prm.add_parameter("confirmation",
                      confirmation,
                      "Start and optimum are forged again with elements and increments this much smaller; 0 "
                      "leaves it out. Units: none.",
                      Double(0., 1.));
    prm.add_parameter("corrections",
                      corrections,
                      "How often the search may go on where the confirmation says that a limit is not kept "
                      "there, within iterations and simulations: the limit then counts what the finer mesh "
                      "added to the value, and its noise. Units: none.",
                      Integer(0, 100));
    prm.add_parameter(
      "keep records",
      keep_records,
      "Whether the record of each design that becomes the next one is kept, in designs/trial_N: "
      "retroforge gradient --resume goes through it again, with other objectives, too. Units: "
      "none.",
      Bool());
    prm.add_parameter("scattered",
                      scattered,
                      "A design parameter that a workshop does not hold, as dies/friction: every design is "
                      "forged with several values of it, and each objective counts by its mean and its "
                      "standard deviation over them. Empty for none. Units: none.");
    prm.add_parameter("scatter range",
                      scatter_range,
                      "From where to where the scattered parameter lies, evenly: `FROM, TO'. Units: those of "
                      "the parameter.",
                      List(Double(), 0, 2));
    prm.add_parameter("samples",
                      samples,
                      "Values of the scattered parameter, at the points of a Gauss quadrature. Units: none.",
                      Integer(2, 20));
    prm.add_parameter("deviations",
                      deviations,
                      "How many standard deviations are added to the mean of an objective (taken from it "
                      "where a limit is a lower one). Units: none.",
                      Double(0., 10.));
    prm.add_parameter(
      "operations",
      operations,
      "Parameter files of other cases, beside this one, that are forged with each design, too: the "
      "design parameters that they have in common with this case have the same values there, their "
      "objectives are called `OBJECTIVE of FILE', without the file's ending. Units: none.");
    prm.add_parameter(
      "side by side",
      side_by_side,
      "Groups into which the ranks of `mpirun -np N' are divided: each forges its share of "
      "the samples and operations of a design, all at a time. Numbers are those of one group with as many "
      "ranks as each of them has. Units: none.",
      Integer(1, 10000));
    prm.leave_subsection();
    tag(prm, "Optimisation", SettingRole::report);
    tag(prm, "Optimisation/operations", SettingTags::Files::list);
  }

  void OptimizationParameters::check_data() const
  {
    for (const auto &[name, value] : data)
      if (uncertainties.count(name) == 0)
        throw Error("Optimisation/uncertainties",
                    "has none for '" + name + "'",
                    "data count by how well they are known",
                    "give its standard deviation, in its unit");
    for (const auto &[name, value] : uncertainties)
      if (data.count(name) == 0 || !(value > 0.))
        throw Error("Optimisation/uncertainties",
                    data.count(name) == 0 ? "has one of '" + name + "', which is not among the data"
                                          : "gives " + name + " " + as_text(value),
                    "each of the data has one, and it is positive",
                    "correct it or leave it out");
    if (!data.empty() && (!objective.empty() || !at_most.empty() || !at_least.empty()))
      throw Error("Optimisation/data",
                  "are given beside an objective or limits",
                  "an optimisation agrees with data, or makes an objective small",
                  "leave one of them out");
  }

  void OptimizationParameters::check_limits() const
  {
    for (const auto &[name, least] : at_least)
      if (const auto most = at_most.find(name); most != at_most.end() && !(least < most->second))
        throw Error("Optimisation/at least",
                    "asks for " + as_text(least) + " of '" + name + "', and `at most' for " +
                      as_text(most->second),
                    "no value is both",
                    "leave a range between them");
    for (const std::string &name : objective)
      if (std::count(objective.begin(), objective.end(), name) > 1)
        throw Error("Optimisation/objective",
                    "'" + name + "' stands twice",
                    "each counts once, by its weight",
                    "leave one of them out, or give it a larger weight in its section");
  }

  void OptimizationParameters::check() const
  {
    const auto check_once = [](const Values &values, const std::string &where) {
      for (const auto &[name, value] : values)
        if (values.count(name) > 1)
          throw Error("Optimisation/" + where,
                      "'" + name + "' stands twice",
                      "each name has one value",
                      "leave one of them out");
    };
    check_once(at_most, "at most");
    check_once(at_least, "at least");
    check_once(data, "data");
    check_once(uncertainties, "uncertainties");
    check_once(lower, "lower bounds");
    check_once(upper, "upper bounds");
    check_once(scales, "scales");
    for (const auto &[name, value] : scales)
      if (!(value > 0.))
        throw Error("Optimisation/scales",
                    "gives " + name + " the scale " + as_text(value),
                    "a scale is positive",
                    "give a change of it that matters, as 0.5 for a radius in mm");
    check_data();
    check_limits();
    if (scatter_range.size() == 2 && !scattered.empty() && !(scatter_range[0] < scatter_range[1]))
      throw Error("Optimisation/scatter range",
                  "goes from " + as_text(scatter_range[0]) + " to " + as_text(scatter_range[1]),
                  "it goes from the smaller value to the larger one",
                  "exchange them");
    if (scattered.empty() != scatter_range.empty() || (!scattered.empty() && scatter_range.size() != 2))
      throw Error("Optimisation/scatter range",
                  scattered.empty() ? "is given, and no parameter is scattered"
                                    : "does not say from where to where " + scattered + " lies",
                  "a scattered parameter has a range `FROM, TO'",
                  "set both, or leave both out");
    if (!scattered.empty() && !data.empty())
      throw Error("Optimisation/scattered",
                  "is given beside data",
                  "data are of one forging, whose parameters are looked for",
                  "leave one of them out");
    if (first_step > largest_step)
      throw Error("Optimisation/first step",
                  "is " + as_text(first_step) + ", and the largest " + as_text(largest_step),
                  "the first step is not longer than any may be",
                  "make the first shorter or the largest longer");
    if (confirmation != 0. && confirmation < 0.1)
      throw Error("Optimisation/confirmation",
                  "is " + as_text(confirmation) + ", with which a mesh has " +
                    as_text(1. / (confirmation * confirmation * confirmation)) + " times the nodes",
                  "it is 0, or 0.1 to 1",
                  "use 0.7, or 0.5 where time allows");
  }
} // namespace retroforge
