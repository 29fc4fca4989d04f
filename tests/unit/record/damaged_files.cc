// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a record that was cut off or changed, be it in one bit, is refused with an Error, or what is read
// from it is what was written (where the damage is in unused bytes). Nothing crashes, hangs or reads wrong
// numbers.
#include "record_test_tools.h"

#include <unistd.h>

using namespace retroforge;

const RecordHeader header = sample_header(brick(3, 3, 4));

enum Outcome
{
  refused,
  unharmed,
  wrong
};

Outcome read_all(const std::string &folder)
{
  try
  {
    const RecordReader reader(folder);
    bool               equal = same(reader.header(), header) && reader.n_increments() == 4;
    for (unsigned int i = 0; equal && i < reader.n_increments(); ++i)
      equal = same(reader.read(i), sample_increment(header, i));
    return equal ? unharmed : wrong;
  }
  catch (const Error &)
  {
    return refused;
  }
}

std::string mutate(std::string bytes, const unsigned int kind, std::mt19937 &random)
{
  const std::size_t place = random() % bytes.size();
  if (kind == 0) // one bit
    bytes[place] ^= 1 << random() % 8;
  else if (kind == 1) // one byte, at least one bit of it
    bytes[place] ^= 1 + random() % 255;
  else if (kind == 2) // a block that never reached the disk
    bytes.replace(place,
                  std::min<std::size_t>(512, bytes.size() - place),
                  std::min<std::size_t>(512, bytes.size() - place),
                  '\0');
  else // noise
    for (std::size_t i = place; i < std::min(place + 64, bytes.size()); ++i)
      bytes[i] = random();
  return bytes;
}

void try_file(const std::string &folder, const std::string &file)
{
  const std::string whole = bytes_of(file);
  std::mt19937      random(3);
  unsigned int      cut[3] = {0, 0, 0}, changed[3] = {0, 0, 0};
  for (unsigned int i = 0; i < 50; ++i)
  {
    write_bytes(file, whole.substr(0, i == 0 ? 0 : random() % whole.size()));
    ++cut[read_all(folder)];
  }
  for (unsigned int i = 0; i < 400; ++i)
  {
    write_bytes(file, mutate(whole, i % 4, random));
    ++changed[read_all(folder)];
  }
  write_bytes(file, whole);
  std::cout << "  cut: refused " << cut[refused] << " of 50\n"
            << "  changed: refused or harmless " << changed[refused] + changed[unharmed]
            << " of 400, most refused: " << yes(changed[refused] > 300) << ", wrong " << changed[wrong]
            << '\n';
}

int main()
{
  alarm(300); // should it hang
  const std::string folder = fresh_folder("damaged_run");
  RecordWriter      writer(folder, header);
  for (unsigned int i = 0; i < 4; ++i)
    writer.write(sample_increment(header, i));
  std::cout << "header\n";
  try_file(folder, folder + "/record/header.h5");
  std::cout << "increment\n";
  try_file(folder, folder + "/record/increment_000002.h5");
  writer.finish();
  std::cout << "finished record\n";
  try_file(folder, folder + "/record.h5");
}
