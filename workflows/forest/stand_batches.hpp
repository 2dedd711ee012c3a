// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "workflows/forest/stand_result.hpp"
#include "workflows/forest/tree_reader.hpp"
namespace waymark::workflows {

/// Visits stands with the trees near them, batch by batch, so that a map may be larger than memory. A batch
/// is a run of stands that together hold about `max_trees` trees, or one larger stand.
class StandBatches {
 public:
  using Visitor = std::function<void(const MapTrees& trees, const NamedStand& stand)>;

  /// `reader` must outlive it.
  StandBatches(const TreeReader& reader, std::vector<NamedStand> stands, std::int64_t max_trees);

  /// Visits all stands in their order. `trees` holds those near the stand, and others.
  void visit(const Visitor& visitor) const;

 private:
  struct Batch {
    std::size_t begin = 0, end = 0;  ///< stands
    Eigen::AlignedBox2d box;         ///< metres, widened by the trees' radius of influence
  };
  void make_batches(std::int64_t max_trees);
  MapTrees trees_of(const Batch& batch) const;

  const TreeReader* reader_;
  std::vector<NamedStand> stands_;
  std::vector<Batch> batches_;
  mutable std::optional<MapTrees> cached_;  ///< trees of the only batch
};

}  // namespace waymark::workflows
