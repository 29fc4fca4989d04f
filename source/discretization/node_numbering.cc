// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/node_numbering.h>

#include <algorithm>

namespace retroforge
{
  NodeNumbering::NodeNumbering(const unsigned int            width,
                               const std::vector<NodeIndex> &owned,
                               const std::vector<NodeIndex> &read,
                               const unsigned int            n,
                               const MPI_Comm                comm)
      : nodes_(owned, n, comm)
  {
    if (n_owned() < n)
    {
      const auto               &order = nodes_.in_order_of_ranks();
      std::vector<unsigned int> index(n);
      for (unsigned int i = 0; i < n; ++i)
        index[order[i]] = i;
      for (const NodeIndex k : read)
        if (!range().owns(index[k]))
          index_of_ghost_.push_back(index[k]);
      std::sort(index_of_ghost_.begin(), index_of_ghost_.end());
      index_of_ghost_.erase(std::unique(index_of_ghost_.begin(), index_of_ghost_.end()),
                            index_of_ghost_.end());
      node_at_ = owned;
      for (const unsigned int i : index_of_ghost_)
        node_at_.push_back(order[i]);
      place_.assign(n, invalid_index);
      for (unsigned int place = 0; place < node_at_.size(); ++place)
        place_[node_at_[place]] = place;
    }
    make_partitioner(width);
  }

  void NodeNumbering::make_partitioner(const unsigned int width)
  {
    dealii::IndexSet ghosts(width * n());
    for (const unsigned int i : index_of_ghost_)
      ghosts.add_range(width * i, width * (i + 1));
    partitioner_ =
      std::make_shared<const dealii::Utilities::MPI::Partitioner>(range().dofs(width), ghosts, nodes_.comm());
  }

  std::shared_ptr<const NodeNumbering> NodeNumbering::of_width(const unsigned int width) const
  {
    auto numbering = std::make_shared<NodeNumbering>(*this);
    numbering->make_partitioner(width);
    return numbering;
  }
} // namespace retroforge
