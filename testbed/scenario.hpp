// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>
#include "core/options/option_reader.hpp"
#include "testbed/drive/drive_settings.hpp"
#include "testbed/forest/forest_model.hpp"
#include "testbed/landing/descent.hpp"
#include "testbed/render.hpp"
#include "testbed/site_model.hpp"
#include "testbed/town/town_model.hpp"
namespace waymark::testbed {

/// Camera of all flights: Brown distortion model, square pixels, principal point in the centre.
struct Lens {
  std::int64_t columns = 800, rows = 800;
  Degrees field_of_view{50};  ///< across the columns, without the distortion
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};
Camera camera_of(const Lens& lens);

/// Images along one straight path or several parallel ones, or along a landing. Positions in metres from the
/// centre of the site, altitudes above its height `up`.
/// - Lines: the altitude changes geometrically, as in a descent.
/// - Landing: images at equal times; the attitude is that of the lander, the camera looks down along its
/// axis.
struct Flight {
  std::string name = "descent";  ///< its images are <name>_0001.png, ...
  std::string path = "lines";    ///< or landing
  std::int64_t images = 16;      ///< per line
  std::int64_t lines = 1;        ///< parallel lines, flown to and fro
  double line_spacing = 0;       ///< metres
  double from_east = -100, from_north = -100, from_altitude = 500;
  double to_east = 60, to_north = 60, to_altitude = 120;
  Degrees tilt{0};            ///< of the view, from straight down towards the heading
  Degrees attitude_sd{1.5};   ///< variation of the attitude about each camera axis
  double track_sd = 2;        ///< metres, variation of the path
  DescentModel landing;       ///< of a landing, which has neither lines nor these deviations
  double dust = 0;            ///< of a landing: optical depth below the lander on the ground; 0: none
  double dust_altitude = 60;  ///< metres, below which the rockets raise dust
  double heat_shield = 0;     ///< of a landing: diameter of a shield that is released at its start; 0: none
  double heat_shield_speed =
      15;  ///< metres per second by which the shield falls faster than the lander begins
};

/// Errors of the reported poses: standard deviations.
struct PoseErrors {
  double position_sd = 0;  ///< metres, each axis
  Degrees attitude_sd{0};  ///< about each camera axis
};

/// DEM supplied with the images: coarser than the terrain and inexact.
struct DemModel {
  double cell = 2;          ///< metres
  double height_sd = 0.1;   ///< metres
  double correlation = 10;  ///< correlation length of its errors, metres
};

struct Scenario {
  std::string name = "A made landing site";
  std::string crs = "local";  ///< CRS of the grid frame: local, or projected
  std::int64_t seed = 1;
  SiteModel ground;  ///< width or height 0: the extent of the images
  Exposure exposure;
  std::int64_t bits = 8;  ///< of the images: 8 or 16
  Lens lens;
  std::vector<Flight> flights = {Flight{}};
  PoseErrors pose_errors;
  DemModel dem;
  DemModel orbital_dem{.cell = 0, .height_sd = 0.2, .correlation = 50};  ///< cell 0: none
  DriveSettings drive;                                                   ///< `on` if the file has the section
  ForestModel forest;                                                    ///< `on` if the file has the section
  StreetModel street;                                                    ///< the same
  HallModel hall;                                                        ///< the same
};

/// Reads a scenario (docs/reference/scenario.md). `source` names the file in messages. Throws Error{usage}
/// with the JSON path for fields that are missing, unknown, out of range or of the wrong kind. Warns of
/// fields that are given by their former names.
Scenario read_scenario(std::string_view json, const std::string& source, const OptionWarning& warn = {});

/// Returns the JSON schema of all sections: fields, defaults, units and ranges.
std::string scenario_schema();

/// Returns the scenario with all values as JSON.
std::string scenario_json(const Scenario& scenario);

}  // namespace waymark::testbed
