// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/error.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/number_table.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

// These constants are the same for all robots, and were fitted on robots 1 and 2 of set 6 against the truth.
// The odometry holds commands: a robot follows them late and moves less than commanded.
constexpr double kCommandDelay = 0.2, kSpeedFactor = 0.93,
                 kTurnFactor = 0.89;  // s, and fractions of the command
// Time the camera needs to find a bar code, s.
constexpr double kLatency = 0.05;
// Errors of ranges (with distance) and bearings, and how long one code is misread in the same way, seconds.
constexpr double kRangeSd = 0.03, kRangeSdPerMetre = 0.06, kBearingSd = 0.02;
constexpr localization::ErrorMemory kMemory{.range = 3, .bearing = 1};
constexpr localization::OdometryNoise kOdometry{.along_per_metre = 0.015,
                                                .across_per_metre = 2e-4,
                                                .yaw_per_metre = 0,
                                                .yaw_per_radian = 0.01,
                                                .position_per_second = 1e-6,
                                                .yaw_per_second = 3e-4};
constexpr int kRobots = 5;

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) ? path : path.parent_path();
}

/// Returns 3 for Robot3_Odometry.dat; 0 for other names.
std::int64_t robot_number(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.size() > 6 && name.starts_with("Robot") && name[5] >= '1' && name[5] <= '9' ? name[5] - '0' : 0;
}

std::string uid_of(int subject) {
  return std::to_string(subject);
}

/// Returns the number of a subject or bar code. Throws Error{input} if it is no whole number.
int whole_number(double number, const std::filesystem::path& file) {
  if (!(std::abs(number) < 1e9) || number != std::floor(number))
    throw Error(ErrorCode::input, fmt::format("the subject or bar code {} is no whole number", number),
                file.string(), "fetch the file again");
  return static_cast<int>(number);
}

/// Sightings of one camera frame: same time, nearby lines.
class Frames {
 public:
  void add(double t, const localization::SeenLandmark& sighting) {
    if (events_.empty() || events_.back().t != t) events_.push_back({t, localization::SightingSet{}});
    std::get<localization::SightingSet>(events_.back().what).sightings.push_back(sighting);
  }
  std::vector<localization::LogEvent> take() { return std::move(events_); }

 private:
  std::vector<localization::LogEvent> events_;
};

}  // namespace

localization::RobotLog import_mrclam_log(const std::filesystem::path& path, std::int64_t robot,
                                         const TypeRegistry& types) {
  const std::filesystem::path folder = folder_of(path);
  if (robot == 0) robot = robot_number(path);
  if (robot < 1 || robot > kRobots)
    throw Error(ErrorCode::usage, "an MRCLAM dataset has the robots 1 to 5: which one?", path.string(),
                "add --robot 1");
  const auto file = [&](const char* what) { return folder / fmt::format("Robot{}_{}.dat", robot, what); };

  std::map<double, int> subject_of;  // by bar code
  const auto code_file = folder / "Barcodes.dat";
  const auto codes = number_table(code_file, 2);
  for (std::size_t i = 0; i < codes.size(); i += 2)
    subject_of[whole_number(codes[i + 1], code_file)] = whole_number(codes[i], code_file);

  const std::optional<TypeId> beacon = find_self_identifying_type(types);
  Frames frames;
  std::size_t unknown = 0;
  const auto seen = number_table(file("Measurement"), 4);
  for (std::size_t i = 0; i < seen.size(); i += 4) {
    const auto subject = std::isnan(seen[i + 1]) ? subject_of.end() : subject_of.find(seen[i + 1]);
    unknown += subject == subject_of.end();
    localization::SeenLandmark s{.type = beacon,
                                 .bearing = seen[i + 3],
                                 .bearing_sd = kBearingSd,
                                 .range = seen[i + 2],
                                 .range_sd = std::hypot(kRangeSd, kRangeSdPerMetre * seen[i + 2]),
                                 .features = {},
                                 .identity = {}};
    if (subject == subject_of.end() || subject->second <= kRobots)
      s.type = localization::kNoSuchType;  // another robot, or a misread code
    if (subject != subject_of.end()) s.identity = localization::landmark_key(uid_of(subject->second));
    frames.add(seen[i] - kLatency, s);
  }
  localization::RobotLog log;
  for (const auto& [code, subject] : subject_of)
    log.names.emplace(localization::landmark_key(uid_of(subject)), uid_of(subject));
  log.in_crs = true;
  const auto odometry = number_table(file("Odometry"), 3);
  for (std::size_t i = 0; i < odometry.size(); i += 3)
    log.events.push_back(
        {odometry[i] + kCommandDelay,
         localization::TwistReading{kSpeedFactor * odometry[i + 1], 0, kTurnFactor * odometry[i + 2]}});
  log.error_memory = kMemory;
  log.odometry = kOdometry;
  for (localization::LogEvent& e : frames.take()) log.events.push_back(std::move(e));
  std::ranges::stable_sort(log.events, {}, &localization::LogEvent::t);
  if (std::filesystem::exists(file("Groundtruth"))) {
    const auto truth = number_table(file("Groundtruth"), 4);
    for (std::size_t i = 0; i < truth.size(); i += 4)
      log.truth.push_back({truth[i], {truth[i + 1], truth[i + 2], truth[i + 3]}});
  }
  if (unknown)
    log.remarks.push_back(fmt::format("{} sightings of bar codes that are not in Barcodes.dat", unknown));
  localization::clean_log(log);
  return log;
}

std::vector<Landmark> import_mrclam_landmarks(const std::filesystem::path& path, TypeId type,
                                              const LandmarkType& declared) {
  const auto file = std::filesystem::is_directory(path) ? path / "Landmark_Groundtruth.dat" : path;
  const auto rows = number_table(file, 5);
  std::vector<Landmark> all;
  for (std::size_t i = 0; i < rows.size(); i += 5) {
    Landmark landmark;
    landmark.uid = uid_of(whole_number(rows[i], file));
    landmark.type = type;
    landmark.position.xyz << rows[i + 1], rows[i + 2], 0;
    landmark.covariance.diagonal() << rows[i + 3] * rows[i + 3], rows[i + 4] * rows[i + 4], 1e-4;
    landmark.features.resize(declared.features.size());
    landmark.attributes.resize(declared.attributes.size());
    landmark.quality = {1, 1, std::vector<std::optional<double>>(declared.features.size())};
    all.push_back(std::move(landmark));
  }
  return all;
}

}  // namespace waymark::importers
