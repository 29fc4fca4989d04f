// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace retroforge
{
  /// The result of forging a design.
  struct Evaluation
  {
    std::vector<double> mu;      ///< values of the design parameters
    std::vector<double> values;  ///< values of the objectives; empty where the forging failed
    std::string         failure; ///< why, or empty
    unsigned int        increments = 0;
    double              seconds    = 0.;
    /// Gradients of the objectives in the parameters; empty where they were not computed.
    std::vector<std::vector<double>> gradients;
    std::string                      operation = {}; ///< operation that was forged; empty for the main one
    /// Strokes at the ends of its increments, where other designs repeat them [mm].
    std::vector<double> steps = {};

    bool failed() const { return values.empty(); }

    /// Serialises for another rank.
    template <typename Archive>
    void serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &mu &values &failure &increments &seconds &gradients &operation &steps;
    }
  };

  /// The forgings of an optimisation, kept as they are done: one line of JSON for each, and one for its
  /// gradients, with numbers as they are, bit for bit. An optimiser that begins again with the same case asks
  /// for the same designs in the same order, and gets them from here, until it comes to those that are still
  /// to be forged.
  ///
  /// Designs are forged on one mesh of the billet or another: each mesh has a line, and each forging on
  /// another than the first one names it. What is asked for and added is of the mesh in use.
  class Journal
  {
  public:
    /// Identification of the case and the program that forge.
    struct Header
    {
      std::string                        program, parameters;
      std::map<std::string, std::string> operations = {}; ///< parameters of others, by their names
      /// Fingerprints of what parameters only name: billets, dies and targets, in all operations.
      std::map<std::string, std::uint64_t> surfaces = {};
    };

    /// Reads what is there; a line that was cut short by the program's end does not count.
    /// @throws Error  for what is no journal
    static Journal read(const std::string &file);

    /// Makes an empty journal.
    explicit Journal(Header header) : header_(std::move(header)) {}

    void set_header(Header header) { header_ = std::move(header); }

    const Header &header() const { return header_; }
    std::size_t   size() const { return evaluations_.size(); }
    /// Number of a design in an operation; size() where it is not here. Of the main one on the mesh in use.
    std::size_t       place_of(const std::vector<double> &mu, const std::string &operation = "") const;
    const Evaluation *find(const std::vector<double> &mu, const std::string &operation = "") const;
    /// Returns the design whose increments others repeat in an operation, on the mesh in use; null before it.
    const Evaluation *find_steps(const std::string &operation) const;
    const Evaluation &operator[](const std::size_t i) const { return evaluations_[i]; }

    /// @param made_at  what tells the mesh from others: the designs it was made at, one after the other;
    /// empty
    ///                 for the first mesh
    /// @return its number, 0 for the first one   @throws Error  if a new one cannot be written
    unsigned int use_mesh(const std::string &made_at);

    /// Returns the number of the mesh in use in an operation; others than the main one keep their own meshes.
    unsigned int mesh_in(const std::string &operation) const { return operation.empty() ? mesh_ : 0; }

    /// Writes the journal to `file`, and from here on what is added, too.
    /// @throws Error  if it cannot be written
    void write_to(const std::string &file);

    /// @return its number   @throws Error  if it cannot be written
    std::size_t add(Evaluation evaluation);
    void        add_gradients(std::size_t i, std::vector<std::vector<double>> gradients);

  private:
    void append(const std::string &line) const;

    Header                    header_;
    std::vector<Evaluation>   evaluations_;
    std::vector<std::string>  meshes_ = {""};
    std::vector<unsigned int> mesh_of_;  ///< each of the evaluations
    unsigned int              mesh_ = 0; ///< in use
    std::string               file_;     ///< empty: not written
  };
} // namespace retroforge
