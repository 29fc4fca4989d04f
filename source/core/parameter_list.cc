// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/parameter_list.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <ostream>
#include <set>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Names = std::vector<std::string>;

    /// The bounds in a description that reads `... LOWER...UPPER (inclusive)]`; empty where there is none.
    /// deal.II's patterns keep them to themselves.
    std::pair<std::string, std::string> bounds(const std::string &description)
    {
      static const std::set<std::string> limits = {
        "-MAX_DOUBLE", "MAX_DOUBLE", "-2147483648", "2147483647", "4294967295"};

      const std::size_t dots = description.rfind("...");
      if (dots == std::string::npos)
        return {};
      const std::size_t begin = description.rfind(' ', dots) + 1, end = description.find(' ', dots);
      const auto unless_limit = [](const std::string &text) { return limits.count(text) > 0 ? "" : text; };
      return {unless_limit(description.substr(begin, dots - begin)),
              unless_limit(description.substr(dots + 3, end - dots - 3))};
    }

    std::string range_in_plain_words(const std::string &noun, const std::string &description)
    {
      const auto [lower, upper] = bounds(description);
      if (!lower.empty() && !upper.empty())
        return noun + " from " + lower + " to " + upper;
      if (!lower.empty())
        return noun + " >= " + lower;
      if (!upper.empty())
        return noun + " <= " + upper;
      return noun;
    }

    /// deal.II describes a selection as `[Selection a|b ]`.
    std::string selection_in_plain_words(const std::string &description)
    {
      const std::size_t begin = description.find(' '), end = description.rfind(']');
      return "one of " +
             join(dealii::Utilities::split_string_list(description.substr(begin, end - begin), '|'));
    }

    std::string in_plain_words(const dealii::Patterns::PatternBase &pattern);

    std::string list_in_plain_words(const dealii::Patterns::List &list)
    {
      const auto [least, most] = bounds(list.description());
      const std::string number = least == most ? least + " " : least == "0" ? "" : "at least " + least + " ";
      return "a list of " + number + "items separated by '" + list.get_separator() + "', each " +
             in_plain_words(list.get_base_pattern());
    }

    std::string in_plain_words(const dealii::Patterns::PatternBase &pattern)
    {
      namespace Patterns = dealii::Patterns;
      if (dynamic_cast<const Patterns::Double *>(&pattern) != nullptr)
        return range_in_plain_words("a number", pattern.description());
      if (dynamic_cast<const Patterns::Integer *>(&pattern) != nullptr)
        return range_in_plain_words("an integer", pattern.description());
      if (dynamic_cast<const Patterns::Bool *>(&pattern) != nullptr)
        return "true or false";
      if (dynamic_cast<const Patterns::Selection *>(&pattern) != nullptr)
        return selection_in_plain_words(pattern.description());
      if (const auto *list = dynamic_cast<const Patterns::List *>(&pattern))
        return list_in_plain_words(*list);
      if (const auto *map = dynamic_cast<const Patterns::Map *>(&pattern))
        return "a list of key:value pairs separated by '" + map->get_separator() + "', each key " +
               in_plain_words(map->get_key_pattern()) + ", each value " +
               in_plain_words(map->get_value_pattern());
      if (dynamic_cast<const Patterns::Anything *>(&pattern) != nullptr)
        return "any text";
      if (dynamic_cast<const Patterns::FileName *>(&pattern) != nullptr)
        return "the name of a file";
      if (dynamic_cast<const Patterns::DirectoryName *>(&pattern) != nullptr)
        return "the name of a folder";
      return pattern.description(Patterns::PatternBase::Text);
    }

    /// From deal.II's description of a pattern. Lists of lists are told from their text: made a pattern
    /// again, deal.II 9.4 mistakes the inner list's separator and length for the outer one's.
    std::string in_plain_words(const std::string &description)
    {
      if (description.rfind("[List of <[List", 0) == 0)
        return "a list separated by ';', each item a list separated by ','";
      return in_plain_words(*dealii::Patterns::pattern_factory(description));
    }

    ParameterEntry
    to_entry(const Names &sections, const std::string &name, const nlohmann::ordered_json &node)
    {
      ParameterEntry entry{sections, name, "", "", "", "", ""};
      if (node.contains("alias") && node["alias"].is_string())
      {
        entry.alias_of = node["alias"];
        return entry;
      }
      entry.value         = node["value"];
      entry.default_value = node["default_value"];
      entry.documentation = node["documentation"];
      entry.allowed       = in_plain_words(node["pattern_description"].get<std::string>());
      return entry;
    }

    /// A node with a value or an alias is an entry, every other one a section; these two may themselves be
    /// names.
    void collect(const nlohmann::ordered_json &tree, Names &sections, std::vector<ParameterEntry> &entries)
    {
      for (const auto &[name, node] : tree.items())
        if ((node.contains("value") && node["value"].is_string()) ||
            (node.contains("alias") && node["alias"].is_string()))
          entries.push_back(to_entry(sections, name, node));
        else if (node.is_object())
        {
          sections.push_back(name);
          collect(node, sections, entries);
          sections.pop_back();
        }
    }

    /// Comment lines of at most 100 characters.
    void print_comment(std::ostream &out, const std::string &indent, const std::string &text)
    {
      for (const std::string &line : dealii::Utilities::break_text_into_lines(text, 98 - indent.size()))
        out << indent << "# " << line << '\n';
    }

    void print_entry(std::ostream &out, const std::string &indent, const ParameterEntry &entry)
    {
      print_comment(out, indent, entry.documentation);
      print_comment(out,
                    indent,
                    "Allowed: " + entry.allowed +
                      ". Default: " + (entry.default_value.empty() ? "(empty)" : entry.default_value));
      out << indent << "set " << entry.name << (entry.value.empty() ? " =" : " = ") << entry.value << '\n';
    }
  } // namespace

  std::string parameter_path(const std::vector<std::string> &sections, const std::string &name)
  {
    std::string path;
    for (const std::string &section : sections)
      path += section + "/";
    if (name.empty() && !path.empty())
      path.pop_back();
    return path + name;
  }

  std::string ParameterEntry::path() const
  {
    return parameter_path(sections, name);
  }

  std::vector<ParameterEntry> declared_parameters(const dealii::ParameterHandler &prm)
  {
    std::ostringstream text;
    prm.print_parameters(text,
                         static_cast<dealii::ParameterHandler::OutputStyle>(
                           dealii::ParameterHandler::JSON | dealii::ParameterHandler::KeepDeclarationOrder));
    std::vector<ParameterEntry> entries;
    Names                       sections;
    collect(nlohmann::ordered_json::parse(text.str()), sections, entries);
    return entries;
  }

  void print_parameters(const dealii::ParameterHandler &prm, std::ostream &out)
  {
    Names       open;
    const char *gap = "";
    for (const ParameterEntry &entry : declared_parameters(prm))
    {
      if (!entry.alias_of.empty())
        continue;
      const auto common =
        std::mismatch(open.begin(), open.end(), entry.sections.begin(), entry.sections.end());
      for (auto depth = open.end() - common.first; depth > 0; --depth)
      {
        open.pop_back();
        out << std::string(2 * open.size(), ' ') << "end\n";
      }
      out << std::exchange(gap, "\n");
      for (auto section = common.second; section != entry.sections.end(); ++section)
      {
        out << std::string(2 * open.size(), ' ') << "subsection " << *section << '\n';
        open.push_back(*section);
      }
      print_entry(out, std::string(2 * open.size(), ' '), entry);
    }
    for (; !open.empty(); open.pop_back())
      out << std::string(2 * (open.size() - 1), ' ') << "end\n";
  }
} // namespace retroforge
