// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>
#include "pipeline/engine/parts.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/association/merging.hpp"
namespace waymark::pipeline {

/// Observations that do not fit into memory, in batches of any size and order.
struct ObservationStream {
  using Take = std::function<void(std::vector<Observation>&& batch)>;
  std::function<void(const std::function<void(const std::vector<Observation>&)>&)> visit;
  std::function<void(const Take&)> consume;  ///< called once, after visit
};

struct CellRules {
  /// Observations of a cell; more if there are more than a thousand cells. Does not change the result.
  std::size_t max_in_cell = 50'000;
  std::filesystem::path scratch = {};  ///< folder for temporary files; empty: the system's
  std::function<void(double)> progress = {};
};

/// Result of merge_by_cells(): part i of the landmarks belongs to part i of the evidence.
struct MergedParts {
  Parts<std::vector<Landmark>> landmarks;    ///< each as MergedObservations::landmarks
  Parts<std::vector<Observation>> evidence;  ///< each as MergedObservations::evidence
  std::int64_t in = 0, out = 0;              ///< observations accepted before and after
  std::map<std::string, std::int64_t> rejected;
};

/// Merges observations as merge_observations() does, with a cell of them in memory at a time.
/// - Observations are divided into the cells of a CellTree, on disk. Each cell gets the objects of others
///   that can be a pair with one of its own (the halo).
/// - Objects that possible pairs connect are merged in one cell: those that cross a border in the first of
///   their cells (the seams). So the landmarks, their uids and evidence are those of merge_observations() on
///   all observations, bit by bit, for any cells, batches and threads; only the parts differ.
/// - Memory: one cell, 32 MB of buffers three times, 30 bytes per observation in seams, the names of the
///   sources. Disk: about 700 bytes per observation.
/// - A connected group is in memory as a whole, so a position with a huge covariance costs what it connects.
MergedParts merge_by_cells(const ObservationStream& observations, const TypeRegistry& types, const Crs& crs,
                           const MergeRules& rules = {}, const CellRules& cells = {});

}  // namespace waymark::pipeline
