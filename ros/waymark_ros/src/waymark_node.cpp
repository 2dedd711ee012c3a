// SPDX-License-Identifier: Apache-2.0
// The ROS 2 node: declares parameters, converts messages and publishes. What it does with them is
// RobotSession.
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <exception>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <optional>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/imu.hpp>
#include <sensor_msgs/msg/laser_scan.hpp>
#include <sensor_msgs/msg/nav_sat_fix.hpp>
#include <sstream>
#include <string>
#include <tf2_msgs/msg/tf_message.hpp>
#include <utility>
#include <vector>
#include <visualization_msgs/msg/marker_array.hpp>

#include "robot_session.hpp"

namespace waymark::ros {
namespace {

Pose from_message(const geometry_msgs::msg::Point& at, const geometry_msgs::msg::Quaternion& turn) {
  return {{at.x, at.y, at.z}, {turn.w, turn.x, turn.y, turn.z}};
}

template <class Message>
void set_turn(Message& message, const Eigen::Quaterniond& turn) {
  message.x = turn.x(), message.y = turn.y(), message.z = turn.z(), message.w = turn.w();
}

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

OdometryUse odometry_use(const std::string& name) {
  if (name == "pose") return OdometryUse::pose;
  if (name == "pose_with_gyro") return OdometryUse::pose_with_gyro;
  if (name == "twist") return OdometryUse::twist;
  throw Error(ErrorCode::usage, "the parameter odometry is '" + name + "'", "",
              "pose, pose_with_gyro or twist");
}

class WaymarkNode final : public rclcpp::Node {
 public:
  /// Declares the parameters, no more.
  WaymarkNode() : Node("waymark") {
    declare_parameter("map", "");
    declare_parameter("method", "ekf");
    declare_parameter("sensor", "");
    declare_parameter("dem", "");
    declare_parameter("settings", "");
    declare_parameter("min_confidence", 0.0);
    declare_parameter("seed", 1);
    declare_parameter("threads", 0);
    declare_parameter("start", "");
    declare_parameter("odometry", "pose");
    declare_parameter("gyro_noise", 0.0);
    declare_parameter("map_frame", "map");
    declare_parameter("odom_frame", "odom");
    declare_parameter("base_frame", "base_link");
    declare_parameter("max_delay", 0.1);
    declare_parameter("max_gap", 1.0);
    declare_parameter("max_jump_back", 1.0);
    declare_parameter("publish_tf", true);
    declare_parameter("transform_tolerance", 0.2);
  }

  /// Opens the map and subscribes. Throws Error for parameters that will not do.
  void start() {
    SessionSettings settings;
    settings.request.map = text("map");
    if (settings.request.map.empty())
      throw Error(ErrorCode::usage, "the parameter map is empty", "", "give the path of a map (.gpkg)");
    settings.request.method = text("method");
    settings.request.sensor = text("sensor");
    if (!text("dem").empty()) settings.request.dem = {text("dem")};
    settings.request.set = words_of(text("settings"));
    settings.request.min_confidence = number("min_confidence");
    settings.request.seed = get_parameter("seed").as_int();
    settings.request.threads = get_parameter("threads").as_int();
    settings.start = text("start");
    settings.odometry = odometry_use(text("odometry"));
    settings.gyro_noise = number("gyro_noise");
    settings.map_frame = text("map_frame");
    settings.odom_frame = text("odom_frame");
    settings.base_frame = text("base_frame");
    settings.max_delay = number("max_delay");
    settings.max_gap = number("max_gap");
    settings.max_jump_back = number("max_jump_back");
    map_frame_ = settings.map_frame, odom_frame_ = settings.odom_frame;
    tolerance_ = static_cast<Stamp>(number("transform_tolerance") * 1e9);
    session_.emplace(std::move(settings));
    publish();
    subscribe();
    say_warnings();
  }

 private:
  std::string text(const std::string& name) const { return get_parameter(name).as_string(); }
  double number(const std::string& name) const { return get_parameter(name).as_double(); }

  void publish() {
    const rclcpp::QoS latched = rclcpp::QoS(1).transient_local().reliable();
    pose_out_ = create_publisher<geometry_msgs::msg::PoseWithCovarianceStamped>("~/pose", rclcpp::QoS(10));
    map_out_ = create_publisher<visualization_msgs::msg::MarkerArray>("~/map_markers", latched);
    sightings_out_ = create_publisher<visualization_msgs::msg::MarkerArray>("~/sightings", rclcpp::QoS(1));
    status_out_ = create_publisher<diagnostic_msgs::msg::DiagnosticArray>("/diagnostics", rclcpp::QoS(10));
    if (get_parameter("publish_tf").as_bool())
      transforms_ = std::make_unique<tf2_ros::TransformBroadcaster>(*this);
    map_out_->publish(markers(session_->map_markers(), now().nanoseconds()));
    timer_ = create_wall_timer(std::chrono::seconds(1), [this] { publish_status(); });
  }

