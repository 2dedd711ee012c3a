// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "importers/logs/import_log.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Request of a page that shows a map, and drives on it, in three dimensions.
struct ViewPageRequest {
  std::string map;     ///< map (.gpkg), or the folder of a simulated scene
  std::string output;  ///< .html
  std::string title = {};
  std::vector<std::string> dem = {};  ///< empty: stored in the map, or read by its run
  std::string orthophoto = {};        ///< empty: shaded relief
  std::string cameras = {};           ///< camera file; empty: cameras of the map
  std::string images = {};            ///< folder of their images; empty: where the run read them
  std::string log = {};               ///< empty: none, or that of the scene
  importers::LogImport log_format = {};
  std::vector<std::string> tracks = {};  ///< TRACK.csv or NAME=TRACK.csv
  std::int64_t max_landmarks = 24000;
};

/// What a page shows.
struct ViewPageResult {
  std::int64_t bytes = 0;                              ///< of the page
  std::int64_t images = 0;                             ///< with a pose
  std::int64_t tracks = 0;                             ///< the true poses of the log among them
  std::vector<std::string> notes = {};                 ///< what was left out
  std::map<std::string, std::int64_t> landmarks = {};  ///< drawn, by type
};

/// Writes the page (exporters/view). Throws Error{input} for files that cannot be read, Error{usage} for a
/// scene folder without truth, Error{output} if the page exceeds 10 MB or cannot be written.
ViewPageResult write_view(const ViewPageRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
