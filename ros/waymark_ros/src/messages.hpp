// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>
namespace waymark::ros {

// Messages of ROS as values, with what the session reads and writes of them. Units and axes are those of
// REP 103: metres, radians, x forward, y left.

using Stamp = std::int64_t;                  ///< ns
using Covariance3 = std::array<double, 9>;   ///< row-major; a first element of -1: not measured
using Covariance6 = std::array<double, 36>;  ///< row-major: x, y, z, turns about x, y, z

/// geometry_msgs/Pose. The quaternion is as stated, perhaps not of length 1.
struct Pose {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};

/// nav_msgs/Odometry.
struct Odometry {
  Stamp stamp = 0;
  std::string frame = {}, body = {};  ///< header.frame_id, child_frame_id
  Pose pose = {};
  double forward = 0, left = 0, turn = 0;  ///< twist of the body: m/s, m/s, rad/s
};

/// sensor_msgs/LaserScan.
struct Scan {
  Stamp stamp = 0;
  std::string frame = {};
  float angle_min = 0, angle_increment = 0, range_min = 0, range_max = 0;
  std::vector<float> ranges = {}, intensities = {};
};

/// sensor_msgs/NavSatFix.
struct Fix {
  Stamp stamp = 0;
  std::string frame = {};
  int status = 0;                      ///< -1: no fix
  double latitude = 0, longitude = 0;  ///< degrees, WGS 84
  Covariance3 covariance{};            ///< east, north, up, m^2
  int covariance_type = 0;
};

/// sensor_msgs/Imu.
struct Imu {
  Stamp stamp = 0;
  std::string frame = {};
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< of the sensor, yaw from east
  Covariance3 orientation_covariance{-1};
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< rad/s in the frame of the sensor
  Covariance3 rate_covariance{-1};
};

/// geometry_msgs/PoseWithCovarianceStamped as RViz publishes it on /initialpose.
struct InitialPose {
  std::string frame = {};
  Pose pose = {};
  Covariance6 covariance{};
};

/// geometry_msgs/TransformStamped of /tf_static.
struct StaticTransform {
  std::string parent = {}, child = {};
  Pose parent_from_child = {};
};

/// Returns seconds of a stamp, as the reader of recordings does.
double seconds_of(Stamp stamp);

}  // namespace waymark::ros
