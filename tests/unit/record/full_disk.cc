// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: when the disk fills up, here a limit on the size of files, writing fails with an Error wherever in
// the file it happens, leaves nothing behind, harms no earlier increment, and succeeds once there is space.
#include "record_test_tools.h"

#include <csignal>

#include <sys/resource.h>

using namespace retroforge;

template <typename Action>
bool fails_within(const rlim_t limit, const Action &action, std::string &message)
{
  rlimit old;
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit low{limit, old.rlim_max};
  bool         failed = false;
  setrlimit(RLIMIT_FSIZE, &low);
  try
  {
    action();
  }
  catch (const Error &error)
  {
    failed  = true;
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &old);
  return failed;
}

bool intact(const std::string &folder, const RecordHeader &header, const unsigned int n)
{
  const RecordReader reader(folder);
  bool               good = reader.n_increments() == n && same(reader.header(), header);
  for (unsigned int i = 0; good && i < n; ++i)
    good = same(reader.read(i), sample_increment(header, i));
  for (const auto &entry : std::filesystem::recursive_directory_iterator(folder))
    good = good && entry.path().extension() != ".tmp";
  return good;
}

int main()
{
  signal(SIGXFSZ, SIG_IGN);
  const std::string  folder = fresh_folder("full_disk_run");
  const RecordHeader header = sample_header(brick(3, 3, 4));
  std::string        message;
  RecordWriter       writer(folder, header);
  writer.write(sample_increment(header, 0));
  const rlim_t size = std::filesystem::file_size(folder + "/record/increment_000000.h5");

  unsigned int n = 0, n_failed = 0, n_intact = 0;
  for (rlim_t limit = 0; limit < size; limit += 61, ++n)
  {
    n_failed += fails_within(
      limit, [&]() { writer.write(sample_increment(header, 1)); }, message);
    n_intact += intact(folder, header, 1);
  }
  std::cout << message << '\n';
  std::cout << "increment: every limit fails " << yes(n_failed == n) << ", record intact "
            << yes(n_intact == n) << '\n';
  for (unsigned int i = 1; i < 12; ++i)
    writer.write(sample_increment(header, i));
  std::cout << "with space again: " << yes(intact(folder, header, 12)) << '\n';

  n = n_failed = n_intact = 0;
  for (rlim_t limit = 0; limit < 11 * size; limit += 997, ++n)
  {
    n_failed += fails_within(
      limit, [&]() { writer.finish(); }, message);
    n_intact += intact(folder, header, 12);
    if (!std::filesystem::exists(folder + "/record"))
      break;
  }
  std::cout << message << '\n';
  std::cout << "finish: every limit fails until it fits " << yes(n_failed == n) << ", record intact "
            << yes(n_intact >= n) << ", limits tried: many " << yes(n > 30) << '\n';
  if (std::filesystem::exists(folder + "/record"))
    writer.finish();
  std::cout << "finished with space: " << yes(intact(folder, header, 12) && RecordReader(folder).finished())
            << '\n';
}
