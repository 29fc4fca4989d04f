// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/pvd_writer.h>
#include <retroforge/output/safe_file.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <sstream>

namespace retroforge
{
  PvdWriter::PvdWriter(const std::string &file) : file_(file) {}

  void PvdWriter::add(const double time, const std::vector<Part> &parts)
  {
    if (!steps_.empty() && steps_.back().time == time)
      steps_.pop_back();
    steps_.push_back({time, parts});
    write();
  }

  void PvdWriter::write() const
  {
    boost::property_tree::ptree tree;
    tree.put("VTKFile.<xmlattr>.type", "Collection");
    tree.put("VTKFile.<xmlattr>.version", "0.1");
    boost::property_tree::ptree &collection = tree.put("VTKFile.Collection", "");
    for (const Step &step : steps_)
      for (std::size_t p = 0; p < step.parts.size(); ++p)
      {
        boost::property_tree::ptree &part = collection.add("DataSet", "");
        part.put("<xmlattr>.timestep", step.time); // all digits: reads back to the same bits
        part.put("<xmlattr>.part", p);
        part.put("<xmlattr>.name", step.parts[p].name);
        part.put("<xmlattr>.file", step.parts[p].file);
      }
    std::ostringstream out;
    boost::property_tree::write_xml(
      out, tree, boost::property_tree::xml_writer_make_settings<std::string>(' ', 1));
    write_file(file_, out.str());
  }
} // namespace retroforge
