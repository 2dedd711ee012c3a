// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "importers/logs/bag_file.hpp"
#include "importers/logs/cdr.hpp"
namespace waymark::importers {

// Messages of ROS 2 that are read. Functions throw std::runtime_error for a message that ends too early or
// states values that cannot be.

/// Time and frame of a message.
struct BagStamp {
  double t = 0;  ///< s; of the recorder where the message has none
  std::string frame;
};
BagStamp read_stamp(CdrReader& in, std::int64_t received);

/// Reads a translation and a quaternion.
Eigen::Isometry3d read_transform(CdrReader& in);

/// nav_msgs/msg/Odometry.
struct BagOdometry {
  BagStamp at;
  std::string body;  ///< frame that the pose is of
  Eigen::Isometry3d pose;
  double yaw_variance = 0;  ///< rad^2, as stated; 0: not stated
};
BagOdometry read_odometry(const BagMessage& message);

/// geometry_msgs/msg/PoseStamped and PoseWithCovarianceStamped.
struct BagPose {
  BagStamp at;  ///< its frame is that in which the pose is stated
  Eigen::Isometry3d pose;
  double yaw_variance = 0;  ///< rad^2, as stated; 0: not stated
};
BagPose read_pose(const BagMessage& message, bool has_covariance);

/// sensor_msgs/msg/Imu.
struct BagImu {
  BagStamp at;
  std::optional<Eigen::Vector3d> rate;            ///< rad/s in the frame of the sensor; absent: not measured
  double rate_variance = 0;                       ///< (rad/s)^2 about z; 0: not stated
  std::optional<Eigen::Quaterniond> orientation;  ///< of the sensor in the world; absent: not measured
  double yaw_variance = 0;                        ///< rad^2; 0: not stated
};
BagImu read_imu(const BagMessage& message);

/// sensor_msgs/msg/NavSatFix.
struct BagFix {
  BagStamp at;
  bool is_fix = false;                             ///< false: the receiver had none; the rest is not set
  double longitude = 0, latitude = 0;              ///< degrees, WGS 84
  std::optional<Eigen::Matrix2d> covariance = {};  ///< m2, of east and north; unknown: not stated
};
BagFix read_fix(const BagMessage& message);

/// Reads the points of sensor_msgs/msg/PointCloud2 in the frame of the scanner: fields x, y, z at any
/// offsets, of any numeric types, in either byte order, with padding between points and rows; strengths from
/// the field intensity, else reflectivity. Other fields and points that are not finite are left out. Memory
/// is bounded by the size of the message.
struct BagCloud {
  BagStamp at;
  std::vector<Eigen::Vector3f> points;
  std::vector<float> intensities;  ///< one per point; empty: not measured
};
BagCloud read_cloud(const BagMessage& message);

/// Reads the stamp of a point cloud alone.
BagStamp read_cloud_stamp(const BagMessage& message);

}  // namespace waymark::importers
