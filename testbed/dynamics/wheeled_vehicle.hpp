// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "localization/terrain_pose.hpp"
#include "planning/vehicle.hpp"
#include "testbed/dynamics/driving_surface.hpp"
#include "testbed/dynamics/rigid_body.hpp"
#include "testbed/dynamics/soil.hpp"
#include "testbed/dynamics/suspension.hpp"
namespace waymark::testbed {

/// Body on wheels that roll, slip and sink: every wheel is driven at the speed of the command and steered to
/// its instantaneous centre of rotation. Deterministic. Cost: about 0.7 us per wheel and step of 2.5 ms.
class WheeledVehicle {
 public:
  /// Stands at rest on the surface, which must outlive it. `gravity`: m/s^2.
  /// Throws Error{usage} if the vehicle has no mass, or does not stand on known ground.
  WheeledVehicle(const planning::Vehicle& vehicle, const Soil& soil, double gravity,
                 const DrivingSurface& surface, const localization::Pose2& start);

  /// Drives for `seconds`. `speed`: m/s of the rims at the middle; `turn`: rad/s to the left. Throws
  /// Error{usage} if a wheel leaves the terrain.
  void drive(double speed, double turn, double seconds);

  /// Returns the pose of the point at ground level below the centre of mass, in the axes of the body.
  localization::TerrainPose pose() const;
  const RigidBody& body() const { return body_; }

  struct Wheel {
    Eigen::Vector2d at;            ///< m, forwards and left of the centre of mass
    double radius = 0, width = 0;  ///< m
    double load = 0;               ///< N along the vertical axis of the body
    double sinkage = 0;            ///< m
    double slip = 0;               ///< 1 - speed over ground / speed of the rim
    bool on_rock = false;
    Eigen::Vector2d shear = Eigen::Vector2d::Zero();  ///< m, of the soil, along and across the wheel
  };
  const std::vector<Wheel>& wheels() const { return wheels_; }
  const Suspension& suspension() const { return suspension_; }
  /// Returns whether the underside touches the ground.
  bool grounded() const;
  /// Returns whether the body leans by more than 60 degrees.
  bool tipped_over() const;

 private:
  void step(double speed, double turn, double dt);
  Wrench belly_forces() const;

  const DrivingSurface& surface_;
  Soil soil_;
  double gravity_, height_, clearance_;
  RigidBody body_;
  std::vector<Wheel> wheels_;
  Suspension suspension_;
};

}  // namespace waymark::testbed
