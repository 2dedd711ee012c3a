// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>
#include "core/input_file.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/plan.hpp"
namespace waymark {

/// An input of a stage and a stage it comes from.
struct Wire {
  std::string port;
  std::size_t writer = 0;  ///< index into Pipeline::steps
  bool same_item = false;  ///< reads the unit of its own tile or image, not all units of the writer
  bool gathers = false;    ///< declared with Gather: does without units that failed
};

/// One per declared input and stage that writes it, in their order. The pipeline has been checked.
std::vector<Wire> wires_of(const Pipeline& pipeline, std::size_t stage);

/// Units [first, last) of the writer that the unit at `position` of its stage reads.
std::pair<std::size_t, std::size_t> units_read(const Plan& plan, const Wire& wire, std::size_t position);

/// Per stage, whether it runs while planning: it lists, or a stage that lists reads it, directly or not.
std::vector<bool> runs_while_planning(const Pipeline& pipeline, const std::vector<std::vector<Wire>>& wires);

/// What the stages run on, as listing stages say.
struct Items {
  std::vector<Tile> tiles;
  std::vector<ImageItem> images;
};

/// Appends the units of the next stage, without fingerprints.
void append_units(Plan& plan, const Pipeline& pipeline, const Items& items);

/// What makes the result of a unit the same: stage, version, halo, options that affect it, item, contents of
/// its input files, fingerprints of what it reads. Of an image the list it is in does not count. 32 hex
/// digits.
std::string fingerprint_of(const Plan& plan, const Unit& unit, const Step& step, const Pipeline& pipeline,
                           const std::vector<InputFile>& files);

}  // namespace waymark
