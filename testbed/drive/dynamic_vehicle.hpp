// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "testbed/drive/vehicle_motion.hpp"
#include "testbed/dynamics/wheeled_vehicle.hpp"
namespace waymark::testbed {

/// WheeledVehicle with the odometry of its wheels and a gyroscope: slip enters by the difference between rims
/// and ground.
class DynamicVehicle final : public VehicleMotion {
 public:
  /// Terrain, rocks and settings must outlive it. Throws as WheeledVehicle does.
  DynamicVehicle(const Terrain& terrain, std::span<const RockSolid> rocks, const DriveSettings& settings,
                 const localization::Pose2& start, std::uint64_t seed);

  const DriveStep& now() const override { return now_; }
  DriveStep step(const DriveCommand& command) override;
  /// Returns "tipped over", or "stuck" after a minute of driving without 20 cm of progress.
  std::string mishap() const override;

  const WheeledVehicle& vehicle() const { return vehicle_; }

 private:
  const DriveSettings& settings_;
  DrivingSurface surface_;
  WheeledVehicle vehicle_;
  Random random_;
  double scale_, bias_;
  std::size_t steps_ = 0;
  DriveStep now_;
  Eigen::Vector2d progress_at_;  // last position that was 20 cm from the one before
  double without_progress_ = 0;  // s of driving since
};

/// Slip of a vehicle that drives straight, all wheels bearing equal loads.
struct SteadySlip {
  double along = 0;   ///< fraction of the wheel distance lost while climbing
  double across = 0;  ///< m sideways per metre on a cross slope
};

/// Returns the slip on soil at a slope along and one across the vehicle, rad. 1 where the wheels cannot pull
/// that much.
SteadySlip steady_slip(const planning::Vehicle& vehicle, const Soil& soil, double gravity, double climb,
                       double cross);

}  // namespace waymark::testbed
