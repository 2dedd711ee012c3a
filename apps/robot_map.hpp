// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include "geodb/map_store.hpp"
#include "localization/landmark_window.hpp"
namespace waymark {

/// A map file as a robot uses it.
struct RobotMap {
  std::shared_ptr<const MapStore> store;
  LocalFrame
      frame;  ///< about the middle of the map; of a local CRS about its origin, so that both are the same
  std::int64_t landmarks = 0;
  Eigen::AlignedBox2d
      bounds;  ///< of the landmarks read, map frame; empty where they are read window by window

  const TypeRegistry& types() const { return store->types(); }
  const Crs& crs() const { return store->crs(); }
};

struct OpenedMap {
  RobotMap map;
  LandmarkWindow window;
};

/// Opens a map for a robot. Up to 200,000 landmarks are read at once; of larger maps the surroundings of the
/// robot, where the CRS is projected or local. `sensor`: whose quality counts; null: the confidence. Throws
/// Error{input} for a map without landmarks unless it `may_be_empty`.
OpenedMap open_robot_map(const std::string& file, const SensorProfile* sensor, bool may_be_empty = false);

}  // namespace waymark
