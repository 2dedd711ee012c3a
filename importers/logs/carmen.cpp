// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/odometry_steps.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kMaxBeams = 100'000;
constexpr double kMaxRange = 80;  // m: scanners of these logs write 81 m and more for no return
constexpr double kMaxAngle = 4 * std::numbers::pi;
// Robots of these logs have wheels of unequal diameter (Borenstein & Feng 1996): they drift by degrees per
// metre.
constexpr localization::OdometryDrift kDrift{.scale_sd = 0.03, .curvature_sd = 0.03};

/// Words of a line, taken one by one; `valid` is false after a word that is missing or no number.
class CarmenWords {
 public:
  explicit CarmenWords(std::string_view line) : rest_(line) {}

  std::string_view word() {
    const std::size_t from = rest_.find_first_not_of(" \t\r");
    if (from == std::string_view::npos) {
      valid_ = false;
      return {};
    }
    const std::size_t to = std::min(rest_.find_first_of(" \t\r", from), rest_.size());
    const std::string_view found = rest_.substr(from, to - from);
    rest_.remove_prefix(to);
    return found;
  }
  double number() {
    const std::string_view text = word();
    double value = std::nan("");
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    valid_ = valid_ && problem == std::errc() && end == text.data() + text.size();
    return value;
  }
  std::size_t count() {
    const double n = number();
    valid_ = valid_ && n >= 0 && n <= static_cast<double>(kMaxBeams) && n == std::floor(n);
    return valid_ ? static_cast<std::size_t>(n) : 0;
  }
  localization::Pose2 pose() {
    localization::Pose2 p;
    p.x = number(), p.y = number(), p.yaw = number();
    valid_ = valid_ && p.finite();
    return p;
  }
  void skip(int words) {
    for (int i = 0; i < words; ++i) word();
  }
  bool valid() const { return valid_; }

 private:
  std::string_view rest_;
  bool valid_ = true;
};

class CarmenReader {
 public:
  explicit CarmenReader(const std::filesystem::path& file) : file_(file) {}

  void read(std::string_view line, std::size_t number) {
    CarmenWords words(line);
    const std::string_view kind = words.word();
    if (!words.valid() || kind.front() == '#') return;
    bool sound = true;
    if (kind == "PARAM")
      param(words);
    else if (kind == "ODOM")
      sound = odometry(words);
    else if (kind == "FLASER" || kind == "RLASER")
      sound = old_laser(words, kind == "RLASER");
    else if (kind == "ROBOTLASER1" || kind == "ROBOTLASER2")
      sound = robot_laser(words);
    else
      ++others_;
    if (sound) return;
    if (++unsound_ == 1) first_unsound_ = number;
  }

  localization::RobotLog take() {
    if (poses_.empty())
      throw Error(ErrorCode::input,
                  unsound_
                      ? fmt::format("no line of the CARMEN log can be read; the first bad one is line {}",
                                    first_unsound_)
                      : "the CARMEN log has neither odometry nor scans",
                  file_.string(), "ODOM, FLASER, RLASER and ROBOTLASER1 are read");
    if (unsound_)
      log_.remarks.push_back(
          fmt::format("{} lines are cut off or hold no numbers and are skipped, the first is line {}",
                      unsound_, first_unsound_));
    if (others_) log_.remarks.push_back(fmt::format("{} lines of other messages are skipped", others_));
    if (scans_ > 0 && empty_scans_ > 0)
      log_.remarks.push_back(fmt::format("{} of {} scans have no return", empty_scans_, scans_));
    if (beam_counts_.size() > 1)
      log_.remarks.push_back(fmt::format("scans have from {} to {} beams; each is read with its own",
                                         beam_counts_.begin()->first, beam_counts_.rbegin()->first));
    add_odometry_steps(log_, std::move(poses_));  // messages come late and out of order
    log_.drift = kDrift;
    localization::clean_log(log_);
    return std::move(log_);
  }

 private:
  void param(CarmenWords& words) {
    const std::string_view name = words.word();
    if (name == "robot_frontlaser_offset" || name == "robot_front_laser_offset") {
      const double offset = words.number();
      if (words.valid()) front_offset_ = offset;
    }
    if (name == "robot_rearlaser_offset" || name == "robot_rear_laser_offset") {
      const double offset = words.number();
      if (words.valid()) rear_offset_ = offset;
    }
  }

