// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/image_stages.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.hpp"

namespace waymark::workflows {
namespace {

void check_files(const ImageFiles& files, const ImageFinds& find) {
  if (files.images.empty() && files.cameras.empty())
    throw Error(ErrorCode::usage, "no images are given", "",
                "pass files, patterns or a folder, with --cameras FILE unless they are orthophotos");
  if (files.dem.empty() && find.mountain_tops)
    throw Error(ErrorCode::usage, "mountain tops are those of a DEM, and none is given", "",
                "pass --dem DEM");
}

}  // namespace

ImageFinds parse_image_finds(std::string_view list) {
  ImageFinds find{.rocks = false, .craters = false};
  // The last comma keeps an empty last word, which is refused.
  std::istringstream words(list.empty() ? "" : std::string(list) + ',');
  for (std::string word; std::getline(words, word, ',');) {
    if (word == "rocks")
      find.rocks = true;
    else if (word == "craters")
      find.craters = true;
    else if (word == "mountain_tops")
      find.mountain_tops = true;
    else
      throw Error(ErrorCode::usage, fmt::format("--find does not know '{}'", word), "",
                  "write one or more of rocks,craters,mountain_tops; trees: `waymark trees`");
  }
  if (!find.rocks && !find.craters && !find.mountain_tops)
    throw Error(ErrorCode::usage, "--find names no landmarks", "",
                "write one or more of rocks,craters,mountain_tops");
  return find;
}

std::vector<std::string> image_stages(const ImageFinds& find, bool known_sun) {
  std::vector<std::string> stages;
  const auto add = [&](bool wanted, std::initializer_list<const char*> names) {
    if (wanted) stages.insert(stages.end(), names.begin(), names.end());
  };
  const bool detections = find.rocks || find.craters;
  add(detections && known_sun, {"check_sun"});
  add(find.rocks, {"rocks_from_shadows"});
  add(find.craters, {"craters_from_bowls"});
  add(detections, {"project_to_ground", "reject_implausible", "reject_terrain_shadows", "reject_rim_shadows",
                   "align_images", "merge_observations", "value_landmarks"});
  add(find.mountain_tops,
      {"find_mountain_tops", "join_mountain_tops", "measure_isolation", "map_mountain_tops"});
  return stages;
}

void add_image_stages(pipeline::Pipeline& pipeline, const ImageFiles& files, const ImageFinds& find) {
  using OptionJson = nlohmann::json;
  check_files(files, find);
  OptionJson ground{{"crs", files.crs}, {"height_sd", files.height_sd}};
  if (!files.dem.empty()) ground.update({{"files", files.dem}, {"nodata", "unknown"}, {"metric", true}});
  pipeline.add(files.dem.empty() ? "flat_ground" : "load_dem", ground.dump());
  pipeline.add("load_images", OptionJson{{"files", files.images}, {"cameras", files.cameras}}.dump());
  for (const std::string& stage : image_stages(find)) pipeline.add(stage);
}

}  // namespace waymark::workflows
