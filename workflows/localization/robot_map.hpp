// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include "geo/dem_source.hpp"
#include "geodb/map_store.hpp"
#include "localization/identification/landmark_window.hpp"
#include "localization/terrain_pose.hpp"
namespace waymark::workflows {

/// Map file as a robot uses it.
struct RobotMap {
  std::shared_ptr<const geodb::MapStore> store;
  LocalFrame frame;  ///< about the middle of the map; in a local CRS about its origin, so that both agree
  std::int64_t landmarks = 0;
  std::vector<TypeId> held_types = {};   ///< those with landmarks of `min_confidence`; others may have tables
  double min_confidence = 0;             ///< less probable landmarks are not read
  std::int64_t unsound_covariances = 0;  ///< of the landmarks read: not positive definite, repaired
  double survey_sd = 0;        ///< m, of an imported map: accuracy that half of the landmarks have; else 0
  Eigen::AlignedBox2d bounds;  ///< of the landmarks read, map frame; empty if they are read by windows

  const TypeRegistry& types() const { return store->types(); }
  const Crs& crs() const { return store->crs(); }
};

/// Returns all landmarks for global localization; none above `max_count`, as they would not fit into memory.
std::vector<localization::MapLandmark> all_landmarks(const RobotMap& map, const SensorProfile* sensor,
                                                     std::int64_t max_count = 3000000);

struct OpenedMap {
  RobotMap map;
  localization::LandmarkWindow window;
};

/// Returns the DEM of files or, without files, the map's own coverage; null if there is none.
std::shared_ptr<const DemSource> open_dem(const RobotMap& map, const std::vector<std::string>& dem_files);

/// Returns terrain heights under the map from DEM files or, without files, from the map's own coverage; empty
/// if there is none. Bilinear between cells. Throws Error if the DEM is of another body.
localization::TerrainHeight open_terrain(const RobotMap& map, const std::vector<std::string>& dem_files);

/// Opens a map for a robot. Up to 200,000 landmarks are read at once; larger maps are read by windows around
/// the robot if the CRS is projected or local. `sensor` weighs quality; null: the confidence. Throws
/// Error{input} for a map without landmarks, or none of `min_confidence`, unless it `may_be_empty`.
OpenedMap open_robot_map(const std::string& file, const SensorProfile* sensor, bool may_be_empty = false,
                         double min_confidence = 0);

/// Returns a map without landmarks, with all types, in a local CRS. Its file is already deleted.
OpenedMap make_empty_robot_map();

}  // namespace waymark::workflows
