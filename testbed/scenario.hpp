// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "testbed/drive/drive_settings.hpp"
#include "testbed/forest/forest_law.hpp"
#include "testbed/ground.hpp"
#include "testbed/render.hpp"
namespace waymark {

/// The camera every flight carries: Brown's lens model, square pixels, principal point in the middle.
struct Lens {
  std::int64_t columns = 800, rows = 800;
  Degrees field_of_view{50};  ///< across the columns, without the distortion
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};
Camera camera_of(const Lens& lens);

/// Pictures along a straight path, or along parallel ones. Places in metres from the middle of the site,
/// altitudes above its height `up`. Where the altitude changes it does so by equal factors, as in a descent.
struct Flight {
  std::string name = "descent";  ///< its images are <name>_0001.png, ...
  std::int64_t images = 16;      ///< per line
  std::int64_t lines = 1;        ///< parallel lines, flown to and fro
  double line_spacing = 0;       ///< metres
  double from_east = -100, from_north = -100, from_altitude = 500;
  double to_east = 60, to_north = 60, to_altitude = 120;
  Degrees tilt{0};           ///< of the view, from straight down towards the heading
  Degrees attitude_sd{1.5};  ///< how much the attitude wavers, about each camera axis
  double track_sd = 2;       ///< metres, how much the path wavers
};

/// What is told about the poses: truth plus errors of these standard deviations.
struct PoseErrors {
  double position_sd = 0;  ///< metres, each axis
  Degrees attitude_sd{0};  ///< about each camera axis
};

/// The DEM that goes with the images: coarser than the ground and not exact.
struct DemModel {
  double cell = 2;          ///< metres
  double height_sd = 0.1;   ///< metres
  double correlation = 10;  ///< metres over which its errors agree
};

struct Scenario {
  std::string name = "A made landing site";
  std::string crs = "local";  ///< of the grid frame: local, or a projected CRS
  std::int64_t seed = 1;
  MadeGround ground;  ///< width or height 0: as much as the images see
  Exposure exposure;
  std::int64_t bits = 8;  ///< of the images: 8 or 16
  Lens lens;
  std::vector<Flight> flights = {Flight{}};
  PoseErrors pose_errors;
  DemModel dem;
  DriveSettings drive;  ///< `on` where the file has the section
  ForestLaw forest;     ///< `on` where the file has the section
};

/// Reads a scenario (docs/testbed.md). `source` names the file in messages. Throws Error{usage} with the JSON
/// path for what is missing, unknown, out of range or of the wrong kind.
Scenario read_scenario(std::string_view json, const std::string& source);

/// Every section with its fields, defaults, units and ranges as a JSON schema.
std::string scenario_schema();

/// The scenario with every value written out.
std::string scenario_json(const Scenario& scenario);

}  // namespace waymark
