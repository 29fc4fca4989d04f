// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/known_parameters.h>
#include <retroforge/core/parameter_input.h>
#include <retroforge/core/parameter_list.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
    /// Lists are taken apart in a time that grows with the square of their length.
    constexpr std::size_t longest_line = 100000;
    /// Of subsections, and of files that include each other.
    constexpr unsigned int deepest = 20;

    using Names = std::vector<std::string>;

    /// Blanks and tabs at the ends removed, those inside made single.
    std::string single_spaced(const std::string &text)
    {
      std::istringstream words(text);
      std::string        word, result;
      while (words >> word)
        result += (result.empty() ? "" : " ") + word;
      return result;
    }

    /// Values are passed on to formats that know no other text.
    void check_text(const std::string &where, const std::string &text)
    {
      if (text.size() > longest_line)
        throw Error(where,
                    "is too long",
                    "a line, with those that continue it, has at most " + std::to_string(longest_line) +
                      " characters",
                    "write a shorter value; in a file, see which lines end with '\\'");
      if (!is_plain_text(text))
        throw Error(where,
                    "'" + legible(text) + "' holds bytes that are no text",
                    "parameters are UTF-8 text without control characters",
                    "save the file as UTF-8, or write the line anew");
    }

    /// Lines end with a line feed, and no byte order mark stands before the first.
    std::string with_plain_lines(const std::string &text)
    {
      const std::string mark = "\xef\xbb\xbf";
      std::string       plain;
      for (std::size_t i = text.compare(0, mark.size(), mark) == 0 ? mark.size() : 0; i < text.size(); ++i)
        if (text[i] != '\r')
          plain += text[i];
        else if (i + 1 == text.size() || text[i + 1] != '\n')
          plain += '\n';
      return plain;
    }

    std::string lower_case(std::string word)
    {
      for (char &c : word)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return word;
    }

    std::string text_of(const std::string &file)
    {
      const std::string rule   = "parameters are read from a text file",
                        remedy = "check its name and permissions";
      std::error_code ignored;
      if (std::filesystem::is_directory(file, ignored))
        throw Error(file, "is a folder", rule, "name a file in it");
      if (std::filesystem::is_character_file(file, ignored))
        throw Error(file, "is a device", rule, "name a file");
      errno = 0;
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream text;
      if (!in || (in.peek() != EOF && !(text << in.rdbuf())))
        throw Error(file, std::string("cannot be read: ") + std::strerror(errno), rule, remedy);
      return text.str();
    }

    /// Reads parameter files line by line; knows in which section it is.
    class LineReader
    {
    public:
      std::vector<ParameterLine> lines;

      void read(const std::string &file) { read(file, text_of(file)); }

      void read(const std::string &file, const std::string &text)
      {
        std::istringstream in(with_plain_lines(text));
        const std::size_t  outer_depth = open_sections_.size();
        const unsigned int outer_file  = std::exchange(file_, ++n_files_);
        std::string        line;
        unsigned int       number = 0;
        while (next_line(in, line, number))
          interpret(file, number, line, outer_depth);
        if (open_sections_.size() > outer_depth)
          throw Error(open_sections_.back().where,
                      "subsection '" + parameter_path(sections()) + "' is not closed",
                      "each 'subsection' needs its 'end'",
                      "add 'end' after the last parameter of the subsection");
        file_ = outer_file;
      }

    private:
      struct OpenSection
      {
        std::string name, where;
      };

      std::vector<OpenSection> open_sections_;
      unsigned int             file_ = 0, n_files_ = 0, include_depth_ = 0;

      Names sections() const
      {
        Names names;
        for (const OpenSection &section : open_sections_)
          names.push_back(section.name);
        return names;
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
          const bool continued = !part.empty() && part.find_last_not_of(" \t") != std::string::npos &&
                                 part[part.find_last_not_of(" \t")] == '\\';
          if (continued)
            part.erase(part.find_last_not_of(" \t"));
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
        const std::string where = file + ", line " + std::to_string(number);
        check_text(where, line);
        const std::size_t space   = line.find(' ');
        const std::string keyword = lower_case(line.substr(0, space));
        const std::string rest    = space == std::string::npos ? "" : line.substr(space + 1);
        if (keyword == "set")
          interpret_set(where, number, rest);
        else if (keyword == "subsection")
          interpret_subsection(where, number, rest);
        else if (keyword == "end" && rest.empty())
          interpret_end(where, outer_depth);
        else if (keyword == "include")
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
        lines.push_back(
          {where, parameter_path(sections(), name), single_spaced(text.substr(equals + 1)), file_, number});
      }

      void interpret_subsection(const std::string &where, const unsigned int number, const std::string &name)
      {
        if (name.empty())
          throw Error(where, "'subsection' has no name", "it must read 'subsection NAME'", "add the name");
        if (open_sections_.size() == deepest)
          throw Error(where,
                      "subsections nest more than " + std::to_string(deepest) + " deep",
                      "each 'subsection' needs its 'end'",
                      "add what is missing before this line");
        open_sections_.push_back({name, where});
        lines.push_back({where, parameter_path(sections()), {}, file_, number});
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
        std::error_code             ignored;
        if (name.empty() || !std::filesystem::is_regular_file(included, ignored))
          throw Error(where,
                      "'" + included.string() + "' is not a file",
                      "'include' is followed by the name of a parameter file",
                      "give its name relative to the file that includes it");
        if (++include_depth_ > deepest)
          throw Error(where,
                      "include files nest more than " + std::to_string(deepest) + " deep",
                      "no file may include itself",
                      "remove the cycle");
        read(included.string());
        --include_depth_;
      }
    };

    void check_known(const KnownParameters &known, const std::vector<ParameterLine> &lines)
    {
      std::map<std::pair<unsigned int, std::string>, unsigned int> line_of; // of file and path
      for (const ParameterLine &line : lines)
      {
        if (!line.value)
        {
          known.check_section(line.path, line.where);
          continue;
        }
        const std::string path     = known.entry(line.path, line.where).path();
        const auto [first, is_new] = line_of.emplace(std::make_pair(line.file, path), line.line);
        if (!is_new && line.file > 0)
          throw Error(line.where,
                      path + " is set again",
                      "line " + std::to_string(first->second) + " sets it already",
                      "keep one of the two lines");
      }
    }

    void assign(dealii::ParameterHandler &prm, const KnownParameters &known, const ParameterLine &line)
    {
      const ParameterEntry &entry = known.entry(line.path, line.where);
      for (const std::string &section : entry.sections)
        prm.enter_subsection(section);
      std::string problem;
      try
      {
        prm.set(entry.name, *line.value);
      }
      catch (const dealii::ExceptionBase &)
      {
        problem = line.value->empty() ? "empty" : "'" + *line.value + "'";
      }
      for (std::size_t i = 0; i < entry.sections.size(); ++i)
        prm.leave_subsection();
      if (!problem.empty())
        throw Error(line.where,
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

    void check_required(const dealii::ParameterHandler &prm, const KnownParameters &known)
    {
      const std::set<std::string> missing = prm.get_entries_wrongly_not_set();
      if (missing.empty())
        return;
      const ParameterEntry &entry = known.entry(readable_path(*missing.begin()), "");
      throw Error(entry.path(),
                  "is not set",
                  "it has no default and must be " + entry.allowed,
                  "set it (meaning: " + entry.documentation + ")");
    }

  } // namespace

  std::vector<ParameterLine>
  read_parameter_lines(const std::string                                      &file,
                       const std::vector<std::pair<std::string, std::string>> &overrides)
  {
    LineReader reader;
    reader.read(file);
    const std::vector<ParameterLine> more = override_lines(overrides);
    reader.lines.insert(reader.lines.end(), more.begin(), more.end());
    return reader.lines;
  }

  std::vector<ParameterLine> override_lines(const std::vector<std::pair<std::string, std::string>> &overrides)
  {
    std::vector<ParameterLine> lines;
    for (const auto &[path, value] : overrides)
    {
      const std::string where = "--set " + path + "=" + value;
      check_text(where, path + value);
      lines.push_back({where, single_spaced(path), single_spaced(value)});
    }
    return lines;
  }

  std::vector<ParameterLine> parameter_lines_of(const std::string &text, const std::string &name)
  {
    LineReader reader;
    reader.read(name, text);
    return reader.lines;
  }

  std::map<std::string, std::string> parameter_values(const std::vector<ParameterLine> &lines)
  {
    std::map<std::string, std::string> values;
    for (const ParameterLine &line : lines)
      if (line.value)
        values[line.path] = *line.value;
    return values;
  }

  void set_parameters(dealii::ParameterHandler &prm, const std::vector<ParameterLine> &lines)
  {
    const KnownParameters known(prm);
    check_known(known, lines);
    for (const ParameterLine &line : lines)
      if (line.value)
        assign(prm, known, line);
    check_required(prm, known);
  }

  void read_parameters(dealii::ParameterHandler                               &prm,
                       const std::string                                      &file,
                       const std::vector<std::pair<std::string, std::string>> &overrides)
  {
    set_parameters(prm, read_parameter_lines(file, overrides));
  }

} // namespace retroforge
