// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "exporters/web/gzip.hpp"
#include "exporters/web/vector_tile.hpp"

namespace waymark::exporters {
namespace {

std::uint64_t cell_on_curve(const WebLandmark& landmark, int zoom) {
  return landmark.curve >> (2 * (kMaxWebZoom + kCellZoom - zoom));
}

/// Calls `use(first, end)` for each run of landmarks in [begin, end) in the same cell of a grid of 2^zoom
/// cells per side.
template <class Use>
void for_each_cell(std::span<const WebLandmark> landmarks, std::size_t begin, std::size_t end, int zoom,
                   const Use& use) {
  for (std::size_t first = begin, next = begin; first < end; first = next) {
    while (next < end && cell_on_curve(landmarks[next], zoom) == cell_on_curve(landmarks[first], zoom))
      ++next;
    use(first, next);
  }
}

/// Appends the foremost landmark of each layer in a range.
void show_foremost(std::span<const WebLandmark> landmarks, std::size_t first, std::size_t end,
                   std::vector<ShownLandmark>& shown) {
  std::map<std::uint32_t, ShownLandmark> foremost;  // by layer
  for (std::size_t i = first; i < end; ++i) {
    const auto [found, is_new] = foremost.try_emplace(landmarks[i].layer, ShownLandmark{i, 0});
    if (is_new) continue;
    ++found->second.hidden;
    if (landmarks[i].rank < landmarks[found->second.landmark].rank) found->second.landmark = i;
  }
  for (const auto& [layer, one] : foremost) shown.push_back(one);
}

std::size_t fullest_tile(std::span<const WebLandmark> landmarks, int zoom) {
  std::size_t fullest = 0;
  for_each_cell(landmarks, 0, landmarks.size(), zoom,
                [&](std::size_t first, std::size_t end) { fullest = std::max(fullest, end - first); });
  return fullest;
}

}  // namespace

std::vector<ShownLandmark> thin_out(std::span<const WebLandmark> landmarks, int zoom) {
  std::vector<ShownLandmark> shown;
  for_each_cell(landmarks, 0, landmarks.size(), zoom, [&](std::size_t first, std::size_t end) {
    if (end - first <= kMaxPerTile) {
      for (std::size_t i = first; i < end; ++i) shown.push_back({i, 0});
      return;
    }
    for_each_cell(landmarks, first, end, zoom + kCellZoom,
                  [&](std::size_t a, std::size_t b) { show_foremost(landmarks, a, b, shown); });
  });
  return shown;
}

std::vector<ShownLandmark> all_of(std::span<const WebLandmark> landmarks) {
  std::vector<ShownLandmark> shown(landmarks.size());
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i].landmark = i;
  return shown;
}

int top_zoom(std::span<const WebLandmark> landmarks, double world_width) {
  const WebBounds bounds = bounds_of({landmarks.begin(), landmarks.end()});
  const double extent = std::max(bounds.east - bounds.west, bounds.south - bounds.north);
  const double max_step = std::max(1e-3 / world_width, 1e-5 * extent);
  for (int zoom = 0; zoom < kMaxWebZoom; ++zoom)
    if (std::ldexp(1.0 / VectorLayer::kExtent, -zoom) <= max_step &&
        fullest_tile(landmarks, zoom) <= kMaxPerTile)
      return zoom;
  return kMaxWebZoom;
}

std::vector<LandmarkTile> tiles_of(std::span<const WebLandmark> landmarks,
                                   std::span<const ShownLandmark> shown, int zoom) {
  std::vector<LandmarkTile> tiles;
  const int shift = kStepZoom - zoom;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const WebLandmark& one = landmarks[shown[i].landmark];
    const TileId id{zoom, static_cast<std::uint32_t>(one.x >> shift),
                    static_cast<std::uint32_t>(one.y >> shift)};
    if (tiles.empty() || tiles.back().id != id) tiles.push_back({id, i, 0});
    ++tiles.back().count;
  }
  return tiles;
}

std::string landmark_tile(const WebLandmarks& all, std::span<const ShownLandmark> shown, int zoom) {
  std::vector<VectorLayer> layers;
  for (const WebLayer& layer : all.layers) layers.push_back({.name = layer.type.name, .keys = layer.keys});
  std::deque<std::string> counts;
  const int shift = kMaxWebZoom - zoom;
  for (const ShownLandmark& one : shown) {
    const WebLandmark& landmark = all.landmarks[one.landmark];
    TilePoint point{.id = landmark.rank + std::uint64_t{1},
                    .x = static_cast<std::uint32_t>(landmark.x >> shift & (VectorLayer::kExtent - 1)),
                    .y = static_cast<std::uint32_t>(landmark.y >> shift & (VectorLayer::kExtent - 1))};
    point.properties.push_back(std::string_view(all.properties).substr(landmark.first, landmark.size));
    VectorLayer& layer = layers[landmark.layer];
    if (one.hidden > 0) {
      append_property(counts.emplace_back(), static_cast<std::uint32_t>(layer.keys.size() - 1), one.hidden);
      point.properties.push_back(counts.back());
    }
    layer.points.push_back(std::move(point));
  }
  return gzip(encode_vector_tile(layers));
}

}  // namespace waymark::exporters
