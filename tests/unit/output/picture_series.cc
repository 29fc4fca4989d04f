// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// The list of a run's pictures.
// - By hand: three times, of which the last is added twice; times are told exactly.
// - It grows in its place: a link to the file sees what is added.
// - Where somebody removed it or wrote to it, it is written anew.
// - Where the disk is full the old list stays, and one hears of it.
#include <retroforge/core/error.h>
#include <retroforge/output/picture_series.h>
#include <retroforge/output/safe_file.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iostream>

using namespace retroforge;

const std::string list_file = "list.pvd", link_to_it = "link.pvd";

void add_billet(PictureSeries &series)
{
  series.add(0., {"fields_000000.vtu", "die_lower.vtu"});
}

void add_first(PictureSeries &series)
{
  series.add(1. / 3., {"fields_000001.vtu", "die_lower.vtu"});
}

void by_hand()
{
  PictureSeries series(list_file);
  std::cout << "nothing is written before: " << !std::filesystem::exists(list_file) << series.empty()
            << std::endl;
  add_billet(series);
  std::filesystem::create_hard_link(list_file, link_to_it);
  std::cout << read_file(list_file);
  add_first(series);
  std::cout << read_file(list_file) << "in its place: " << (read_file(link_to_it) == read_file(list_file))
            << std::endl;
  series.add(0.5, {"fields_000002.vtu", "die_lower.vtu"});
  series.add(0.5, {"failed.vtu"});
  std::cout << read_file(list_file);
}

void changed_by_others()
{
  PictureSeries series(list_file);
  add_billet(series);
  std::ofstream(list_file, std::ios::app) << "<!-- mine -->";
  add_first(series);
  const std::string both = read_file(list_file);
  std::filesystem::remove(list_file);
  series.add(0.5, {"last.vtu"});
  std::cout << "changed: " << (both.find("mine") == std::string::npos)
            << ", removed: " << (read_file(list_file).size() > both.size()) << std::endl;
}

/// No file may grow beyond 1000 bytes.
void full_disk()
{
  PictureSeries series(list_file);
  add_billet(series);
  const std::string before = read_file(list_file);
  std::string       message;
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{1000, limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  try
  {
    series.add(1., {std::string(1000, 'x')});
  }
  catch (const Error &error)
  {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::cout << message << "\nthe old list: " << (read_file(list_file) == before) << std::endl;
}

int main()
{
  std::filesystem::remove(list_file);
  std::filesystem::remove(link_to_it);
  by_hand();
  changed_by_others();
  full_disk();
}
