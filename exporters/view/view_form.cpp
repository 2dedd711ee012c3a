// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "exporters/report/landmark_section.hpp"
#include "exporters/report/map_markers.hpp"

namespace waymark::exporters {
namespace {

/// Returns the index of the first feature of a horizontal direction or axis.
std::optional<std::size_t> find_direction(const LandmarkType& type) {
  const auto found = std::ranges::find_if(type.features, [](const FeatureSpec& feature) {
    return feature.scale == Scale::direction || feature.scale == Scale::axis;
  });
  if (found == type.features.end()) return {};
  return static_cast<std::size_t>(found - type.features.begin());
}

float number(const Landmark& landmark, const LandmarkType& type, const std::string& feature) {
  return static_cast<float>(value_of(landmark, find_feature(type, feature)));
}

}  // namespace

std::string view_shape(const LandmarkType& type) {
  const auto direction = find_direction(type);
  if (!direction || solid_name(type) != "point") return solid_name(type);
  const auto has = [&](const std::string& feature) { return find_feature(type, feature).has_value(); };
  if (type.features[*direction].scale == Scale::direction) {
    if (has("length")) return "panel";
    if (has("opening_angle")) return "corner";
    if (has("side")) return "end";
    return has("height") ? "plate" : solid_name(type);
  }
  if (type.evidence == EvidenceModel::upright && !type.body.feature.empty()) return "block";
  if (has("length") && has("width")) return "strip";
  return has("width") ? "portal" : solid_name(type);
}

bool is_oriented(std::string_view shape) {
  constexpr std::array<std::string_view, 7> all{"panel", "corner", "end",   "plate",
                                                "block", "strip",  "portal"};
  return std::ranges::find(all, shape) != all.end();
}

ViewForm view_form(const Landmark& landmark, const LandmarkType& type, const ViewFrame& frame) {
  const Eigen::Matrix3d rotation = frame.rotation_from_grid(landmark.position);
  const double azimuth = value_of(landmark, find_direction(type));  // clockwise from the north of the grid
  const double turn = std::numbers::pi / 2 - azimuth + std::atan2(rotation(1, 0), rotation(0, 0));
  return {.turn = static_cast<float>(turn),
          .length = number(landmark, type, "length"),
          .width = number(landmark, type, "width"),
          .opening = number(landmark, type, "opening_angle"),
          .side = number(landmark, type, "side")};
}

}  // namespace waymark::exporters
