// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/formatting.hpp"
#include "exporters/web/web_projection.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark::geodb {
class MapStore;
}

namespace waymark::exporters {

/// Finest zoom of tiles, and the zoom of the grid of steps by which positions are stored.
inline constexpr int kMaxWebZoom = 22, kStepZoom = kMaxWebZoom + 12;
/// Thinning divides a tile into 2^kCellZoom cells per side.
inline constexpr int kCellZoom = 5;

/// Landmark on the world. The properties are those of append_property.
struct WebLandmark {
  std::uint64_t curve = 0;     ///< hilbert_of the cell at zoom kMaxWebZoom + kCellZoom
  std::uint64_t x = 0, y = 0;  ///< steps of zoom kStepZoom from the north-west
  std::uint32_t layer = 0;
  std::uint32_t rank = 0;  ///< in its layer, 0: the foremost
  std::uint64_t first = 0;
  std::uint32_t size = 0;  ///< of the properties, bytes
};

/// Layer of one landmark type.
struct WebLayer {
  struct Feature {
    std::string name, title, summary;
    NumberFormat format;
  };
  LandmarkType type;
  std::vector<std::string> keys = {};  ///< of properties, by number
  std::vector<Feature> features = {};
  std::int64_t count = 0;
  double max_body = 0;  ///< widths of the world; radius of the largest body
};

/// Landmarks of a map, about 300 bytes each.
struct WebLandmarks {
  std::vector<WebLayer> layers = {};        ///< of types that have landmarks, in the order of the map
  std::vector<WebLandmark> landmarks = {};  ///< in the order of the curve, then of layers and ranks
  std::string properties = {};
  std::int64_t outside = 0;  ///< landmarks beyond the edges of the world, left out
};

/// Key of the property that counts the landmarks of its type that a point of a coarse tile stands for.
inline constexpr const char* kHiddenKey = "hidden";

/// Reads the landmarks of `types`, all if empty, with at least `min_confidence`.
/// - Properties are the columns of an export without covariances, and `x`, `y`, `z` in the map's CRS,
///   `position_sd` (metres, horizontal), `body` (radius in widths of the world, where the type has a body).
/// - Ranks are by meaning: certified value of the type's size feature times confidence, or confidence for a
///   type without one; then quality; then uid.
/// Throws Error{usage} for a type that the map lacks.
WebLandmarks read_web_landmarks(const geodb::MapStore& map, const WebProjection& projection,
                                const std::vector<std::string>& types, double min_confidence);

/// Returns the rectangle that contains all landmarks; east > 1 if it crosses the edge of the world.
WebBounds bounds_of(const std::vector<WebLandmark>& landmarks);

}  // namespace waymark::exporters
