// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/parameter_input.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <ostream>
#include <set>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Names = std::vector<std::string>;

    std::string path_of(const Names &sections, const std::string &name = "")
    {
      std::string path;
      for (const std::string &section : sections)
        path += section + "/";
      if (name.empty() && !path.empty())
        path.pop_back();
      return path + name;
    }

    // --- what is declared
    // -------------------------------------------------------------------------------------

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
      entry.allowed       = in_plain_words(*dealii::Patterns::pattern_factory(node["pattern_description"]));
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

    /// The declared entries and sections by their full path.
    class KnownParameters
    {
    public:
      explicit KnownParameters(const dealii::ParameterHandler &prm)
      {
        for (ParameterEntry &entry : declared_parameters(prm))
        {
          paths_.push_back(entry.path());
          for (Names sections = entry.sections; !sections.empty(); sections.pop_back())
            if (const std::string path = path_of(sections);
                std::find(sections_.begin(), sections_.end(), path) == sections_.end())
              sections_.push_back(path);
          entries_.emplace(entry.path(), std::move(entry));
        }
      }

      bool has_section(const std::string &path) const
      {
        return std::find(sections_.begin(), sections_.end(), path) != sections_.end();
      }

      /// The entry of this path; an old name leads to the present one.
      /// @throws Error if there is none
      const ParameterEntry &entry(const std::string &path, const std::string &where) const
      {
        const auto found = entries_.find(path);
        if (found == entries_.end())
          throw_unknown("parameter", path, where, paths_);
        const ParameterEntry &entry = found->second;
        return entry.alias_of.empty() ? entry : entries_.at(path_of(entry.sections, entry.alias_of));
      }

      void check_section(const std::string &path, const std::string &where) const
      {
        if (!has_section(path))
          throw_unknown("subsection", path, where, sections_);
      }

    private:
      Names                                 paths_, sections_;
      std::map<std::string, ParameterEntry> entries_;

      static std::string last_part(const std::string &path) { return path.substr(path.rfind('/') + 1); }
      static std::string all_but_last_part(const std::string &path)
      {
        return path.substr(0, path.rfind('/') == std::string::npos ? 0 : path.rfind('/'));
      }

      /// Names directly inside the section that `path` is said to be in.
      static std::string siblings(const std::string &path, const Names &known)
      {
        Names names;
        for (const std::string &candidate : known)
          if (all_but_last_part(candidate) == all_but_last_part(path))
            names.push_back(last_part(candidate));
        return join(names);
      }

      static std::string suggestion(const std::string &path, const Names &known)
      {
        const std::string name  = last_part(path);
        std::string       meant = nearest_name(path, known, tolerated_edits(name));
        for (const std::string &candidate : known)
          if (meant.empty() && edit_distance(name, last_part(candidate)) == 0) // right name, wrong section
            meant = candidate;
        return meant;
      }

      [[noreturn]] static void throw_unknown(const std::string &kind,
                                             const std::string &path,
                                             const std::string &where,
                                             const Names       &known)
      {
        const std::string section = all_but_last_part(path), names = siblings(path, known),
                          meant = suggestion(path, known);
        const std::string place = section.empty() ? "at the top level" : "in '" + section + "'";
        throw Error(where,
                    "unknown " + kind + " '" + path + "'",
                    names.empty() ? "there is no " + kind + " " + place : "known " + place + ": " + names,
                    meant.empty() ? "retroforge --print-parameters lists all"
                                  : "did you mean '" + meant + "'?");
      }
    };

    // --- what the file says
    // -----------------------------------------------------------------------------------

    struct Assignment
    {
      std::string where;
      std::string path;
      std::string value;
    };

    /// Blanks and tabs at the ends removed, those inside made single.
    std::string single_spaced(const std::string &text)
    {
      std::istringstream words(text);
      std::string        word, result;
      while (words >> word)
        result += (result.empty() ? "" : " ") + word;
      return result;
    }

    /// Reads parameter files line by line; knows in which section it is.
    class FileReader
    {
    public:
      explicit FileReader(const KnownParameters &known) : known_(known) {}

      void read(const std::string &file)
      {
        std::ifstream in = open(file);

        const std::size_t                   outer_depth = open_sections_.size();
        std::map<std::string, unsigned int> line_of; // parameters this file sets

        std::swap(line_of, line_of_);
        std::string  line;
        unsigned int number = 0;
        while (next_line(in, line, number))
          interpret(file, number, line, outer_depth);
        if (open_sections_.size() > outer_depth)
          throw Error(open_sections_.back().where,
                      "subsection '" + path_of(sections()) + "' is not closed",
                      "each 'subsection' needs its 'end'",
                      "add 'end' after the last parameter of the subsection");
        std::swap(line_of, line_of_);
      }

      const std::vector<Assignment> &assignments() const { return assignments_; }

    private:
      struct OpenSection
      {
        std::string name, where;
      };

      const KnownParameters              &known_;
      std::vector<OpenSection>            open_sections_;
      std::vector<Assignment>             assignments_;
      std::map<std::string, unsigned int> line_of_;
      unsigned int                        include_depth_ = 0;

      Names sections() const
      {
        Names names;
        for (const OpenSection &section : open_sections_)
          names.push_back(section.name);
        return names;
      }

      static std::ifstream open(const std::string &file)
      {
        const std::string rule   = "parameters are read from a text file",
                          remedy = "check its name and permissions";
        if (std::filesystem::is_directory(file))
          throw Error(file, "is a folder", rule, "name a file in it");
        errno = 0;
        std::ifstream in(file);
        if (!in)
          throw Error(file, std::string("cannot be opened: ") + std::strerror(errno), rule, remedy);
        return in;
      }

      /// The next line that says something: continued lines joined, comments removed. `number` is that of its
      /// end.
      static bool next_line(std::istream &in, std::string &line, unsigned int &number)
      {
        std::string part;
        line.clear();
        while (std::getline(in, part))
        {
          ++number;
          part                 = part.substr(0, part.find('#'));
          const bool continued = !part.empty() && part.find_last_not_of(" \t\r") != std::string::npos &&
                                 part[part.find_last_not_of(" \t\r")] == '\\';
          if (continued)
            part.erase(part.find_last_not_of(" \t\r"));
          line += part;
          if (continued)
            continue;
          line = single_spaced(line);
          if (!line.empty())
            return true;
        }
        line = single_spaced(line);
        return !line.empty();
      }

      void interpret(const std::string &file,
                     const unsigned int number,
                     const std::string &line,
                     const std::size_t  outer_depth)
      {
        const std::string where   = file + ", line " + std::to_string(number);
        const std::size_t space   = line.find(' ');
        const std::string keyword = line.substr(0, space);
        const std::string rest    = space == std::string::npos ? "" : line.substr(space + 1);
        if (keyword == "set" || keyword == "SET")
          interpret_set(where, number, rest);
        else if (keyword == "subsection" || keyword == "SUBSECTION")
          interpret_subsection(where, rest);
        else if (line == "end" || line == "END")
          interpret_end(where, outer_depth);
        else if (keyword == "include" || keyword == "INCLUDE")
          interpret_include(where, file, rest);
        else
          throw Error(where,
                      "'" + line + "' is not understood",
                      "a line is 'subsection NAME', 'set NAME = VALUE', 'end' or 'include FILE'",
                      "put '#' before comments and '\\' at the end of a line that goes on");
      }

      void interpret_set(const std::string &where, const unsigned int number, const std::string &text)
      {
        const std::size_t equals = text.find('=');
        const std::string name   = single_spaced(text.substr(0, equals));
        if (equals == std::string::npos || name.empty())
          throw Error(where,
                      "'set " + text + "' is not an assignment",
                      "it must read 'set NAME = VALUE'",
                      "write name, '=' and value on one line");
        const std::string path     = known_.entry(path_of(sections(), name), where).path();
        const auto [first, is_new] = line_of_.emplace(path, number);
        if (!is_new)
          throw Error(where,
                      path + " is set again",
                      "line " + std::to_string(first->second) + " sets it already",
                      "keep one of the two lines");
        assignments_.push_back({where, path, single_spaced(text.substr(equals + 1))});
      }

      void interpret_subsection(const std::string &where, const std::string &name)
      {
        if (name.empty())
          throw Error(where, "'subsection' has no name", "it must read 'subsection NAME'", "add the name");
        open_sections_.push_back({name, where});
        known_.check_section(path_of(sections()), where);
      }

      void interpret_end(const std::string &where, const std::size_t outer_depth)
      {
        if (open_sections_.size() == outer_depth)
          throw Error(where,
                      "'end' closes no subsection",
                      "each 'end' needs its 'subsection' before it, in the same file",
                      "remove it, or look for an earlier 'end' too many");
        open_sections_.pop_back();
      }

      void interpret_include(const std::string &where, const std::string &file, const std::string &name)
      {
        const std::filesystem::path included = std::filesystem::path(file).parent_path() / name;
        if (name.empty() || !std::filesystem::is_regular_file(included))
          throw Error(where,
                      "'" + included.string() + "' is not a file",
                      "'include' is followed by the name of a parameter file",
                      "give its name relative to the file that includes it");
        if (++include_depth_ > 20)
          throw Error(
            where, "include files nest more than 20 deep", "no file may include itself", "remove the cycle");
        read(included.string());
        --include_depth_;
      }
    };

    // --- putting both together
    // --------------------------------------------------------------------------------

    void assign(dealii::ParameterHandler &prm, const KnownParameters &known, const Assignment &assignment)
    {
      const ParameterEntry &entry = known.entry(assignment.path, assignment.where);
      for (const std::string &section : entry.sections)
        prm.enter_subsection(section);
      std::string problem;
      try
      {
        prm.set(entry.name, assignment.value);
      }
      catch (const dealii::ExceptionBase &)
      {
        problem = assignment.value.empty() ? "empty" : "'" + assignment.value + "'";
      }
      for (std::size_t i = 0; i < entry.sections.size(); ++i)
        prm.leave_subsection();
      if (!problem.empty())
        throw Error(assignment.where,
                    entry.path() + " is " + problem,
                    "it must be " + entry.allowed,
                    "correct the value (default: " + entry.default_value +
                      "; meaning: " + entry.documentation + ")");
    }

    /// deal.II writes every character but letters and digits of a name as `_` and two hexadecimal digits, and
    /// separates the sections by '.'.
    std::string readable_path(const std::string &mangled)
    {
      std::string path;
      for (std::size_t i = 0; i < mangled.size(); ++i)
        if (mangled[i] == '_' && i + 2 < mangled.size())
        {
          path += static_cast<char>(std::stoi(mangled.substr(i + 1, 2), nullptr, 16));
          i += 2;
        }
        else
          path += mangled[i] == '.' ? '/' : mangled[i];
      return path;
    }

    void
    check_required(const dealii::ParameterHandler &prm, const KnownParameters &known, const std::string &file)
    {
      const std::set<std::string> missing = prm.get_entries_wrongly_not_set();
      if (missing.empty())
        return;
      const ParameterEntry &entry = known.entry(readable_path(*missing.begin()), file);
      throw Error(file,
                  entry.path() + " is not set",
                  "it has no default and must be " + entry.allowed,
                  "set it (meaning: " + entry.documentation + ")");
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

  std::string ParameterEntry::path() const
  {
    return path_of(sections, name);
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

  void read_parameters(dealii::ParameterHandler                               &prm,
                       const std::string                                      &file,
                       const std::vector<std::pair<std::string, std::string>> &overrides)
  {
    const KnownParameters known(prm);
    FileReader            reader(known);
    reader.read(file);

    std::vector<Assignment> assignments = reader.assignments();
    for (const auto &[path, value] : overrides)
    {
      const std::string where = "--set " + path + "=" + value;
      assignments.push_back({where, known.entry(single_spaced(path), where).path(), single_spaced(value)});
    }
    for (const Assignment &assignment : assignments)
      assign(prm, known, assignment);
    check_required(prm, known, file);
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
      out << '\n';
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
