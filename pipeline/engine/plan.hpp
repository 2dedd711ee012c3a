// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/tile.hpp"
namespace waymark::pipeline {

/// Smallest unit of work: one stage applied to one item.
struct Unit {
  std::string stage;
  std::string item;  ///< "map", "tile_000003" or "image_a.png"
  std::optional<Tile> tile;
  std::optional<ImageItem> image;
  std::string fingerprint;         ///< equal fingerprints mean equal results; empty without a work folder
  std::vector<std::size_t> after;  ///< indices into Plan::units of the units it reads, ascending
  bool done = false;               ///< whether its result is in the work folder

  std::string id() const { return stage + "/" + item; }
  /// Returns the index of the tile or image, from 0; `std::nullopt` for the map.
  std::optional<std::int64_t> index() const {
    return tile ? std::optional(tile->index) : image ? std::optional(image->index) : std::nullopt;
  }
};

/// Units in a valid order of execution: by stage, then by tile or image.
struct Plan {
  std::vector<Unit> units;
  std::vector<std::size_t> begins = {0};  ///< units of stage s: [begins[s], begins[s + 1])

  std::size_t stage_count() const { return begins.size() - 1; }
};

/// Command line by which a scheduler runs one unit.
struct PlanCommand {
  std::string job;   ///< job file
  std::string work;  ///< work folder shared by all machines
  std::string program = "waymark";
};

/// Returns one JSON object per line: unit, stage, item, fingerprint, done, after (ids).
std::string plan_as_jsonl(const Plan& plan);
/// Returns a Snakefile with one rule per unit and its manifest as output.
std::string plan_as_snakemake(const Plan& plan, const PlanCommand& command);
/// Returns a shell script of sbatch calls: per stage one job or one array of shards, after the stages it
/// reads.
std::string plan_as_slurm(const Plan& plan, const PlanCommand& command);

}  // namespace waymark::pipeline
