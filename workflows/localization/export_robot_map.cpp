// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/export_robot_map.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "core/atomic_file.hpp"
#include "core/keep_inputs.hpp"
#include "core/lower_case.hpp"
#include "workflows/localization/robot_map.hpp"

namespace waymark::workflows {
namespace {

struct RobotLandmark {
  std::string uid;
  TypeId type;
  Eigen::Vector3d at;  ///< map frame
};

std::vector<RobotLandmark> read_landmarks(const RobotMap& map, const RobotMapExport& request) {
  std::vector<RobotLandmark> all;
  for (const Landmark& one :
       map.store->query({.types = request.types, .min_confidence = request.min_confidence}))
    all.push_back({one.uid, one.type, map.frame.map_frame_from_crs(one.position).xyz});
  if (all.empty())
    throw Error(ErrorCode::input, "the map has no landmarks of these types and this confidence", request.map,
                "leave out --type");
  return all;
}

/// First lines, as comments: what the numbers mean.
std::string heading(const RobotMap& map) {
  const Eigen::Vector3d& origin = map.frame.origin().xyz;
  return fmt::format(
      "# Landmarks of {}, metres: x east, y north, z up about {}, {}, {} in {}\n"
      "# Poses of `waymark localize` are in the same frame.\n",
      map.store->path().filename().string(), origin.x(), origin.y(), origin.z(), map.crs().id());
}

std::string beluga_text(const RobotMap& map, const std::vector<RobotLandmark>& landmarks) {
  Eigen::AlignedBox3d box;
  for (const RobotLandmark& one : landmarks) box.extend(one.at);
  std::string text = heading(map) + "categories:\n";
  for (TypeId type = 0; std::size_t(type) < map.types().size(); ++type)
    if (std::ranges::count(landmarks, type, &RobotLandmark::type) > 0)
      text += fmt::format("  {}: {}\n", map.types()[type].name, type);
  const auto corner = [](const Eigen::Vector3d& at) {
    return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", at.x(), at.y(), at.z());
  };
  text += fmt::format("boundaries: {{min: {}, max: {}}}\nlandmarks:\n", corner(box.min()), corner(box.max()));
  for (const RobotLandmark& one : landmarks)
    text += fmt::format("  - {{category: {}, position: {}}}  # {}\n", one.type, corner(one.at), one.uid);
  return text;
}

std::string mrpt_text(const RobotMap& map, const std::vector<RobotLandmark>& landmarks) {
  std::string text = heading(map);
  text += fmt::format(
      "[MetricMap]\nlandmarksMap_count = 1\n\n[MetricMap_landmarksMap_00_creationOpts]\nnBeacons = {}\n",
      landmarks.size());
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const RobotLandmark& one = landmarks[i];
    text += fmt::format(
        "# {0} {1}\nbeacon_{2:03}_ID = {2}\nbeacon_{2:03}_x = {3:.4f}\nbeacon_{2:03}_y = {4:.4f}\n"
        "beacon_{2:03}_z = {5:.4f}\n",
        map.types()[one.type].name, one.uid, i + 1, one.at.x(), one.at.y(), one.at.z());
  }
  return text;
}

/// MRPT 2.5 indexes the landmarks of a map by a grid over all of them: 24 bytes per cell of 0.2 m.
std::vector<std::string> warnings_of_mrpt(const std::vector<RobotLandmark>& landmarks) {
  constexpr double bytes_per_square_metre = 24 / (0.2 * 0.2), max_bytes = 1e9;
  Eigen::AlignedBox2d box;
  for (const RobotLandmark& one : landmarks) box.extend(Eigen::Vector2d(one.at.head<2>()));
  const double bytes = bytes_per_square_metre * box.volume();
  if (bytes <= max_bytes) return {};
  return {fmt::format(
      "the landmarks lie {:.3g} x {:.3g} m apart: MRPT's grid of 0.2 m cells over them will take {:.3g} GB; "
      "choose fewer with --type or --min-confidence, or first export a part of the map (--aoi)",
      box.sizes().x(), box.sizes().y(), bytes / 1e9)};
}

}  // namespace

std::optional<RobotFormat> parse_robot_format(std::string_view text) {
  const std::string word = lower_case(text);
  if (word == "beluga") return RobotFormat::beluga;
  if (word == "mrpt") return RobotFormat::mrpt;
  return std::nullopt;
}

ExportedRobotMap export_robot_map(const RobotMapExport& request) {
  const std::filesystem::path output = request.output;
  keep_inputs(output, {request.map});
  if (!request.overwrite && std::filesystem::exists(output))
    throw Error(ErrorCode::output, output.filename().string() + " exists already", request.output,
                "remove it, choose another name, or allow it to be replaced with --overwrite");
  const RobotMap map = open_robot_map(request.map, nullptr).map;
  for (const std::string& type : request.types) map.store->count(type);  // throws for an unknown one
  const std::vector<RobotLandmark> landmarks = read_landmarks(map, request);
  const bool mrpt = request.format == RobotFormat::mrpt;
  write_file(output, mrpt ? mrpt_text(map, landmarks) : beluga_text(map, landmarks));
  return {static_cast<std::int64_t>(landmarks.size()),
          mrpt ? warnings_of_mrpt(landmarks) : std::vector<std::string>()};
}

}  // namespace waymark::workflows
