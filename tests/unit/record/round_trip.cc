// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: what is written is read to the bit (largest numbers, signed zero, denormals, empty lists included),
// while a run goes on, after resume and after finish, a change of mesh too; and a solve of n nodes costs less
// than 56 n bytes: velocity and pressure are 32 n, the 500 pairs 22 bytes and 1 per solve, so 0.64 plus
// HDF5's own. Increments that are kept in memory are those; where there is room for some of them only, all are
// read from the disk.
#include "record_test_tools.h"
#include <retroforge/record/recording.h>

#include <limits>

using namespace retroforge;

bool reads_back(const std::string                  &path,
                const RecordHeader                 &header,
                const std::vector<IncrementRecord> &increments)
{
  const RecordReader reader(path);
  bool               equal = same(reader.header(), header) && reader.n_increments() == increments.size();
  for (unsigned int i = 0; equal && i < increments.size(); ++i)
    equal = same(reader.read(i), increments[i]);
  return equal;
}

std::vector<IncrementRecord> awkward_increments(const RecordHeader &header)
{
  using limits = std::numeric_limits<double>;
  std::vector<IncrementRecord> increments{sample_increment(header, 0), sample_increment(header, 1, 1)};
  increments.push_back(sample_remeshed(header, 2));
  increments.push_back(sample_increment(header, 3));
  increments[3].pairs.clear();
  for (SolveRecord &solve : increments[3].solves)
    solve.active.clear();
  increments[3].step               = limits::denorm_min();
  increments[3].friction_energy    = -0.;
  increments[3].solves[1].V[5][2]  = limits::max();
  increments[3].solves[1].P.back() = -limits::max();
  increments.push_back(sample_increment(header, 4, 5));
  return increments;
}

/// Pairs of nodes and of edges that are read of an increment.
std::pair<unsigned int, unsigned int> count_points(const std::string &path, const unsigned int i)
{
  std::pair<unsigned int, unsigned int> n;
  for (const ContactPair &pair : RecordReader(path).read(i).pairs)
    ++(pair.point.is_node() ? n.first : n.second);
  return n;
}

void print_size(const std::string  &title,
                const std::uint64_t bytes,
                const unsigned int  n_solves,
                const unsigned int  n_nodes)
{
  std::cout << title << ": " << bytes / (56. * n_solves * n_nodes) << " of 56 bytes per node and solve\n";
}

/// Of increments that are kept, where so many bytes of memory are free. Those in a folder of another name are in
/// memory alone.
bool keeps(const std::string                  &folder,
           const std::size_t                   memory,
           const std::vector<IncrementRecord> &increments)
{
  Recording recording(folder, memory);
  for (const IncrementRecord &increment : increments)
    recording.keep(increment);
  const auto record = recording.access();
  bool       equal  = true;
  for (unsigned int i = increments.size(); i-- > 0;)
    equal = equal && same(record(i), increments[i]);
  return equal;
}

/// Whether increments for which there is too little memory are looked for on the disk, where there are none.
bool leaves_to_the_disk(const std::vector<IncrementRecord> &increments)
{
  try
  {
    keeps("nowhere", 20000, increments);
  }
  catch (const Error &)
  {
    return true;
  }
  return false;
}

int main()
{
  const std::string  folder     = fresh_folder("round_trip_run");
  const RecordHeader header     = sample_header(brick(3, 4, 5), std::string(100000, 'p') + "\n");
  const auto         increments = awkward_increments(header);
  {
    RecordWriter writer(folder, header);
    std::cout << "no increment yet: " << yes(reads_back(folder, header, {})) << '\n';
    for (unsigned int i = 0; i < 3; ++i)
      writer.write(increments[i]);
  }
  std::cout << "three increments: "
            << yes(reads_back(folder, header, {increments.begin(), increments.begin() + 3})) << '\n';
  RecordWriter writer = RecordWriter::resume(folder);
  std::cout << "resumed at " << writer.n_increments() << '\n';
  writer.write(increments[3]);
  writer.write(increments[4]);
  std::cout << "all, going on: " << yes(reads_back(folder, header, increments)) << '\n';
  writer.finish();
  std::cout << "all, finished: " << yes(reads_back(folder, header, increments))
            << ", by file: " << yes(reads_back(folder + "/record.h5", header, increments))
            << ", bytes() is its size: "
            << yes(writer.bytes() == std::filesystem::file_size(folder + "/record.h5"))
            << ", segments gone: " << yes(!std::filesystem::exists(folder + "/record")) << '\n';

  const auto inputs = RecordReader(folder).inputs();
  std::cout << "inputs: " << inputs.size() << ", the second from increment " << inputs[1].first
            << ", its own: " << yes(inputs[1].parameters == increments[1].parameters)
            << "; the record ends at stroke "
            << yes(same_bits(RecordReader(folder).end().second, increments[4].stroke + increments[4].step))
            << '\n';
  RecordWriter::reopen(folder);
  std::cout << "reopened: unfinished " << yes(!RecordReader(folder).finished()) << ", all there "
            << yes(reads_back(folder, header, increments)) << ", goes on after "
            << RecordWriter::resume(folder).n_increments() << '\n';
  RecordWriter::resume(folder).finish();

  std::cout << "kept in memory: " << yes(keeps("nowhere", 1 << 20, increments))
            << ", no room for all: " << yes(keeps(folder, 20000, increments))
            << ", these are not kept: " << yes(leaves_to_the_disk(increments))
            << ", for none: " << yes(keeps(folder, 0, increments)) << '\n';

  const auto [nodes, edges] = count_points(folder, 0);
  std::cout << "points: " << nodes << " nodes and " << edges << " edges\n";

  const RecordHeader bare{"", "", "", {}, brick(2, 2, 2), {}, {}};
  RecordHeader       positioned = bare;
  positioned.X_0                = bare.mesh.X;
  RecordWriter again(folder, positioned);
  std::cout << "a new run replaces it, empty texts: " << yes(reads_back(folder, positioned, {})) << '\n';

  const RecordHeader large = sample_header(brick(10, 10, 15));
  std::string        files[2];
  for (std::string &file : files)
  {
    RecordWriter        run(folder, large);
    const std::uint64_t start = run.bytes();
    for (unsigned int i = 0; i < 10; ++i)
      run.write(sample_increment(large, i));
    if (&file == &files[0])
      print_size("segments", run.bytes() - start, 20, 1500);
    run.finish();
    if (&file == &files[0])
      print_size("finished file, header included", run.bytes(), 20, 1500);
    file = bytes_of(folder + "/record.h5");
  }
  std::cout << "same run, same bytes: " << yes(files[0] == files[1]) << '\n';
}
