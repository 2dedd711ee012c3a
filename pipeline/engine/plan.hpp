// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/tile.hpp"
namespace waymark {

/// One stage on one item: the smallest piece of work that is done, kept and done again.
struct Unit {
  std::string stage;
  std::string item;  ///< "map", "tile_000003" or "image_a.png"
  std::optional<Tile> tile;
  std::optional<ImageItem> image;
  std::string fingerprint;         ///< equal fingerprints, equal results; empty where nothing is kept
  std::vector<std::size_t> after;  ///< units whose artifacts it reads, ascending indices into Plan::units
  bool done = false;               ///< its result is in the work folder

  std::string id() const { return stage + "/" + item; }
  /// Of the tile or image, from 0; nothing for the map.
  std::optional<std::int64_t> index() const {
    return tile ? std::optional(tile->index) : image ? std::optional(image->index) : std::nullopt;
  }
};

/// Units in an order in which they can be run: stage by stage, tiles and images in their order.
struct Plan {
  std::vector<Unit> units;
  std::vector<std::size_t> begins = {0};  ///< units of stage s: [begins[s], begins[s + 1])

  std::size_t stage_count() const { return begins.size() - 1; }
};

/// How a scheduler calls us for one unit.
struct PlanCommand {
  std::string job;   ///< job file
  std::string work;  ///< work folder shared by all machines
  std::string program = "waymark";
};

/// One JSON object per line: unit, stage, item, fingerprint, done, after (ids).
std::string plan_as_jsonl(const Plan& plan);
/// A Snakefile: one rule per unit, its manifest as output.
std::string plan_as_snakemake(const Plan& plan, const PlanCommand& command);
/// A shell script of sbatch calls: per stage one job, or one array of shares, after the stages it reads.
std::string plan_as_slurm(const Plan& plan, const PlanCommand& command);

}  // namespace waymark
