// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include "exporters/report/relief_picture.hpp"
#include "exporters/web/web_landmarks.hpp"
#include "exporters/web/web_projection.hpp"
#include "exporters/web/web_shapes.hpp"
namespace waymark::exporters {

/// What a style says of the map beside its tiles.
struct WebStyle {
  std::string title;
  Crs crs = Crs::local();
  WebPlane plane = WebPlane::mercator;
  WebBounds bounds = {};
  std::string terrain_caption = {};                   ///< empty: no terrain
  std::vector<Eigen::Vector2d> terrain_outline = {};  ///< on the world, not closed
  double terrain_lowest = 0;                          ///< metres
  std::optional<HypsometricTint> tint = {};           ///< of the terrain
  std::string version = {};                           ///< of Waymark
  std::vector<WebShapeLayer> shapes = {};             ///< layers of polygons
};

/// Names of the archives, relative to the style.
inline constexpr const char *kLandmarkTiles = "landmarks.pmtiles", *kTerrainTiles = "terrain.pmtiles",
                            *kShapeTiles = "shapes.pmtiles";

/// Returns the style (MapLibre style specification 8): relief under a layer of circles and labels for each
/// type in its colour, over polygons. Bowls are outlines; bodies are drawn to scale where they are large
/// enough to see. What the page shows of types, body and scale is in its `metadata`.
std::string web_style(const WebLandmarks& landmarks, const WebStyle& about);

/// Returns the metadata of an archive of the landmarks: TileJSON's `vector_layers`, for other programs.
std::string landmark_metadata(const WebLandmarks& landmarks, const WebStyle& about, int max_zoom);

}  // namespace waymark::exporters
