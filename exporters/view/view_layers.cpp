// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_layers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "core/rotate_axes.hpp"
#include "exporters/report/map_markers.hpp"
#include "exporters/report/map_view.hpp"
#include "exporters/vector/export_columns.hpp"
#include "exporters/view/view_form.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

constexpr std::size_t kMaxEvidence = 8;  // observations listed per landmark

float positive_or_zero(double value) {
  return value > 0 && std::isfinite(value) ? static_cast<float>(value) : 0.F;
}

std::string view_label(const Landmark& landmark, const LandmarkType& type) {
  for (std::size_t i = 0; i < type.attributes.size() && i < landmark.attributes.size(); ++i)
    if (type.attributes[i].name == "name")
      if (const auto* name = std::get_if<std::string>(&landmark.attributes[i]); name && !name->empty())
        return *name;
  const auto feature = find_feature(type, type.label_feature);
  const double value = value_of(landmark, feature);
  return std::isfinite(value) ? number_format(type.features[*feature], value)(value) : "";
}

ViewLandmark view_landmark(const Landmark& landmark, const LandmarkType& type, const ViewFrame& frame,
                           const Eigen::Vector3d& at) {
  ViewLandmark out{
      .uid = landmark.uid,
      .position = position_text(frame.crs(), landmark.position.xyz.x(), landmark.position.xyz.y()),
      .label = view_label(landmark, type),
      .at = at.cast<float>()};
  const double size = value_of(landmark, find_feature(type, type.body.feature));
  out.radius = positive_or_zero(type.body.radius_per_value * size);
  out.height = positive_or_zero(
      value_of(landmark, find_feature(type, type.evidence == EvidenceModel::bowl ? "depth" : "height")));
  out.confidence = static_cast<float>(landmark.confidence);
  out.quality =
      static_cast<float>(equal_weight_quality(landmark).value_or(std::numeric_limits<double>::quiet_NaN()));
  const Eigen::Matrix3d rotation = frame.rotation_from_grid(landmark.position);
  const Eigen::Matrix3d covariance =
      rotate_axes(landmark.covariance, std::atan2(rotation(1, 0), rotation(0, 0)));
  for (int i = 0; i < 3; ++i)
    out.sd[static_cast<std::size_t>(i)] = std::sqrt(positive_or_zero(covariance(i, i)));
  out.seen = landmark.quality.seen;
  out.visible = landmark.quality.visible;
  out.observations = landmark.observations;
  for (std::size_t i = 0; i < type.features.size(); ++i) {
    const double value = value_of(landmark, i);
    const double sd = std::isfinite(value) ? std::sqrt(std::max(0.0, landmark.features[i].variance)) : 0;
    out.features.push_back({static_cast<float>(value), positive_or_zero(sd)});
  }
  return out;
}

ViewFeature view_feature(const LandmarkSection& section, std::size_t i) {
  const FeatureSpec& feature = section.type.features[i];
  double largest = 0;
  for (const double value : section.values[i]) largest = std::max(largest, std::abs(value));
  return {title_of(feature.name), feature.summary, number_format(feature, largest)};
}

ViewLayer view_layer(const LandmarkSection& section, const ViewFrame& frame, std::size_t max_count,
                     double max_distance) {
  const LandmarkType& type = section.type;
  ViewLayer layer{.name = type.name,
                  .title = title_of(type.name),
                  .colour = type.colour,
                  .shape = view_shape(type),
                  .total = section.count,
                  .features = {},
                  .landmarks = {}};
  for (std::size_t i = 0; i < type.features.size(); ++i) layer.features.push_back(view_feature(section, i));
  const bool oriented = is_oriented(layer.shape);
  for (const Landmark& landmark : section.landmarks) {
    if (layer.landmarks.size() == max_count) break;
    const Eigen::Vector3d at = frame.from_crs(landmark.position);
    if (!(at.allFinite() && at.norm() <= max_distance)) continue;
    layer.landmarks.push_back(view_landmark(landmark, type, frame, at));
    if (oriented) layer.landmarks.back().form = view_form(landmark, type, frame);
  }
  return layer;
}

void add_evidence(const geodb::MapStore& map, ViewLayers& view) {
  std::unordered_map<std::string, ViewLandmark*> by_uid;
  for (ViewLayer& layer : view.layers)
    for (ViewLandmark& landmark : layer.landmarks) by_uid[landmark.uid] = &landmark;
  std::unordered_map<std::string, std::int32_t> sources;
  map.visit_observations([&](Observation&& one) {
    const auto found = by_uid.find(one.landmark_uid);
    if (found == by_uid.end() || !one.rejected.empty() || found->second->evidence.size() >= kMaxEvidence)
      return;
    const auto [source, is_new] = sources.try_emplace(one.source, static_cast<std::int32_t>(sources.size()));
    if (is_new) view.sources.push_back(one.source);
    found->second->evidence.push_back({source->second, static_cast<float>(one.confidence)});
  });
}

}  // namespace

ViewLayers make_view_layers(const geodb::MapStore& map, const std::vector<LandmarkSection>& sections,
                            const ViewFrame& frame, std::int64_t max_landmarks, double max_distance) {
  std::int64_t total = 0;
  for (const LandmarkSection& section : sections) total += section.count;
  const double share = total > max_landmarks ? double(max_landmarks) / double(total) : 1;
  ViewLayers view;
  for (const LandmarkSection& section : sections) {
    if (section.count == 0) continue;
    const auto max_count = static_cast<std::size_t>(std::ceil(share * double(section.count)));
    view.layers.push_back(view_layer(section, frame, max_count, max_distance));
  }
  add_evidence(map, view);
  return view;
}

}  // namespace waymark::exporters
