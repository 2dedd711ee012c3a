// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "core/options.hpp"
#include "core/units.hpp"
namespace waymark::planning {

/// Wheel or foot of a vehicle, on level terrain. The origin is the middle of the vehicle.
struct Support {
  Meters x, y;      ///< forwards, to the left
  Meters diameter;  ///< of the wheel or the foot
  Meters width;     ///< of the wheel; of a foot its diameter

  void describe(OptionVisitor& option);
};

/// Vehicle: what touches the terrain, and the relief that it can stand or drive on.
struct Vehicle {
  std::string name;  ///< stem of its file
  std::string summary;
  std::string suspension = "rigid";  ///< rigid, rocker_bogie, bogie
  Degrees max_slope{20};
  Meters max_roughness{0.1};  ///< root mean square of the heights about the plane under the vehicle
  Meters max_step{0.3};       ///< change of height over a wheel's diameter beyond that of the plane
  Meters max_obstacle{0.3};   ///< height of a rock
  Meters belly_clearance{0.5};
  double mass = 0;           ///< kg; 0: unknown
  Meters centre_of_mass{0};  ///< height above level terrain, above the middle; 0: unknown
  std::vector<Support> supports;

  void describe(OptionVisitor& option);
  /// Returns the radius of the disc about the middle that holds all supports: the base.
  double base_radius() const;
  /// Returns the smallest diameter of a support, metres.
  double support_diameter() const;
  /// Returns the width of the track that the supports cover, metres.
  double track_width() const;
  /// Returns the height of the smallest rock that stops the vehicle, metres.
  double obstacle_height() const;
};

/// Reads a vehicle file (docs/reference/vehicle.md). `source` names the file in messages. Throws Error{usage}
/// for options that are unknown or out of range, fewer than three supports, and supports that are not
/// symmetric about the x axis.
Vehicle parse_vehicle(std::string_view json, const std::string& name, const std::string& source);

/// Returns a built-in vehicle by name, or reads the file of that path. Throws Error{usage} with the nearest
/// name if there is neither.
Vehicle find_vehicle(const std::string& name_or_file);

/// Vehicle file that is compiled in.
struct VehicleFile {
  std::string_view name, json;
};
std::vector<VehicleFile> vehicle_files();

/// Returns the vehicles of planning/vehicles, sorted by name.
std::vector<Vehicle> built_in_vehicles();

}  // namespace waymark::planning
