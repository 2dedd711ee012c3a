// SPDX-License-Identifier: Apache-2.0
#include "workflows/viewing/scene_folder.hpp"

#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"
#include "workflows/mapping/import_landmarks.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

std::string file_if_there(const fs::path& file) {
  std::error_code missing;
  return fs::exists(file, missing) ? file.string() : "";
}

/// Returns the CRS of a scene: that of its scenario, "local" without one.
std::string scene_crs(const fs::path& folder) {
  const std::string scenario = file_if_there(folder / "scenario.json");
  if (scenario.empty()) return "local";
  const auto json =
      nlohmann::json::parse(checked_json(read_text(scenario, "the scenario"), scenario), nullptr, false);
  return json.is_object() && json.contains("crs") && json["crs"].is_string() ? json["crs"].get<std::string>()
                                                                             : "local";
}

}  // namespace

SceneFolder::SceneFolder(ViewPageRequest& request) : folder_(fs::temp_directory_path()) {
  const fs::path scene = request.map;
  const std::string truth = file_if_there(scene / "truth" / "landmarks.csv");
  if (truth.empty())
    throw Error(ErrorCode::usage, "the folder is no simulated scene: it has no truth/landmarks.csv",
                request.map, "give a map (.gpkg), or the folder of `waymark simulate`");
  const fs::path map = folder_.path() / "scene.gpkg";
  ImportRequest import{.table = truth, .map = map.string()};
  import.options.table_crs = scene_crs(scene);
  import_landmarks(import);
  request.map = map.string();
  const auto use = [](std::string& option, const fs::path& file) {
    if (option.empty()) option = file_if_there(file);
  };
  if (request.title.empty()) request.title = "Scene " + fs::weakly_canonical(scene).filename().string();
  for (const char* name : {"dem.tif", "dtm.tif"})
    if (const std::string dem = file_if_there(scene / name); request.dem.empty() && !dem.empty())
      request.dem = {dem};
  if (request.cameras.empty()) {
    use(request.cameras, scene / "truth" / "cameras.json");
    use(request.cameras, scene / "cameras.json");
  }
  if (!request.cameras.empty()) use(request.images, scene / "images");
  use(request.log, scene / "log.jsonl");
}

}  // namespace waymark::workflows
