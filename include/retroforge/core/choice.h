// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/parameter_list.h>

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <memory>

namespace retroforge
{
  /// The settings that each choice reads of those that not all choices read: `radius` for the shape
  /// `cylinder`. The name of a section stands for all in it.
  using ReadBy = std::map<std::string, std::vector<std::string>>;

  /// Settings that have another value than their default, and that the choice made does not read: a sentence
  /// on each, fit for the console.
  /// @param chooser  the parameter that chooses, `Billet/shape`; the settings stand in its section
  std::vector<std::string> settings_without_effect(const std::vector<ParameterEntry> &entries,
                                                   const std::string                 &chooser,
                                                   const ReadBy                      &read_by);

  /// An object of one of several kinds that users choose by name. Each kind is a class of its own that
  /// derives from Kind, with
  ///   void add_parameters(dealii::ParameterHandler &prm);
  /// for the settings it reads. All stand in the section of the object, and kinds may share some, declared
  /// alike. Only a table of makers knows all kinds.
  template <typename Kind>
  class Choice
  {
  public:
    struct Maker
    {
      std::string name;
      /// Makes a kind with its default settings, or as a copy of another of that kind.
      std::unique_ptr<Kind> (*make)(const Kind *other);
    };
    using Makers = std::vector<Maker>;

    template <typename Derived>
    static std::unique_ptr<Kind> make(const Kind *other)
    {
      return other ? std::make_unique<Derived>(static_cast<const Derived &>(*other))
                   : std::make_unique<Derived>();
    }

    /// @param makers  of the kinds there are; live as long as the program
    Choice(const Makers &makers, std::string chosen) : name(std::move(chosen)), makers_(&makers)
    {
      for (const Maker &maker : makers)
        kinds_.push_back(maker.make(nullptr));
    }

    Choice(const Choice &other) : name(other.name), makers_(other.makers_)
    {
      for (std::size_t i = 0; i < makers_->size(); ++i)
        kinds_.push_back((*makers_)[i].make(other.kinds_[i].get()));
    }
    Choice(Choice &&)            = default;
    Choice &operator=(Choice &&) = default;
    Choice &operator=(const Choice &other) { return *this = Choice(other); }

    static std::vector<std::string> names(const Makers &makers)
    {
      std::vector<std::string> names;
      for (const Maker &maker : makers)
        names.push_back(maker.name);
      return names;
    }

    /// Chooses a kind by its class, for settings that no file gives.
    template <typename Derived>
    Derived &choose()
    {
      for (std::size_t i = 0; i < kinds_.size(); ++i)
        if (auto *kind = dynamic_cast<Derived *>(kinds_[i].get()))
        {
          name = (*makers_)[i].name;
          return *kind;
        }
      AssertThrow(false, dealii::ExcMessage("no maker makes this kind"));
      throw;
    }

    /// Declares the chooser itself.
    void add_name(dealii::ParameterHandler &prm, const std::string &chooser, const std::string &documentation)
    {
      std::string all;
      for (const std::string &known : names(*makers_))
        all += (all.empty() ? "" : "|") + known;
      prm.add_parameter(chooser, name, documentation, dealii::Patterns::Selection(all));
    }

    /// Declares the settings of all kinds.
    void add_settings(dealii::ParameterHandler &prm)
    {
      for (auto &kind : kinds_)
        kind->add_parameters(prm);
    }

    static ReadBy read_by(const Makers &makers)
    {
      ReadBy read_by;
      for (const auto &[known, make] : makers)
      {
        dealii::ParameterHandler    prm;
        const std::unique_ptr<Kind> kind = make(nullptr);
        kind->add_parameters(prm);
        for (const ParameterEntry &entry : declared_parameters(prm))
          if (const std::string &setting = entry.sections.empty() ? entry.name : entry.sections.front();
              read_by[known].empty() || read_by[known].back() != setting)
            read_by[known].push_back(setting);
      }
      return read_by;
    }

    const Kind &operator*() const
    {
      std::size_t i = 0;
      while ((*makers_)[i].name != name)
        ++i;
      return *kinds_[i];
    }
    const Kind *operator->() const { return &**this; }

    /// Returns all kinds, those not chosen too.
    const std::vector<std::unique_ptr<Kind>> &kinds() const { return kinds_; }

    std::string name; ///< name of the chosen kind, as in the table of makers

  private:
    const Makers                      *makers_;
    std::vector<std::unique_ptr<Kind>> kinds_;
  };
} // namespace retroforge
