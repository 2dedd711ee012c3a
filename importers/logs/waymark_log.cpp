// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>

#include "core/error.hpp"
#include "core/options/option_table.hpp"
#include "core/text_file.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/log_line.hpp"
#include "importers/logs/log_records.hpp"
#include "importers/logs/point_files.hpp"
#include "localization/detectors/depth_rocks.hpp"
#include "localization/detectors/detected_types.hpp"
#include "localization/detectors/horizon_summits.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

/// Reads numbers of a record by the declaration of options.
class NumberReader final : public OptionVisitor {
 public:
  explicit NumberReader(const LogLine& line) : line_(line) {}

 private:
  void number(std::string_view name, double& value, std::string_view unit, const Field& field) override {
    const OptionRow row{.name = std::string(name), .unit = std::string(unit), .value = value, .field = field};
    value = line_.number(row.name.c_str(), value);
    if (const std::string fault = range_fault(row, value); !fault.empty()) line_.fail(fault);
  }
  void integer(std::string_view, std::int64_t&, const Field&) override {}
  void flag(std::string_view, bool&, const Field&) override {}
  void text(std::string_view, std::string&, const Field&) override {}
  void texts(std::string_view, std::vector<std::string>&, const Field&) override {}

  const LogLine& line_;
};

class Reader {
 public:
  Reader(const TypeRegistry& types, const LogImport& how) : types_(types), how_(how), sensor_(how.sensor) {}

  void read(const LogLine& line) {
    const std::string kind = line.text("kind");
    if (kind == "header") return header(line);
    const double t = line.number("t");
    if (kind == "odometry")
      add(t, localization::TwistReading{line.number("v"), line.number("sideways", 0),
                                        line.angular_rate("omega")});
    else if (kind == "car")
      add(t, localization::CarReading{line.number("v"), line.angle("steering")});
    else if (kind == "step")
      add(t, localization::StepReading{{line.number("dx"), line.number("dy"), line.angle("dyaw")}});
    else if (kind == "sightings")
      add(t, sightings(line));
    else if (kind == "laser")
      add(t, scan(line));
    else if (kind == "points")
      add(t, points(line));
    else if (kind == "depth")
      add(t,
          localization::sightings_of_rocks(depth(line), {.type = localization::detected_types(types_).rock}));
    else if (kind == "panorama")
      add(t, panorama(line));
    else if (kind == "felled")
      log_.felled.push_back(felled(line, t));
    else if (kind == "gnss")
      add(t, fix(line));
    else if (kind == "compass")
      add(t, heading(line));
    else if (kind == "truth")
      log_.truth.push_back({t, truth(line)});
    else
      ++unknown_[kind];
  }

  localization::RobotLog take() {
    for (const auto& [kind, count] : unknown_)
      log_.remarks.push_back(fmt::format("{} records of the kind '{}' are skipped", count, kind));
    for (const auto& [type, count] : no_type_)
      log_.remarks.push_back(
          fmt::format("{} sightings of type '{}', which the map does not have", count, type));
    localization::clean_log(log_);
    return std::move(log_);
  }

 private:
  void add(double t, localization::LogReading reading) { log_.events.push_back({t, std::move(reading)}); }

  // A yaw that was never wrapped grows turn by turn. One that begins beyond two turns, or jumps, is probably
  // in degrees.
  localization::Pose2 truth(const LogLine& line) {
    const double yaw = line.number("yaw", 0);
    if (!(std::abs(yaw - last_truth_yaw_) <= std::numbers::pi)) line.angle("yaw", 0);
    last_truth_yaw_ = yaw;
    return {line.number("x"), line.number("y"), localization::wrap_angle(yaw)};
  }

  void header(const LogLine& line) {
    if (line.has("version") && line.number("version") > 1)
      line.fail(fmt::format("is of version {}, this program reads version 1", line.number("version")));
    const std::string frame = line.has("frame") ? line.text("frame") : "map";
    if (frame != "map" && frame != "crs")
      line.fail("\"frame\" must be \"map\" or \"crs\", is \"" + frame + "\"");
    log_.in_crs = frame == "crs";
    if (line.has("crs")) log_.crs = line.text("crs");
    log_.car.wheelbase = line.positive("wheelbase", log_.car.wheelbase);
    log_.car.encoder_offset = line.number("encoder_offset", log_.car.encoder_offset);
    log_.error_memory = {line.not_negative("range_memory"), line.not_negative("bearing_memory")};
    if (line.has("odometry_noise")) odometry_noise(line.part("odometry_noise"));
    if (line.has("range_sd")) range_sd_ = line.positive("range_sd", 1);
    if (line.has("bearing_sd")) bearing_sd_ = line.positive("bearing_sd", 1);
    if (line.has("start")) start(line.part("start"));
  }
  void odometry_noise(const LogLine& line) {
    log_.odometry.emplace();
    const DescribeOptions all = [&](OptionVisitor& option) {
      log_.odometry->describe(option);
      log_.drift.describe(option);
    };
    const std::vector<OptionRow> names = option_table(all);
    for (const std::string& key : line.keys())
      if (std::ranges::find(names, key, &OptionRow::name) == names.end())
        line.fail(fmt::format("has the unknown \"{}\" in \"odometry_noise\"", key));
    NumberReader reader(line);
    all(reader);
  }
  void start(const LogLine& line) {
    log_.start = line.pose(), log_.start_sd = line.has("sd") ? line.positive("sd", 1) : 0;
    log_.start_yaw_sd = line.positive("yaw_sd", log_.start_yaw_sd);
  }