  void subscribe() {
    const rclcpp::QoS sensors = rclcpp::SensorDataQoS();
    // A queue longer than that of SensorDataQoS: a step that is lost is motion that is lost.
    odometry_in_ = create_subscription<nav_msgs::msg::Odometry>(
        "odom", rclcpp::SensorDataQoS().keep_last(100),
        [this](nav_msgs::msg::Odometry::ConstSharedPtr m) { report(session_->take(from(*m))); });
    scan_in_ = create_subscription<sensor_msgs::msg::LaserScan>(
        "scan", sensors,
        [this](sensor_msgs::msg::LaserScan::ConstSharedPtr m) { report(session_->take(from(*m))); });
    fix_in_ = create_subscription<sensor_msgs::msg::NavSatFix>(
        "fix", sensors,
        [this](sensor_msgs::msg::NavSatFix::ConstSharedPtr m) { report(session_->take(from(*m))); });
    imu_in_ = create_subscription<sensor_msgs::msg::Imu>(
        "imu", rclcpp::SensorDataQoS().keep_last(100),
        [this](sensor_msgs::msg::Imu::ConstSharedPtr m) { report(session_->take(from(*m))); });
    start_in_ = create_subscription<geometry_msgs::msg::PoseWithCovarianceStamped>(
        "/initialpose", rclcpp::QoS(1),
        [this](geometry_msgs::msg::PoseWithCovarianceStamped::ConstSharedPtr m) {
          session_->take(InitialPose{m->header.frame_id,
                                     from_message(m->pose.pose.position, m->pose.pose.orientation),
                                     m->pose.covariance});
          say_warnings();
        });
    places_in_ = create_subscription<tf2_msgs::msg::TFMessage>(
        "/tf_static", rclcpp::QoS(100).transient_local().reliable(),
        [this](tf2_msgs::msg::TFMessage::ConstSharedPtr m) {
          for (const auto& one : m->transforms) {
            const auto& at = one.transform.translation;
            const auto& turn = one.transform.rotation;
            session_->take(StaticTransform{one.header.frame_id,
                                           one.child_frame_id,
                                           {{at.x, at.y, at.z}, {turn.w, turn.x, turn.y, turn.z}}});
          }
        });
  }

  /// Returns the stamp of a message; the time of the node's clock for drivers that set none.
  Stamp stamp_of(const std_msgs::msg::Header& header) const {
    const Stamp stamp = rclcpp::Time(header.stamp).nanoseconds();
    return stamp != 0 ? stamp : now().nanoseconds();
  }

  Odometry from(const nav_msgs::msg::Odometry& m) const {
    return {stamp_of(m.header),     m.header.frame_id,
            m.child_frame_id,       from_message(m.pose.pose.position, m.pose.pose.orientation),
            m.twist.twist.linear.x, m.twist.twist.linear.y,
            m.twist.twist.angular.z};
  }
  Scan from(const sensor_msgs::msg::LaserScan& m) const {
    return {stamp_of(m.header), m.header.frame_id, m.angle_min, m.angle_increment,
            m.range_min,        m.range_max,       m.ranges,    m.intensities};
  }
  Fix from(const sensor_msgs::msg::NavSatFix& m) const {
    return {stamp_of(m.header), m.header.frame_id,     m.status.status,           m.latitude,
            m.longitude,        m.position_covariance, m.position_covariance_type};
  }
  Imu from(const sensor_msgs::msg::Imu& m) const {
    const auto& turn = m.orientation;
    const auto& rate = m.angular_velocity;
    return {stamp_of(m.header),       m.header.frame_id,        {turn.w, turn.x, turn.y, turn.z},
            m.orientation_covariance, {rate.x, rate.y, rate.z}, m.angular_velocity_covariance};
  }

  void report(const PoseReports& reports) {
    for (const PoseReport& one : reports) {
      pose_out_->publish(pose_message(one));
      if (transforms_ && one.map_from_odom) transforms_->sendTransform(transform_message(one));
      if (one.looked && sightings_out_->get_subscription_count() > 0)
        sightings_out_->publish(markers(session_->sighting_markers(), one.stamp));
    }
    say_warnings();
  }

  geometry_msgs::msg::PoseWithCovarianceStamped pose_message(const PoseReport& one) const {
    geometry_msgs::msg::PoseWithCovarianceStamped m;
    m.header.stamp = rclcpp::Time(one.stamp, RCL_ROS_TIME);
    m.header.frame_id = map_frame_;
    m.pose.pose.position.x = one.at.pose.x, m.pose.pose.position.y = one.at.pose.y;
    m.pose.pose.position.z = one.z;
    set_turn(m.pose.pose.orientation, one.turn);
    m.pose.covariance = one.covariance;
    return m;
  }

