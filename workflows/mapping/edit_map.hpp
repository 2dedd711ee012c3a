// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Correction of a map by a person.
enum class MapEdit {
  accept,  ///< the landmarks exist: their confidence is set
  reject,  ///< the landmarks do not exist: they are removed, their evidence is kept as rejected
  add,     ///< a landmark that no detector found
  move,    ///< a landmark stands elsewhere
};

struct EditRequest {
  std::string map;
  std::string result = {};  ///< .gpkg; empty: the map itself, with a backup that restore_map() takes back
  MapEdit edit = MapEdit::accept;
  std::vector<std::string> uids = {};      ///< of accept, reject and move
  std::string type = {};                   ///< of the added landmark
  std::vector<double> at = {};             ///< x, y in the map's CRS
  std::optional<double> z = {};            ///< metres; absent: as before, 0 of a new landmark
  std::vector<double> rim = {};            ///< x, y of three points of an outline, instead of `at`
  std::vector<std::string> features = {};  ///< "radius=2.5" of the added landmark
  double position_sd = 0;                  ///< metres, of `at`; 0: not known
  double confidence = 0.99;                ///< of accepted and added landmarks, (0, 1]
  std::string reason = {};                 ///< recorded with the run
  std::string command_line = {};
};

/// Corrects a map and records the run. Returns the uids of the landmarks concerned.
/// - A landmark that is added has no images: its quality is not assessed.
/// - A rim gives the centre and the feature of the body's extent by the circle through its points.
/// - Throws Error{usage} for landmarks, types, features or positions that cannot be, and leaves the map as it
///   was.
std::vector<std::string> edit_map(const EditRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
