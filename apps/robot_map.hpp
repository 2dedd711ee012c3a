// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include "geodb/map_store.hpp"
#include "localization/ground.hpp"
#include "localization/identification/landmark_window.hpp"
namespace waymark {

/// A map file as a robot uses it.
struct RobotMap {
  std::shared_ptr<const MapStore> store;
  LocalFrame
      frame;  ///< about the middle of the map; of a local CRS about its origin, so that both are the same
  std::int64_t landmarks = 0;
  std::int64_t unsound_covariances = 0;  ///< of the landmarks read: not positive definite, mended
  Eigen::AlignedBox2d
      bounds;  ///< of the landmarks read, map frame; empty where they are read window by window

  const TypeRegistry& types() const { return store->types(); }
  const Crs& crs() const { return store->crs(); }
};

/// All landmarks, for a search of the whole map. `most`: above, none, as they would not fit into memory.
std::vector<MapLandmark> all_landmarks(const RobotMap& map, const SensorProfile* sensor,
                                       std::int64_t most = 3000000);

struct OpenedMap {
  RobotMap map;
  LandmarkWindow window;
};

/// The DEM under the map: of files, or, with none, the map's own coverage if it has one. Empty without.
/// Heights are those of the DEM, bilinear between cells. Throws Error where the DEM is of another body.
GroundHeight open_ground(const RobotMap& map, const std::vector<std::string>& dem_files);

/// Opens a map for a robot. Up to 200,000 landmarks are read at once; of larger maps the surroundings of the
/// robot, where the CRS is projected or local. `sensor`: whose quality counts; null: the confidence. Throws
/// Error{input} for a map without landmarks unless it `may_be_empty`.
OpenedMap open_robot_map(const std::string& file, const SensorProfile* sensor, bool may_be_empty = false);

/// A map without landmarks, with all types, in a local CRS: for methods that need none. Its file is private
/// and gone.
OpenedMap no_robot_map();

}  // namespace waymark
