// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>
#include "core/input_file.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/plan.hpp"
namespace waymark {

/// An input of a stage and the stage it comes from.
struct Wire {
  std::string port;
  std::size_t writer = 0;  ///< index into Pipeline::steps
  bool all_tiles = false;  ///< a map-scope stage reads what a tile-scope stage wrote
};

/// One per declared input, in their order. The pipeline has been checked.
std::vector<Wire> wires_of(const Pipeline& pipeline, std::size_t stage);

/// Appends the units of the next stage, without fingerprints.
void append_units(Plan& plan, const Pipeline& pipeline, const std::vector<Tile>& tiles);

/// What makes the result of a unit the same: stage, version, halo, options that affect it, item, contents of
/// its input files, fingerprints of what it reads. 32 hex digits.
std::string fingerprint_of(const Plan& plan, const Unit& unit, const Step& step,
                           const std::vector<InputFile>& files);

}  // namespace waymark