  // x y theta tv rv accel time host logger_time
  bool odometry(CarmenWords& words) {
    const localization::Pose2 pose = words.pose();
    words.skip(3);
    const double t = words.number();
    if (!words.valid()) return false;
    check_angle(pose.yaw);
    step_to(pose, t);
    return true;
  }

  // n ranges, pose of the laser, pose of the robot, time host logger_time. 180 beams begin at -90 degrees,
  // one degree apart; an odd number ends at +90 degrees.
  bool old_laser(CarmenWords& words, bool rear) {
    const std::size_t n = words.count();
    std::vector<float> ranges = numbers(words, n);
    words.pose();
    const localization::Pose2 pose = words.pose();
    const double t = words.number();
    if (!words.valid() || n < 2) return false;
    check_angle(pose.yaw);
    const double step = std::numbers::pi / static_cast<double>(n % 2 == 0 ? n : n - 1);
    add_scan({.robot_from_sensor = {rear ? rear_offset_ : front_offset_, 0, rear ? std::numbers::pi : 0},
              .first_angle = -std::numbers::pi / 2,
              .angle_step = step,
              .ranges = std::move(ranges),
              .max_range = kMaxRange},
             pose, t);
    return true;
  }

  // type start field resolution max_range accuracy remission_mode, n ranges, n remissions, pose of the laser,
  // pose of the robot, tv rv safety(3), time host logger_time.
  bool robot_laser(CarmenWords& words) {
    words.skip(1);
    const double start = words.number();
    words.skip(1);
    const double step = words.number(), max_range = words.number();
    words.skip(2);
    const std::size_t n = words.count();
    std::vector<float> ranges = numbers(words, n);
    const std::size_t remissions = words.count();
    numbers(words, remissions);
    const localization::Pose2 laser = words.pose(), pose = words.pose();
    words.skip(5);
    const double t = words.number();
    if (!words.valid() || n < 2 || !(step > 0) || !(max_range > 0)) return false;
    check_angle(pose.yaw);
    check_angle(start);
    check_angle(static_cast<double>(n) * step);
    add_scan({.robot_from_sensor = inverse(pose) * laser,
              .first_angle = start,
              .angle_step = step,
              .ranges = std::move(ranges),
              .max_range = std::min(max_range, kMaxRange)},
             pose, t);
    return true;
  }

  static std::vector<float> numbers(CarmenWords& words, std::size_t n) {
    std::vector<float> all;
    all.reserve(n);
    for (std::size_t i = 0; i < n && words.valid(); ++i) all.push_back(static_cast<float>(words.number()));
    return all;
  }

  void check_angle(double angle) const {
    if (!(std::abs(angle) <= kMaxAngle))
      throw Error(ErrorCode::input, fmt::format("an angle is {:g}: angles of CARMEN logs are radians", angle),
                  file_.string(), "convert degrees to radians");
  }

  void add_scan(localization::LaserScan scan, const localization::Pose2& pose, double t) {
    step_to(pose, t);
    ++scans_;
    ++beam_counts_[scan.ranges.size()];
    bool any = false;
    for (const float r : scan.ranges) any = any || (r > 0 && static_cast<double>(r) < scan.max_range);
    empty_scans_ += !any;
    log_.events.push_back({t, std::move(scan)});
  }

  void step_to(const localization::Pose2& pose, double t) { poses_.push_back({t, pose}); }

  const std::filesystem::path& file_;
  localization::RobotLog log_;
  std::vector<localization::StampedPose> poses_;  // by odometry
  double front_offset_ = 0, rear_offset_ = 0;
  std::size_t unsound_ = 0, first_unsound_ = 0, others_ = 0, scans_ = 0, empty_scans_ = 0;
  std::map<std::size_t, std::size_t> beam_counts_;
};

}  // namespace

localization::RobotLog import_carmen_log(const std::filesystem::path& file) {
  const std::string text = read_text(file, "the file");
  if (text.starts_with("BZh") || text.starts_with("\x1f\x8b"))
    throw Error(ErrorCode::input, "the log is packed", file.string(),
                "unpack it with bunzip2 or gunzip first");
  CarmenReader reader(file);
  std::size_t number = 0;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    reader.read(std::string_view(text).substr(from, end - from), ++number);
    from = end + 1;
  }
  return reader.take();
}

}  // namespace waymark::importers
