// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/output/pvd_writer.h>
#include <retroforge/output/safe_file.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <limits>
#include <sstream>

namespace retroforge
{
  PvdWriter::PvdWriter(const std::string &file) : file_(file) {}

  PvdWriter PvdWriter::continue_after(const std::string &file, const double last_time)
  {
    PvdWriter series(file);
    try
    {
      std::istringstream          in(read_file(file));
      boost::property_tree::ptree tree;
      boost::property_tree::read_xml(in, tree);
      for (const auto &[tag, node] : tree.get_child("VTKFile.Collection"))
        if (tag == "DataSet" && node.get<double>("<xmlattr>.timestep") <= last_time)
          series.steps_.emplace_back(node.get<double>("<xmlattr>.timestep"),
                                     node.get<std::string>("<xmlattr>.file"));
    }
    catch (const boost::property_tree::ptree_error &error)
    {
      throw Error(file,
                  std::string("is not a time series: ") + error.what(),
                  "a run goes on with the .pvd file it wrote",
                  "remove it and start the run anew, without --resume");
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
