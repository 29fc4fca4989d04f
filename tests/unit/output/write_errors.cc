// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: every writer reports a full disk and a folder that does not exist with file, reason and remedy; and
// a write that fails leaves the old file as it was.
#include <retroforge/core/error.h>
#include <retroforge/output/field_file.h>
#include <retroforge/output/history.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/summary.h>

#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <iostream>

using namespace retroforge;

template <typename Action>
void show(const Action &action)
{
  try
  {
    action();
    std::cout << "no error\n";
  }
  catch (const Error &error)
  {
    std::cout << error.what() << '\n';
  }
}

void all_writers(const std::string &file)
{
  TetMesh mesh;
  mesh.X     = {Vec3({0., 0., 0.}), Vec3({1., 0., 0.}), Vec3({0., 1., 0.}), Vec3({0., 0., 1.})};
  mesh.cells = {{{0, 1, 2, 3}}};
  show([&] { FieldFile<3>(mesh.X, mesh.cells).write(file); });
  show([&] { History history(file); });
  show([&] { Summary().write(file); });
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  all_writers("/dev/full");
  std::cout << "the device is still one: " << std::filesystem::is_character_file("/dev/full") << '\n';
  all_writers("nowhere/file");
  write_file("plain_file", "old");
  all_writers("plain_file/file");
  show([] { check_writable("plain_file/file"); });
  show([] { check_writable("nowhere/file"); });
  std::filesystem::create_directory("a_folder");
  show([] { check_writable("a_folder"); });
  show([] { check_writable("plain_file"); });
  std::cout << "left as it was: " << read_file("plain_file") << '\n';
  show([] { make_directory("plain_file/folder"); });
  show([] { make_directory("made/folder"); });
  show([] { read_file("nowhere/file"); });

  // a disk that fills up while the file is written: no file may grow beyond 1000 bytes
  std::signal(SIGXFSZ, SIG_IGN);
  std::cout.flush();
  rlimit limit;
  getrlimit(RLIMIT_FSIZE, &limit);
  const rlimit small{1000, limit.rlim_max};
  std::string  message;
  setrlimit(RLIMIT_FSIZE, &small);
  try
  {
    write_file("plain_file", std::string(5000, 'x'));
  }
  catch (const Error &error)
  {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::cout << message << '\n'
            << "old contents: " << read_file("plain_file")
            << ", temporary file is left: " << std::filesystem::exists("plain_file.tmp") << '\n';
}
