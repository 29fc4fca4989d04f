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