  /// Returns map_from_odom. Its stamp lies ahead, so that others need not wait for the next one.
  geometry_msgs::msg::TransformStamped transform_message(const PoseReport& one) const {
    geometry_msgs::msg::TransformStamped m;
    m.header.stamp = rclcpp::Time(one.stamp + tolerance_, RCL_ROS_TIME);
    m.header.frame_id = map_frame_;
    m.child_frame_id = odom_frame_;
    const Eigen::Vector3d& at = one.map_from_odom->at;
    m.transform.translation.x = at.x(), m.transform.translation.y = at.y();
    m.transform.translation.z = at.z();
    set_turn(m.transform.rotation, one.map_from_odom->turn);
    return m;
  }

  visualization_msgs::msg::MarkerArray markers(const std::vector<Marker>& all, Stamp stamp) const {
    using Message = visualization_msgs::msg::Marker;
    visualization_msgs::msg::MarkerArray array;
    Message clear;
    clear.header.frame_id = map_frame_;
    clear.action = Message::DELETEALL;
    array.markers.push_back(clear);
    for (const Marker& one : all) {
      constexpr double kUnknownDiameter = 0.3;
      Message m;
      m.header.frame_id = map_frame_;
      m.header.stamp = rclcpp::Time(stamp, RCL_ROS_TIME);
      m.ns = one.name;
      m.id = static_cast<std::int32_t>(array.markers.size());
      m.type = Message::CYLINDER;
      m.action = Message::ADD;
      m.pose.position.x = one.at.x(), m.pose.position.y = one.at.y();
      m.pose.orientation.w = 1;
      m.scale.x = m.scale.y = one.diameter > 0 ? one.diameter : kUnknownDiameter;
      m.scale.z = one.name == "matched" || one.name == "rejected" ? 0.6 : 0.3;  // above the map's
      m.color.r = one.name == "rejected" ? 1.0F : 0.2F;
      m.color.g = one.name == "matched" ? 1.0F : 0.3F;
      m.color.b = one.name == "matched" || one.name == "rejected" ? 0.1F : 0.8F;
      m.color.a = 0.8F;
      array.markers.push_back(m);
    }
    return array;
  }

  void publish_status() {
    const SessionStatus status = session_->status();
    diagnostic_msgs::msg::DiagnosticArray m;
    m.header.stamp = now();
    diagnostic_msgs::msg::DiagnosticStatus& one = m.status.emplace_back();
    one.level = static_cast<unsigned char>(status.health);
    one.name = std::string(get_name()) + ": localization";
    one.message = status.message;
    one.hardware_id = "none";
    for (const auto& [key, value] : status.values) {
      diagnostic_msgs::msg::KeyValue& pair = one.values.emplace_back();
      pair.key = key, pair.value = value;
    }
    status_out_->publish(m);
  }

  void say_warnings() {
    for (const std::string& warning : session_->take_warnings())
      RCLCPP_WARN(get_logger(), "%s", warning.c_str());
  }

  std::optional<RobotSession> session_;
  std::string map_frame_, odom_frame_;
  Stamp tolerance_ = 0;
  std::unique_ptr<tf2_ros::TransformBroadcaster> transforms_;
  rclcpp::Publisher<geometry_msgs::msg::PoseWithCovarianceStamped>::SharedPtr pose_out_;
  rclcpp::Publisher<visualization_msgs::msg::MarkerArray>::SharedPtr map_out_, sightings_out_;
  rclcpp::Publisher<diagnostic_msgs::msg::DiagnosticArray>::SharedPtr status_out_;
  rclcpp::Subscription<nav_msgs::msg::Odometry>::SharedPtr odometry_in_;
  rclcpp::Subscription<sensor_msgs::msg::LaserScan>::SharedPtr scan_in_;
  rclcpp::Subscription<sensor_msgs::msg::NavSatFix>::SharedPtr fix_in_;
  rclcpp::Subscription<sensor_msgs::msg::Imu>::SharedPtr imu_in_;
  rclcpp::Subscription<geometry_msgs::msg::PoseWithCovarianceStamped>::SharedPtr start_in_;
  rclcpp::Subscription<tf2_msgs::msg::TFMessage>::SharedPtr places_in_;
  rclcpp::TimerBase::SharedPtr timer_;
};

}  // namespace
}  // namespace waymark::ros

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  int code = 0;
  try {
    const auto node = std::make_shared<waymark::ros::WaymarkNode>();
    node->start();
    rclcpp::spin(node);
  } catch (const std::exception& problem) {
    RCLCPP_FATAL(rclcpp::get_logger("waymark"), "%s", problem.what());
    code = 1;
  }
  rclcpp::shutdown();
  return code;
}
