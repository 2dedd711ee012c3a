// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/web_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "exporters/report/landmark_section.hpp"
#include "exporters/vector/export_columns.hpp"
#include "exporters/web/tile_id.hpp"
#include "exporters/web/vector_tile.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

const std::set<std::string> kCovariances{"var_x", "var_y", "cov_xy", "var_z"};

/// What ranks a landmark; greater comes first.
struct Merit {
  double size = 0, quality = 0;
  std::string uid;
  std::size_t landmark = 0;

  bool operator<(const Merit& other) const {
    return std::tie(other.size, other.quality, uid) < std::tie(size, quality, other.uid);
  }
};

Merit merit_of(const LandmarkType& type, const Landmark& landmark) {
  const bool sized = find_feature(type, type.size_feature).has_value();
  const double size = sized ? certified_value(type, landmark, type.size_feature) : 1;
  return {.size = std::isfinite(size) && size > 0 ? size * landmark.confidence : 0,
          .quality = equal_weight_quality(landmark).value_or(0),
          .uid = landmark.uid};
}

/// Reads the landmarks of one type.
class LayerReader {
 public:
  LayerReader(const LandmarkType& type, const WebProjection& projection, WebLandmarks& into)
      : projection_(projection), into_(into), number_(static_cast<std::uint32_t>(into.layers.size())) {
    layer_.type = type;
    for (ExportColumn& column : export_columns(type))
      if (!kCovariances.contains(column.name)) columns_.push_back(std::move(column));
    for (const ExportColumn& column : columns_) layer_.keys.push_back(column.name);
    for (const char* key : {"x", "y", "z", "position_sd", "body", kHiddenKey}) layer_.keys.emplace_back(key);
    largest_.resize(type.features.size());
  }

  void add(const Landmark& landmark) {
    const auto world = projection_.to_world(landmark.position.xyz.x(), landmark.position.xyz.y());
    if (!world) {
      ++into_.outside;
      return;
    }
    for (std::size_t i = 0; i < largest_.size(); ++i)
      if (const double value = std::abs(value_of(landmark, i)); value > largest_[i]) largest_[i] = value;
    merits_.push_back(merit_of(layer_.type, landmark));
    merits_.back().landmark = into_.landmarks.size();
    const std::size_t first = into_.properties.size();
    append_properties(landmark, world->y());
    WebLandmark point{.layer = number_,
                      .first = first,
                      .size = static_cast<std::uint32_t>(into_.properties.size() - first)};
    point.x = static_cast<std::uint64_t>(std::ldexp(world->x(), kStepZoom));
    point.y = static_cast<std::uint64_t>(std::ldexp(world->y(), kStepZoom));
    constexpr int zoom = kMaxWebZoom + kCellZoom;
    point.curve = hilbert_of({zoom, static_cast<std::uint32_t>(point.x >> (kStepZoom - zoom)),
                              static_cast<std::uint32_t>(point.y >> (kStepZoom - zoom))});
    into_.landmarks.push_back(point);
  }

  void finish() {
    if (merits_.empty()) return;
    std::ranges::sort(merits_, std::less{});
    for (std::size_t i = 0; i < merits_.size(); ++i)
      into_.landmarks[merits_[i].landmark].rank = static_cast<std::uint32_t>(i);
    layer_.count = static_cast<std::int64_t>(merits_.size());
    for (std::size_t i = 0; i < largest_.size(); ++i) {
      const FeatureSpec& feature = layer_.type.features[i];
      layer_.features.push_back(
          {feature.name, title_of(feature.name), feature.summary, number_format(feature, largest_[i])});
    }
    into_.layers.push_back(std::move(layer_));
  }

 private:
  void append_properties(const Landmark& landmark, double world_y) {
    std::string& bytes = into_.properties;
    std::uint32_t key = 0;
    for (const ExportColumn& column : columns_) append_property(bytes, key++, column.value(landmark));
    for (int axis = 0; axis < 3; ++axis) append_real(bytes, key++, landmark.position.xyz(axis), true);
    const double variance = (landmark.covariance(0, 0) + landmark.covariance(1, 1)) / 2;
    append_real(bytes, key++, variance > 0 ? std::sqrt(variance) : std::nan(""));
    const BodySize& body = layer_.type.body;
    const double radius = body.radius_per_value * value_of(landmark, find_feature(layer_.type, body.feature));
    if (!(radius > 0)) return;
    const double widths = radius / projection_.world_width(world_y);
    append_real(bytes, key, widths);
    layer_.max_body = std::max(layer_.max_body, widths);
  }

  const WebProjection& projection_;
  WebLandmarks& into_;
  std::uint32_t number_;
  WebLayer layer_;
  std::vector<ExportColumn> columns_;
  std::vector<double> largest_;
  std::vector<Merit> merits_;
};

}  // namespace

WebLandmarks read_web_landmarks(const geodb::MapStore& map, const WebProjection& projection,
                                const std::vector<std::string>& types, double min_confidence) {
  for (const std::string& name : types) map.count(name);  // throws for an unknown name
  WebLandmarks all;
  for (const LandmarkType& type : map.types()) {
    if (!types.empty() && std::ranges::count(types, type.name) == 0) continue;
    LayerReader reader(type, projection, all);
    map.visit(type.name, [&](Landmark&& landmark) {
      if (landmark.confidence >= min_confidence) reader.add(landmark);
    });
    reader.finish();
  }
  std::ranges::sort(all.landmarks, std::less{},
                    [](const WebLandmark& l) { return std::tuple(l.curve, l.layer, l.rank); });
  return all;
}

WebBounds bounds_of(const std::vector<WebLandmark>& landmarks) {
  if (landmarks.empty()) return {};
  const auto [north, south] = std::ranges::minmax(landmarks, {}, &WebLandmark::y);
  std::vector<std::uint64_t> columns(landmarks.size());
  std::ranges::transform(landmarks, columns.begin(), &WebLandmark::x);
  std::ranges::sort(columns);
  constexpr std::uint64_t turn = std::uint64_t{1} << kStepZoom;
  std::uint64_t widest = columns.front() + turn - columns.back();  // the gap across the edge of the world
  std::uint64_t west = columns.front(), east = columns.back();
  for (std::size_t i = 1; i < columns.size(); ++i)
    if (columns[i] - columns[i - 1] > widest) {
      widest = columns[i] - columns[i - 1];
      west = columns[i];
      east = columns[i - 1] + turn;
    }
  const auto part = [](std::uint64_t steps) { return std::ldexp(static_cast<double>(steps), -kStepZoom); };
  return {part(west), part(north.y), part(east), part(south.y)};
}

}  // namespace waymark::exporters
