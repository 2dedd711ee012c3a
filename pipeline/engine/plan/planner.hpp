// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>
#include "core/input_file.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/runner.hpp"
namespace waymark::pipeline {

/// Connection from a writing stage to an input of a reading stage.
struct Wire {
  std::string port;
  std::size_t writer = 0;  ///< index into Pipeline::steps
  bool same_item = false;  ///< reads only the unit of the same tile or image
  bool gathers = false;    ///< declared with Gather: failed units are skipped
  bool streams = false;    ///< declared with Stream: read one by one
};

/// Returns one wire per declared input and stage that writes it, in their order. Requires a checked pipeline.
std::vector<Wire> stage_wires(const Pipeline& pipeline, std::size_t stage);

/// Returns the range [first, last) of the units of the writer that the unit at `position` of its stage reads.
std::pair<std::size_t, std::size_t> units_read(const Plan& plan, const Wire& wire, std::size_t position);

/// Returns per stage whether it runs while planning: it lists items, or a listing stage depends on it.
std::vector<bool> runs_while_planning(const Pipeline& pipeline, const std::vector<std::vector<Wire>>& wires);

/// Tiles and images found by the listing stages.
struct Items {
  std::vector<Tile> tiles;
  std::vector<ImageItem> images;
};

/// Appends the units of the next stage, without fingerprints.
void append_units(Plan& plan, const Pipeline& pipeline, const Items& items);

/// Returns a hash of the declarations of the landmark types that determine results: all but drawing and
/// texts.
std::string types_fingerprint(const TypeRegistry& types);

/// Hashes of everything that determines the results of the units of a stage: stage, version, halo, options
/// that affect the result, item, landmark types, contents of input files, fingerprints of the units it reads.
/// For an image the list that contains it is left out.
class UnitFingerprints {
 public:
  /// `types`: types_fingerprint().
  UnitFingerprints(const Plan& plan, const Pipeline& pipeline, const Step& step, const std::string& types);
  ~UnitFingerprints();
  /// Returns that of a unit of the stage, 32 hex digits.
  std::string of(const Unit& unit, const std::vector<InputFile>& files);

 private:
  struct Key;
  const Plan* plan_;
  const Pipeline* pipeline_;
  std::unique_ptr<Key> key_;  ///< of the last unit
};

}  // namespace waymark::pipeline
