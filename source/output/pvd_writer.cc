// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/output/pvd_writer.h>
#include <retroforge/output/safe_file.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <algorithm>
#include <limits>
#include <sstream>

namespace retroforge
{
  namespace
  {
    [[noreturn]] void throw_not_a_series(const std::string &file, const std::string &reason)
    {
      throw Error(file,
                  "is not a time series: " + reason,
                  "a run goes on with the .pvd file it wrote",
                  "remove it and start the run anew, without --resume");
    }

    /// How deep elements may stand in each other at most: opening tags that are not closed so far. The XML
    /// reader calls itself for each.
    std::size_t nesting_bound(const std::string &xml)
    {
      std::size_t depth = 0, deepest = 0;
      for (std::size_t i = 0; i + 1 < xml.size(); ++i)
      {
        const char a = xml[i], b = xml[i + 1];
        if (a == '<' && b != '/')
          deepest = std::max(deepest, ++depth);
        else if (depth > 0 && ((a == '<' && b == '/') || (b == '>' && (a == '/' || a == '?'))))
          --depth;
      }
      return deepest;
    }
  } // namespace

  PvdWriter::PvdWriter(const std::string &file) : file_(file) {}

  PvdWriter PvdWriter::continue_after(const std::string &file, const double last_time)
  {
    PvdWriter series(file);
    try
    {
      const std::string contents = read_file(file);
      if (nesting_bound(contents) > 100)
        throw_not_a_series(file, "its elements are nested too deep");
      std::istringstream          in(contents);
      boost::property_tree::ptree tree;
      boost::property_tree::read_xml(in, tree);
      for (const auto &[tag, node] : tree.get_child("VTKFile.Collection"))
        if (tag == "DataSet" && node.get<double>("<xmlattr>.timestep") <= last_time)
          series.steps_.emplace_back(node.get<double>("<xmlattr>.timestep"),
                                     node.get<std::string>("<xmlattr>.file"));
    }
    catch (const boost::property_tree::ptree_error &error)
    {
      throw_not_a_series(file, error.what());
    }
    return series;
  }

  void PvdWriter::add(const double time, const std::string &vtu_file)
  {
    steps_.emplace_back(time, vtu_file);
    write();
  }

  void PvdWriter::write() const
  {
    boost::property_tree::ptree tree;
    tree.put("VTKFile.<xmlattr>.type", "Collection");
    tree.put("VTKFile.<xmlattr>.version", "0.1");
    boost::property_tree::ptree &collection = tree.put("VTKFile.Collection", "");
    for (const auto &[time, vtu_file] : steps_)
    {
      boost::property_tree::ptree &step = collection.add("DataSet", "");
      step.put("<xmlattr>.timestep", time); // all digits: reads back to the same bits
      step.put("<xmlattr>.file", vtu_file);
    }
    std::ostringstream out;
    boost::property_tree::write_xml(
      out, tree, boost::property_tree::xml_writer_make_settings<std::string>(' ', 1));
    write_file(file_, out.str());
  }
} // namespace retroforge
