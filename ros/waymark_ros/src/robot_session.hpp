// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>
#include <waymark/robot.hpp>

#include "messages.hpp"
namespace waymark::ros {

/// What odometry messages are read for.
enum class OdometryUse {
  pose,            ///< steps between their poses
  pose_with_gyro,  ///< steps, with the yaw of the IMU's turn rates
  twist,           ///< speeds
};

struct SessionSettings {
  workflows::LocalizeRequest request;  ///< map, method, sensor, dem, set, min_confidence, seed, threads
  std::string start;                   ///< "X,Y,YAW" (m, rad), "none": search the map; empty: wait for a pose
  std::string map_frame = "map", odom_frame = "odom", base_frame = "base_link";
  OdometryUse odometry = OdometryUse::pose;
  double gyro_noise = 0;  ///< pose_with_gyro: variance of the yaw, rad^2/s; 0: noise of the settings
  /// s that a reading waits for older ones of other sensors. 0: none waits, and older ones are dropped.
  double max_delay = 0.1;
  double max_gap = 1;        ///< s between odometry messages; longer ones are counted
  double max_jump_back = 1;  ///< s by which messages of one sensor may be late; more: the clock was set back
};

/// Estimate after one reading.
struct PoseReport {
  Stamp stamp = 0;
  localization::PoseEstimate at;      ///< map_from_base
  double z = 0;                       ///< m, of the terrain; 0 where it is unknown
  Eigen::Quaterniond turn;            ///< roll and pitch of the terrain, yaw of `at`
  Covariance6 covariance{};           ///< of x, y and yaw; 0 for what is not estimated
  std::optional<Pose> map_from_odom;  ///< absent before the first odometry
  localization::LocalizationStatus status = {};
  int matched = 0, rejected = 0;  ///< sightings of this reading
  bool looked = false;            ///< the reading was compared with the map
};
using PoseReports = std::vector<PoseReport>;

/// A landmark or sighting in the map frame, for a display.
struct Marker {
  std::string name;  ///< landmark type, or "matched", "rejected"
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double diameter = 0;  ///< m; 0: unknown
};

enum class Health { ok, warning, error };  ///< as DiagnosticStatus

struct SessionStatus {
  Health health = Health::ok;
  std::string message;
  std::vector<std::pair<std::string, std::string>> values;  ///< counts since the start of the session
};

/// Localizes a robot by its messages. Fed with those of a recording, it gives the track that localize() gives
/// for the recording.
/// - Readings are taken in the order of their stamps, odometry first; `max_delay` bounds the wait. Older ones
///   are dropped and counted.
/// - If stamps of a sensor jump back, the session begins again at the start of the settings, or without one
///   at the last initial pose.
/// - Messages that cannot be used are dropped and counted by reason.
class RobotSession {
 public:
  /// Opens the map. Throws Error for a map, method or setting that will not do.
  explicit RobotSession(SessionSettings settings);

  /// Places a sensor on the robot, or a frame between both. A frame keeps its first place.
  void take(const StaticTransform& placed);
  /// Begins again at this pose.
  void take(const InitialPose& start);
  PoseReports take(const Odometry& message);
  PoseReports take(const Scan& message);
  PoseReports take(const Fix& message);
  PoseReports take(const Imu& message);
  /// Takes all that waits for older readings, as at the end of a recording.
  PoseReports flush();

  SessionStatus status() const;
  /// Returns the landmarks of the map; none of a map too large for memory.
  std::vector<Marker> map_markers() const;
  /// Returns the sightings of the last scan: landmarks that were matched, and where others were seen.
  std::vector<Marker> sighting_markers() const { return sighting_markers_; }
  /// Returns warnings since the last call, each text once.
  std::vector<std::string> take_warnings();

 private:
  struct Stepped {
    localization::StampedPose odom;  // as stated, from above
    double z = 0;
    double forward = 0, left = 0, turn = 0;
  };
  using Reading = std::variant<Stepped, localization::LaserScan, localization::GnssFix,
                               localization::HeadingFix>;  // those of one time are taken in this order
  struct Warnings {
    std::vector<std::string> fresh;
    std::set<std::string> known;
    void add(const std::string& text);
  };
  struct Waiting {
    Stamp stamp = 0;
    Reading what;
  };

  PoseReports wait(const std::string& sensor, Stamp stamp, std::optional<Reading> what);
  PoseReports release(std::optional<Stamp> before);
  void use(const Waiting& waiting, PoseReports& reports);
  void use(Stamp stamp, const Stepped& step, PoseReports& reports);
  void feed(Stamp stamp, localization::LogReading reading, PoseReports& reports);
  PoseReport report(Stamp stamp, bool looked) const;
  void begin(const std::optional<localization::PoseEstimate>& start);
  void begin_as_set();
  localization::Pose2 odom_from_base() const;
  void mark_sightings();
  std::optional<Eigen::Isometry3d> place_of(const std::string& frame);
  void drop(const std::string& reason);

  SessionSettings settings_;
  std::unique_ptr<workflows::LiveLocalizer> live_;
  importers::FrameTree frames_;
  std::deque<Waiting> waiting_;
  std::map<std::string, Stamp> newest_;  // by sensor
  std::optional<Stamp> released_;        // readings before it have been taken
  std::vector<importers::TurnRate> rates_;
  std::optional<Stepped> last_odometry_;
  localization::Pose2 odom_, reckoned_;  // odometry pose, and dead reckoning at that time
  std::optional<localization::PoseEstimate> initial_pose_;
  std::optional<PoseReport> last_report_;
  std::vector<Marker> sighting_markers_;
  std::map<std::string, std::int64_t> dropped_;                        // messages by reason
  std::shared_ptr<Warnings> warnings_ = std::make_shared<Warnings>();  // shared with the localizer
  std::int64_t taken_ = 0, restarts_ = 0, gaps_ = 0;
  double longest_gap_ = 0;
};

}  // namespace waymark::ros
