// SPDX-License-Identifier: Apache-2.0
#include "workflows/viewing/view.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/keep_inputs.hpp"
#include "core/locked_folder.hpp"
#include "core/text_file.hpp"
#include "exporters/vector/track_file.hpp"
#include "exporters/view/make_scene.hpp"
#include "exporters/view/view_page.hpp"
#include "importers/cameras/camera_set.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/mapping/import_landmarks.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxPage = 10'000'000;  // bytes

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

/// The folder of a simulated scene, seen as a map of its true landmarks. The map is temporary and is removed
/// with the object.
class SceneFolder {
 public:
  /// Replaces `request.map`, a folder, by the map, and fills in DEM, cameras, images and log of the scene
  /// where the request gives none. Throws Error{usage} if the folder has no truth/landmarks.csv.
  explicit SceneFolder(ViewPageRequest& request) : folder_(fs::temp_directory_path()) {
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

 private:
  LockedFolder folder_;
};

exporters::NamedTrack read_named_track(const std::string& text, const LocalFrame& frame) {
  const std::size_t equals = text.find('=');
  const bool named = equals != std::string::npos && equals > 0 && !fs::exists(text);
  const fs::path file = named ? text.substr(equals + 1) : text;
  return {named ? text.substr(0, equals) : file.stem().string(), exporters::read_track(file, &frame)};
}

/// Returns the posed images of a camera file, with files from a folder.
std::vector<exporters::PosedImageFile> read_cameras(const ViewPageRequest& request, const RobotMap& map) {
  const fs::path folder =
      request.images.empty() ? fs::path(request.cameras).parent_path() / "images" : fs::path(request.images);
  const bool is_local = map.crs().kind() == CrsKind::local;
  const auto set =
      importers::import_cameras(request.cameras, "", {.crs = is_local ? "local" : map.crs().wkt2()});
  std::vector<exporters::PosedImageFile> images;
  for (const importers::ImageCamera& one : set.images) {
    if (!one.view) continue;
    const fs::path name = fs::path(one.image).filename();
    std::string found;
    for (const fs::path& path : {folder / name, fs::path(request.cameras).parent_path() / one.image})
      if (std::error_code missing; found.empty() && fs::exists(path, missing)) found = path.string();
    images.push_back({name.string(), found, *one.view});
  }
  return images;
}

localization::RobotLog read_view_log(const ViewPageRequest& request, const RobotMap& map,
                                     const Callbacks& callbacks) {
  importers::LogImport how = request.log_format;
  how.held_types = map.held_types;
  localization::RobotLog log = importers::import_log(request.log, map.types(), how);
  localization::convert_to_map_frame(log, map.frame);
  for (const std::string& remark : log.remarks) callbacks.warning(remark + ": " + request.log);
  return log;
}

}  // namespace

ViewPageResult write_view(const ViewPageRequest& asked, const Callbacks& callbacks) {
  ViewPageRequest request = asked;
  keep_inputs(request.output, {request.map, request.log, request.orthophoto, request.cameras});
  keep_inputs(request.output, request.dem);
  keep_inputs(request.output, request.tracks);
  std::optional<SceneFolder> scene;
  if (fs::is_directory(request.map)) scene.emplace(request);
  const RobotMap map = open_robot_map(request.map, nullptr, true).map;
  exporters::ViewRequest view{.title = request.title,
                              .dems = request.dem,
                              .orthophoto = request.orthophoto,
                              .max_landmarks = request.max_landmarks};
  for (const std::string& track : request.tracks) view.tracks.push_back(read_named_track(track, map.frame));
  localization::RobotLog log;
  if (!request.log.empty()) {
    log = read_view_log(request, map, callbacks);
    view.log = &log;
  }
  view.images = request.cameras.empty() ? exporters::posed_images(*map.store) : read_cameras(request, map);
  const exporters::ViewScene made = exporters::make_view_scene(*map.store, map.frame, view);
  const std::string page = exporters::view_page(made);
  if (page.size() > kMaxPage)
    throw Error(ErrorCode::output,
                fmt::format("the page has {:.1f} MB, at most 10 MB are written", double(page.size()) / 1e6),
                request.output, "give a smaller --max-landmarks, or fewer tracks");
  write_file(request.output, page);
  for (const std::string& note : made.notes) callbacks.summary(note + "\n");
  callbacks.summary(fmt::format("{}  {:.1f} MB\n", request.output, double(page.size()) / 1e6));
  ViewPageResult result{.bytes = std::ssize(page),
                        .images = std::ssize(made.images),
                        .tracks = std::ssize(made.tracks),
                        .notes = made.notes};
  for (const exporters::ViewLayer& layer : made.layers)
    result.landmarks[layer.name] = std::ssize(layer.landmarks);
  return result;
}

}  // namespace waymark::workflows