  localization::SightingSet sightings(const LogLine& line) {
    localization::SightingSet set;
    set.robot_from_sensor = line.mount();
    for (const LogLine& item : line.parts("items")) set.sightings.push_back(sighting(item));
    return set;
  }

  static localization::LineExtent extent(const LogLine& line, const localization::SeenLandmark& s) {
    const std::vector<float> ends = line.numbers("extent", kMissing);
    if (ends.size() != 2 || !(ends[0] < ends[1]))
      line.fail("\"extent\" must be two numbers, the smaller one first");
    if (!s.range || s.bearing) line.fail("has an \"extent\", which needs \"range\" and excludes \"bearing\"");
    return {static_cast<double>(ends[0]), static_cast<double>(ends[1])};
  }

  localization::SeenLandmark sighting(const LogLine& line) {
    localization::SeenLandmark s;
    if (!line.has("bearing") && !line.has("range"))
      line.fail("has a sighting with neither \"bearing\" nor \"range\": give at least one of them");
    if (line.has("bearing")) s.bearing = line.angle("bearing");
    if (s.bearing && !(std::abs(*s.bearing) <= 2 * std::numbers::pi + 1e-6))
      line.fail(fmt::format("\"bearing\" is {}: angles are radians, at most one turn", *s.bearing));
    s.bearing_sd = line.positive("bearing_sd", bearing_sd_ ? *bearing_sd_
                                               : sensor_   ? to_radians(Degrees{sensor_->bearing_sd}).value
                                                           : 0.02);
    if (line.has("range")) s.range = line.number("range");
    s.range_sd = line.positive("range_sd", range_sd_                          ? *range_sd_
                                           : sensor_ && sensor_->range_sd > 0 ? sensor_->range_sd
                                           : s.range ? 0.05 + 0.02 * std::abs(*s.range)
                                                     : 0.1);
    s.confidence = line.number("confidence", 1);
    if (!(s.confidence > 0 && s.confidence <= 1)) line.fail("\"confidence\" must be within (0, 1]");
    if (line.has("elevation")) {
      if (!s.bearing) line.fail("has an \"elevation\" without \"bearing\"");
      s.elevation = line.angle("elevation");
      if (!(std::abs(*s.elevation) <= std::numbers::pi / 2))
        line.fail(fmt::format("\"elevation\" is {}: angles are radians, within a quarter turn of the horizon",
                              *s.elevation));
    }
    s.elevation_sd = line.positive("elevation_sd", 0.002);
    if (line.has("extent")) s.extent = extent(line, s);
    if (line.has("landmark")) {
      const std::string uid = line.text("landmark");
      s.identity = localization::landmark_key(uid);
      log_.names.emplace(*s.identity, uid);
    }
    if (!line.has("type")) return s;
    const std::string name = line.text("type");
    const LandmarkType* type = types_.find(name);
    if (!type) {
      ++no_type_[name];
      s.type = localization::kNoSuchType;
      return s;
    }
    s.type = types_.id(name);
    if (line.has("features")) features(line.part("features"), *type, s.features);
    return s;
  }

  static void features(const LogLine& line, const LandmarkType& type, localization::KnownFeatures& into) {
    for (std::size_t i = 0; i < std::min(type.features.size(), localization::kMaxFeatures); ++i) {
      const FeatureSpec& spec = type.features[i];
      if (!line.has(spec.name.c_str())) continue;
      const bool with_sd = line.is_object(spec.name.c_str());
      const LogLine both = with_sd ? line.part(spec.name.c_str()) : line;
      into.value[i] = with_sd ? both.number("value") : line.number(spec.name.c_str());
      const double sd = with_sd ? both.positive("sd", 1) : 0;
      into.variance[i] = sd * sd;
      if (spec.scale == Scale::ratio && !(into.value[i] > 0))
        line.fail(fmt::format("\"{}\" must be above 0, is {}", spec.name, into.value[i]));
    }
    for (const std::string& name : line.keys())
      if (std::ranges::find(type.features, name, &FeatureSpec::name) == type.features.end())
        line.fail(fmt::format("has the feature \"{}\", which the type {} has not", name, type.name));
  }

  static localization::LaserScan scan(const LogLine& line) {
    localization::LaserScan scan{.robot_from_sensor = line.mount(),
                                 .first_angle = line.angle("first_angle"),
                                 .angle_step = line.angle("angle_step"),
                                 .ranges = line.numbers("ranges", 0),
                                 .max_range = line.positive("most_range", 80),
                                 .roll = line.angle("roll", 0),
                                 .pitch = line.angle("pitch", 0),
                                 .beam_width = {}};
    if (line.has("beam_width")) scan.beam_width = std::max(0.0, line.angle("beam_width"));
    if (line.has("intensities")) scan.intensities = line.numbers("intensities", 0);
    if (!scan.intensities.empty() && scan.intensities.size() != scan.ranges.size())
      line.fail(fmt::format("has {} intensities for {} ranges", scan.intensities.size(), scan.ranges.size()));
    return scan;
  }

