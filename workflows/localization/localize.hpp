// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "importers/logs/import_log.hpp"
#include "localization/replay_log.hpp"
#include "localization/track.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A robot's log, the map to localize it in, and how.
struct LocalizeRequest {
  std::string map;             ///< map file; "none" for methods that need no map
  std::string log;             ///< file, or folder of a dataset
  std::string output = {};     ///< track: .csv, .gpkg, .tum, .kitti, .g2o; empty: none
  std::string method = "ekf";  ///< a name of localize_methods()
  double min_confidence = 0;   ///< landmarks less probable than this are not used
  std::string sensor =
      {};  ///< profile of eq. 8, for `quality=paper` and maps without confidence; empty: equal weights
  importers::LogImport log_format = {};
  bool use_identities = true;  ///< identities in the log are used for data association
  std::string start = {};      ///< "X,Y,YAW[,T]" (m, rad, s), "truth" or "none"; empty: the log decides
  std::vector<std::string> set = {};  ///< OPTION=VALUE, settings of the method
  std::int64_t seed = 1;              ///< of all random numbers
  std::vector<std::string> dem = {};  ///< terrain under the map; empty: the map's own coverage if it has one
  std::string write_map = {};         ///< slam, graph: map to write with the updates; empty: none
  bool update_map = false;            ///< slam, graph: change the map itself
  std::string layers = {};            ///< map that gets the layers track and harvested; empty: none
  double live = 0;                    ///< s of the log between two writings of `layers`; 0: at the end only
  bool in_map_crs = false;            ///< a .csv has positions in the map's CRS, not in the map frame
  bool timing = false;                ///< a .csv has the duration of each update
  std::int64_t threads = 0;           ///< 0: one per processor
  std::string command_line = {};      ///< recorded in a written map
  localization::TrackWatcher watch = {};  ///< receives the growing track of a filter; empty: nobody watches
};

/// Track of a robot.
struct LocalizeResult {
  localization::Track track;  ///< map frame
  std::string settings;       ///< every setting of the method with its value and effect, a line each
  std::string settings_json;  ///< the values as a JSON object
};

/// Follows a robot through a map by its log and writes the track. Throws Error{usage} for unknown methods and
/// settings or a missing start, Error{input} for a log that does not fit the map.
/// Messages: warnings about map and log, results of `graph`, summaries of written maps.
LocalizeResult localize(const LocalizeRequest& request, const Callbacks& callbacks = {});

/// Returns every setting of the request's method as LocalizeResult::settings, without a map or a log.
std::string localize_settings(const LocalizeRequest& request);
/// Returns the values likewise as LocalizeResult::settings_json.
std::string localize_settings_json(const LocalizeRequest& request);

/// Returns the names of all methods.
std::vector<std::string> localize_methods();

/// Returns "odometry: ...; ekf: ..." for a help text.
std::string describe_localize_methods();

}  // namespace waymark::workflows
