// SPDX-License-Identifier: Apache-2.0
// As much of ROS 2 as the node names, declared only: the test node_parses checks the node's syntax and types
// with it. Fields are those of the message definitions of Humble and Jazzy.
#pragma once
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

enum rcl_clock_type_t { RCL_ROS_TIME = 1 };
namespace builtin_interfaces::msg {
struct Time {
  std::int32_t sec;
  std::uint32_t nanosec;
};
}  // namespace builtin_interfaces::msg
namespace std_msgs::msg {
struct Header {
  builtin_interfaces::msg::Time stamp;
  std::string frame_id;
};
struct ColorRGBA {
  float r, g, b, a;
};
}  // namespace std_msgs::msg
namespace geometry_msgs::msg {
struct Point {
  double x, y, z;
};
struct Vector3 {
  double x, y, z;
};
struct Quaternion {
  double x, y, z, w;
};
struct Pose {
  Point position;
  Quaternion orientation;
};
struct PoseWithCovariance {
  Pose pose;
  std::array<double, 36> covariance;
};
struct PoseWithCovarianceStamped {
  using ConstSharedPtr = std::shared_ptr<const PoseWithCovarianceStamped>;
  std_msgs::msg::Header header;
  PoseWithCovariance pose;
};
struct Twist {
  Vector3 linear, angular;
};
struct TwistWithCovariance {
  Twist twist;
  std::array<double, 36> covariance;
};
struct Transform {
  Vector3 translation;
  Quaternion rotation;
};
struct TransformStamped {
  std_msgs::msg::Header header;
  std::string child_frame_id;
  Transform transform;
};
}  // namespace geometry_msgs::msg
namespace nav_msgs::msg {
struct Odometry {
  using ConstSharedPtr = std::shared_ptr<const Odometry>;
  std_msgs::msg::Header header;
  std::string child_frame_id;
  geometry_msgs::msg::PoseWithCovariance pose;
  geometry_msgs::msg::TwistWithCovariance twist;
};
}  // namespace nav_msgs::msg
namespace sensor_msgs::msg {
struct LaserScan {
  using ConstSharedPtr = std::shared_ptr<const LaserScan>;
  std_msgs::msg::Header header;
  float angle_min, angle_max, angle_increment, time_increment, scan_time, range_min, range_max;
  std::vector<float> ranges, intensities;
};
struct NavSatStatus {
  std::int8_t status;
  std::uint16_t service;
};
struct NavSatFix {
  using ConstSharedPtr = std::shared_ptr<const NavSatFix>;
  std_msgs::msg::Header header;
  NavSatStatus status;
  double latitude, longitude, altitude;
  std::array<double, 9> position_covariance;
  std::uint8_t position_covariance_type;
};
struct Imu {
  using ConstSharedPtr = std::shared_ptr<const Imu>;
  std_msgs::msg::Header header;
  geometry_msgs::msg::Quaternion orientation;
  std::array<double, 9> orientation_covariance;
  geometry_msgs::msg::Vector3 angular_velocity;
  std::array<double, 9> angular_velocity_covariance;
  geometry_msgs::msg::Vector3 linear_acceleration;
  std::array<double, 9> linear_acceleration_covariance;
};
}  // namespace sensor_msgs::msg
namespace tf2_msgs::msg {
struct TFMessage {
  using ConstSharedPtr = std::shared_ptr<const TFMessage>;
  std::vector<geometry_msgs::msg::TransformStamped> transforms;
};
}  // namespace tf2_msgs::msg
namespace diagnostic_msgs::msg {
struct KeyValue {
  std::string key, value;
};
struct DiagnosticStatus {
  unsigned char level;
  std::string name, message, hardware_id;
  std::vector<KeyValue> values;
};
struct DiagnosticArray {
  std_msgs::msg::Header header;
  std::vector<DiagnosticStatus> status;
};
}  // namespace diagnostic_msgs::msg
namespace visualization_msgs::msg {
struct Marker {
  static constexpr std::int32_t CYLINDER = 3, ADD = 0, DELETEALL = 3;
  std_msgs::msg::Header header;
  std::string ns;
  std::int32_t id, type, action;
  geometry_msgs::msg::Pose pose;
  geometry_msgs::msg::Vector3 scale;
  std_msgs::msg::ColorRGBA color;
};
struct MarkerArray {
  std::vector<Marker> markers;
};
}  // namespace visualization_msgs::msg
namespace rclcpp {
class Time {
 public:
  explicit Time(std::int64_t nanoseconds, rcl_clock_type_t clock);
  Time(const builtin_interfaces::msg::Time& stamp, rcl_clock_type_t clock = RCL_ROS_TIME);
  operator builtin_interfaces::msg::Time() const;
  std::int64_t nanoseconds() const;
};
class QoS {
 public:
  explicit QoS(std::size_t depth);
  QoS& transient_local();
  QoS& reliable();
  QoS& keep_last(std::size_t depth);
};
class SensorDataQoS : public QoS {
 public:
  SensorDataQoS();
};
class Parameter {
 public:
  const std::string& as_string() const;
  double as_double() const;
  std::int64_t as_int() const;
  bool as_bool() const;
};
class Logger {};
Logger get_logger(const std::string& name);
template <class Message>
class Publisher {
 public:
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const Message& message);
  std::size_t get_subscription_count() const;
};
template <class Message>
class Subscription {
 public:
  using SharedPtr = std::shared_ptr<Subscription>;
};
class TimerBase {
 public:
  using SharedPtr = std::shared_ptr<TimerBase>;
};
class Node {
 public:
  explicit Node(const std::string& name);
  template <class Value>
  void declare_parameter(const std::string& name, const Value& value);
  Parameter get_parameter(const std::string& name) const;
  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string& topic, const QoS& qos);
  template <class Message>
  typename Subscription<Message>::SharedPtr create_subscription(
      const std::string& topic, const QoS& qos, std::function<void(std::shared_ptr<const Message>)> callback);
  TimerBase::SharedPtr create_wall_timer(std::chrono::nanoseconds period, std::function<void()> callback);
  Time now() const;
  Logger get_logger() const;
  const char* get_name() const;
};
void init(int argc, char** argv);
void spin(std::shared_ptr<Node> node);
bool shutdown();
}  // namespace rclcpp
template <class... Values>
void ros_log(const rclcpp::Logger& logger, const char* format, const Values&... values);
#define RCLCPP_WARN(...) ros_log(__VA_ARGS__)
#define RCLCPP_FATAL(...) ros_log(__VA_ARGS__)
namespace tf2_ros {
class TransformBroadcaster {
 public:
  explicit TransformBroadcaster(rclcpp::Node& node);
  void sendTransform(const geometry_msgs::msg::TransformStamped& transform);
};
}  // namespace tf2_ros
