// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a process killed at any moment, while it starts, writes or finishes a record, leaves one that can
// be read and holds all increments it had reported as written.
#include "record_test_tools.h"

#include <chrono>
#include <csignal>

#include <sys/wait.h>
#include <unistd.h>

using namespace retroforge;

/// Forever: runs of 15 increments. Tells through the pipe how many increments of which run are written.
void write_runs(const std::string &folder, const RecordHeader &header, const int pipe)
{
  const auto tell = [pipe](const unsigned char n) { return ::write(pipe, &n, 1) == 1; };
  while (true)
  {
    if (!tell(255)) // from here on the old record may vanish
      return;
    RecordWriter writer(folder, header);
    tell(0);
    for (unsigned char i = 0; i < 15; ++i)
    {
      writer.write(sample_increment(header, i));
      tell(i + 1);
    }
    writer.finish();
  }
}

/// Duration of one run, start to finish [microseconds].
unsigned int time_of_run(const std::string &folder, const RecordHeader &header)
{
  const auto   start = std::chrono::steady_clock::now();
  RecordWriter writer(folder, header);
  for (unsigned int i = 0; i < 15; ++i)
    writer.write(sample_increment(header, i));
  writer.finish();
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start)
    .count();
}

/// Number of increments the child had written, 255 if it was starting.
unsigned int
kill_after(const unsigned int microseconds, const std::string &folder, const RecordHeader &header)
{
  int ends[2];
  if (pipe(ends) != 0)
    std::abort();
  const pid_t child = fork();
  if (child == 0)
  {
    write_runs(folder, header, ends[1]);
    _exit(0);
  }
  close(ends[1]);
  unsigned char last = 255, word = 255;
  do // the clock starts with the record
    if (read(ends[0], &last, 1) != 1)
      std::abort();
  while (last != 0);
  usleep(microseconds);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  while (read(ends[0], &word, 1) == 1)
    last = word;
  close(ends[0]);
  return last;
}

/// Whether all that the child had written is there, and to the bit.
bool survived(const std::string &folder, const RecordHeader &header, const unsigned int n_told)
{
  const RecordReader reader(folder);
  bool               good = same(reader.header(), header) && reader.n_increments() >= n_told;
  for (unsigned int i = 0; good && i < reader.n_increments(); ++i)
    good = same(reader.read(i), sample_increment(header, i));
  return good;
}

int main()
{
  const std::string  folder = fresh_folder("killed_run_data");
  const RecordHeader header = sample_header(brick(4, 4, 5));
  std::mt19937       random(7);
  const unsigned int period = time_of_run(folder, header);
  unsigned int       n_good = 0, n_resumed = 0;
  for (unsigned int attempt = 0; attempt < 40; ++attempt)
  {
    const unsigned int told = kill_after(random() % (period + period / 4), folder, header);
    try
    {
      n_good += survived(folder, header, told == 255 ? 0 : told);
      if (!RecordReader(folder).finished())
      {
        RecordWriter writer = RecordWriter::resume(folder);
        writer.write(sample_increment(header, writer.n_increments()));
        writer.finish();
      }
      n_resumed += survived(folder, header, 0);
    }
    catch (const Error &error)
    {
      const bool was_starting = told == 255; // the old record is gone, the new one not yet there
      n_good += was_starting;
      n_resumed += was_starting;
      if (!was_starting)
        std::cout << error.what() << '\n';
    }
  }
  std::cout << "readable with all that was written: " << n_good << " of 40\n"
            << "resumed or finished: " << n_resumed << " of 40\n";
}
