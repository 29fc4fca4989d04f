// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/billet_map.h>
#include <retroforge/design/die_free_form.h>
#include <retroforge/design/open_contact.h>
#include <retroforge/steps/process.h>

namespace retroforge
{
  /// A number that a design can change, and the quantity it acts on.
  struct DesignParameter
  {
    enum class Kind
    {
      material,        ///< a number of the material law
      contact,         ///< a number of the contact law
      heat,            ///< a number of the metal's heat
      transfer,        ///< time in the surroundings before the stroke of one operation
      dwell,           ///< time on the resting die before it
      friction,        ///< friction coefficient of one die, or of all that have friction
      shear_limit,     ///< bound of one die's friction, where its law has one
      zone_friction,   ///< friction coefficient of one zone of a die
      zone_limit,      ///< bound of its friction, where its law has one
      die_temperature, ///< of one die before it touches metal
      speed,           ///< speed of one die along its velocity
      offset,          ///< offset of one die along its facing direction
      die_shape,       ///< a measure of one tripod or bell
      die_free_form,   ///< a mode of one die's surface
      billet           ///< a parameter of the billet's shape, see BilletMap
    };

    std::string  name;
    std::string  unit;
    Kind         kind;
    double       nominal    = 0.;
    double       scale      = 1.;            ///< a length or size that steps are relative to
    unsigned int die        = invalid_index; ///< invalid_index: all
    unsigned int number     = 0;     ///< in the law, among operations, modes or zones, or in BilletMap
    std::string  measure    = {};    ///< measure of a die's shape
    bool         may_vanish = false; ///< else it is positive, unless it is free
    double       largest    = std::numeric_limits<double>::infinity();
    bool         any_sign   = false; ///< a number of a law that may be negative

    /// Returns whether values may have any sign: shapes are checked where they are made.
    bool is_free() const
    {
      return any_sign || kind == Kind::offset || kind == Kind::die_free_form || kind == Kind::billet;
    }
    /// Returns whether both set the same number.
    bool overlaps(const DesignParameter &other) const;
  };

  /// Names of parameters that would change nothing in a scene, because another number is 0 or 1, and which
  /// that is.
  std::map<std::string, std::string> idle_parameters(const std::vector<DieParameters> &dies,
                                                     const Material<double>           &material);

  /// The map from parameter values to the initial positions and the process, and its derivative: both are
  /// code templated on the number type.
  class Design
  {
  public:
    /// @param names   as in `material/K`, `die upper/friction`, `billet/stretch`; unknown ones throw Error
    /// @param contact  what numbers of the contact law follow from that are no parameters
    Design(const std::vector<std::string>   &names,
           const BilletParameters           &billet,
           const std::vector<DieParameters> &dies,
           const Process<double>            &nominal_process,
           const OpenContact                &contact,
           const FirstMesh                  &first);

    const std::vector<DesignParameter> &parameters() const { return parameters_; }
    std::vector<double>                 nominal() const;
    /// Returns the nominal values with those given by name in their place; names are among parameters().
    /// @throws Error  for values that no process has, as a negative friction
    std::vector<double> at(const std::multimap<std::string, double> &values) const;
    /// @throws Error  as at()
    void               check_values(const std::vector<double> &mu) const;
    const std::string &die_name(const unsigned int d) const { return dies_[d].name; }

    template <typename Number>
    NodalVectors<Number> positions(const std::vector<Number> &mu) const;

    template <typename Number>
    Process<Number> process(const std::vector<Number> &mu) const;

    /// Smallest quality of the billet's cells at a design, zero or less where one is turned inside out.
    /// @throws Error  where no value of the parameter that holds the volume keeps it
    double mesh_quality(const std::vector<double> &mu) const;

    /// Returns the parameter of the billet that holds the volume, and so follows from the others, if there is
    /// one.
    std::optional<DesignParameter> held() const;
    /// Its value.  @throws Error  where none keeps the volume
    double              held_value(const std::vector<double> &mu) const;
    std::vector<double> held_gradient(const std::vector<double> &mu) const;

    /// Values of the parameters of the billet's shape that differ from the nominal ones, by name; the one
    /// that holds the volume too.
    std::vector<std::pair<std::string, double>> billet_at(const std::vector<double> &mu) const;

    /// dPhi/dmu from dPhi/dX_0 and the derivatives in the process: one number per parameter.
    std::vector<double> pull_back(const std::vector<double>  &mu,
                                  const NodalVectors<double> &X_0_bar,
                                  const Process<double>      &process_bar) const;

    /// Returns the coefficient of the friction on die d, as its law has it.
    NumberInfo friction_of(unsigned int d) const;

    /// Returns all parameters that this scene offers.
    std::vector<DesignParameter> offered() const;
    /// Returns names with `billet/free form` and `die NAME/free form` replaced by those of all their modes.
    std::vector<std::string> expanded(const std::vector<std::string> &names) const;
    /// @param where  the name stands, for the message     @throws Error  for a name that is not among them
    void check_offered(const std::string &name, const std::string &where) const;

  private:
    /// Values of the billet map's parameters.
    template <typename Number>
    std::vector<Number> shape_of(const std::vector<Number> &mu) const;
    void                check_common_friction() const;

    /// Numbers of the contact law: those that are parameters, and those that follow from metal and speed.
    template <typename Number>
    void set_contact(const std::vector<Number> &mu, Process<Number> &process) const;

    /// Dies that follow the billet start as far from it as in the nominal design; the leading one ends where
    /// it does there.
    template <typename Number>
    void follow_billet(const std::vector<Number> &mu, Process<Number> &process) const;

    /// Measures and modes of the dies that the parameters change.
    template <typename Number>
    void shape_dies(const std::vector<Number> &mu, Process<Number> &process) const;

    std::vector<DieParameters>   dies_;
    std::vector<DieFreeForm>     die_forms_; ///< free form of each die
    Process<double>              process_;
    OpenContact                  contact_;
    BilletMap                    billet_map_;
    NodalVectors<double>         nominal_X_; ///< positions of the nodes in the nominal shape
    std::vector<NodeIndex>       followed_;  ///< by each die: the billet's first node in its way; or none
    double                       width_;     ///< the billet's extent in x, before cuts; of a file, its mesh's
    std::vector<DesignParameter> parameters_;
  };
} // namespace retroforge