  localization::SightingSet points(const LogLine& line) {
    if (!detect_) detect_ = localization::make_point_detector(types_, how_.held_types, how_.point_detectors);
    const std::filesystem::path file = line.text("file");
    localization::PointCloud cloud =
        read_point_file(file.is_absolute() ? file : line.file().parent_path() / file);
    cloud.robot_from_sensor = line.mount();
    return detect_(cloud);
  }

  static std::int64_t pixels(const LogLine& line, const char* key) {
    const double count = line.positive(key, 1);
    if (!(count <= 1e5 && count == std::floor(count)))
      line.fail(fmt::format("\"{}\" must be a whole number up to 100000, is {}", key, count));
    return static_cast<std::int64_t>(count);
  }

  static localization::DepthImage depth(const LogLine& line) {
    localization::DepthImage image{.robot_from_sensor = line.mount(),
                                   .height = line.positive("height", 1.5),
                                   .tilt = line.angle("tilt", 0),
                                   .roll = line.angle("roll", 0),
                                   .pitch = line.angle("pitch", 0),
                                   .columns = pixels(line, "columns"),
                                   .rows = pixels(line, "rows"),
                                   .focal = line.positive("focal", 1),
                                   .depths = line.numbers("depths", kMissing)};
    if (static_cast<std::int64_t>(image.depths.size()) != image.columns * image.rows)
      line.fail(
          fmt::format("has {} depths for {} x {} pixels", image.depths.size(), image.columns, image.rows));
    return image;
  }

  localization::SightingSet panorama(const LogLine& line) const {
    const localization::HorizonProfile profile{.first_angle = line.angle("first_angle"),
                                               .angle_step = line.angle("angle_step"),
                                               .elevation_sd = line.positive("elevation_sd", 0.001),
                                               .elevations = line.numbers("elevations", kMissing)};
    return localization::sightings_of_summits(profile,
                                              {.type = localization::detected_types(types_).mountain_top});
  }

  static localization::FelledReading felled(const LogLine& line, double t) {
    localization::FelledReading f{.t = t,
                                  .range = line.positive("range", 1),
                                  .bearing = line.angle("bearing"),
                                  .range_sd = line.positive("range_sd", 0.1),
                                  .bearing_sd = line.positive("bearing_sd", 0.01)};
    if (line.has("features")) {
      const LogLine features = line.part("features");
      f.diameter = features.has("diameter") ? features.positive("diameter", 1) : 0;
      f.height = features.has("height") ? features.positive("height", 1) : 0;
    }
    return f;
  }

  static localization::HeadingFix heading(const LogLine& line) {
    return {line.angle("yaw"), line.positive("sd", 0.1)};
  }

  static localization::GnssFix fix(const LogLine& line) {
    const Eigen::Vector2d at(line.number("x"), line.number("y"));
    if (!line.has("var_x") && !line.has("var_y") && !line.has("cov_xy")) return {at, line.positive("sd", 3)};
    if (line.has("sd")) line.fail("states \"sd\" and variances of a position; one of both is needed");
    const double x = line.number("var_x"), y = line.number("var_y"), both = line.number("cov_xy", 0);
    if (!(x > 0 && y > 0 && both * both < x * y))
      line.fail(fmt::format("\"var_x\" {}, \"var_y\" {} and \"cov_xy\" {} are no covariance", x, y, both));
    return localization::fix_of_covariance(at, (Eigen::Matrix2d() << x, both, both, y).finished());
  }

  double last_truth_yaw_ = 0;
  localization::PointDetector detect_;
  const TypeRegistry& types_;
  const LogImport& how_;
  std::optional<SensorCoverage> sensor_;         // absent: assumed deviations
  std::optional<double> range_sd_, bearing_sd_;  // of the header, m and rad
  localization::RobotLog log_;
  std::map<std::string, std::size_t> unknown_, no_type_;
};

}  // namespace

localization::RobotLog read_log_records(const std::filesystem::path& file, std::span<const LogRecord> records,
                                        const TypeRegistry& types, const LogImport& how) {
  if (records.empty()) throw Error(ErrorCode::input, "the log is empty", file.string(), "");
  Reader reader(types, how);
  for (const LogRecord& record : records) reader.read({file, record.line, record.json});
  return reader.take();
}

localization::RobotLog import_waymark_log(const std::filesystem::path& file, const TypeRegistry& types,
                                          const LogImport& how) {
  std::istringstream text(read_text(file, "the file"));
  std::vector<LogRecord> records;
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.find_first_not_of(" \t\r") != std::string::npos) records.push_back({number, std::move(line)});
  }
  return read_log_records(file, records, types, how);
}

}  // namespace waymark::importers
