// SPDX-License-Identifier: Apache-2.0
// Compares localizers x sensors x map qualities on drives of the testbed and writes a Markdown and an HTML
// page. usage: bench_compare_localizers RUNS METRES OUT.md OUT.html NAME SCENARIO.json MAP.gpkg [NAME
// SCENARIO MAP]... One thread; scripts/compare-localizers makes the maps and calls it.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include "bench/scored_localizer.hpp"
#include "bench/tables.hpp"
#include "core/text_file.hpp"
#include "geodb/map_store.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/replay_log.hpp"
#include "localization/robot_log.hpp"
#include "localization/slam/ekf_slam.hpp"
#include "localization/track_score.hpp"
#include "testbed/drive/drive_log.hpp"
#include "testbed/landing/flight.hpp"
#include "testbed/scenario.hpp"

namespace waymark::bench {
namespace {

struct Site {
  std::string name;
  testbed::Scenario scenario;
  testbed::Scene scene;
  geodb::MapStore store;
  std::vector<localization::MapLandmark> landmarks;
};

Site open_site(const std::string& name, const std::string& scenario_file, const std::string& map_file) {
  testbed::Scenario scenario =
      testbed::read_scenario(read_text(scenario_file, "the scenario"), scenario_file);
  scenario.ground = testbed::size_site(scenario, testbed::plan_shots(scenario));
  testbed::Scene scene = testbed::make_scene(scenario.ground, static_cast<std::uint64_t>(scenario.seed));
  Site site{name, scenario, std::move(scene), geodb::MapStore::open(map_file), {}};
  const LocalFrame frame(site.store.crs(), Point<MapCrs>{});
  SensorRegistry sensors;
  register_sensor_profiles(sensors);
  for (const Landmark& l : site.store.query({.types = {"rock"}}))
    site.landmarks.push_back(
        localization::map_landmark(l, site.store.types()[l.type], frame, &sensors.at("horizontal_laser")));
  // A map worse than any of the testbed: as many false rocks as true ones, with low confidence.
  if (name.find("false rocks added") == std::string::npos) return site;
  Eigen::AlignedBox2d box;
  for (const localization::MapLandmark& l : site.landmarks) box.extend(l.at);
  Random random(1, "false rocks");
  for (std::size_t i = 0, n = site.landmarks.size(); i < n; ++i) {
    localization::MapLandmark l = site.landmarks[i];
    l.key = i + 1;
    l.at = {random.uniform(box.min().x(), box.max().x()), random.uniform(box.min().y(), box.max().y())};
    l.quality = 0.15;
    site.landmarks.push_back(l);
  }
  return site;
}

struct Variant {
  std::string method, sensor = "laser";
  bool quality = true, features = true;
};

enum class SensorKind { laser, stereo, camera };
SensorKind kind_of(const localization::LogEvent& e) {
  if (std::holds_alternative<localization::LaserScan>(e.what)) return SensorKind::laser;
  const auto& set = std::get<localization::SightingSet>(e.what);
  const bool ranges = set.robot_from_sensor.x != 0;  // the depth camera is mounted 0.5 m ahead
  return ranges ? SensorKind::stereo : SensorKind::camera;
}

localization::RobotLog filter_log(const localization::RobotLog& log, const std::string& sensor, bool features,
                                  const localization::LaserDetector& detect) {
  localization::RobotLog some = log;
  std::erase_if(some.events, [&](const localization::LogEvent& e) {
    if (!std::holds_alternative<localization::LaserScan>(e.what) &&
        !std::holds_alternative<localization::SightingSet>(e.what))
      return false;
    const SensorKind kind = kind_of(e);
    return !(sensor == "laser + stereo" ? kind != SensorKind::camera
             : sensor == "laser"        ? kind == SensorKind::laser
             : sensor == "stereo"       ? kind == SensorKind::stereo
                                        : kind == SensorKind::camera);
  });
  // Detectors run once per scan, so that all methods get the same sightings and only the update is timed.
  for (localization::LogEvent& e : some.events) {
    if (const auto* scan = std::get_if<localization::LaserScan>(&e.what)) {
      localization::SightingSet set = detect(*scan);
      e.what = std::move(set);
    }
    if (auto* set = std::get_if<localization::SightingSet>(&e.what); set && !features)
      for (localization::SeenLandmark& s : set->sightings) s.features = {};
  }
  return some;
}

struct Sum {
  std::vector<double> rmse, median, rpe, heading, anees;
  double spent = 0;
  std::int64_t updates = 0, matched = 0, correct = 0, findable = 0;
};

double middle(std::vector<double> all) {
  if (all.empty()) return std::nan("");
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::ranges::nth_element(all, at);
  return *at;
}
double mean(const std::vector<double>& all) {
  double sum = 0;
  for (const double v : all) sum += v / static_cast<double>(all.size());
  return sum;
}

std::unique_ptr<localization::Localizer> make(const Variant& v, const localization::PoseEstimate& start,
                                              const localization::LandmarkGrid& map,
                                              const TypeRegistry& types) {
  localization::IdentificationOptions id;
  id.use_identities = false;
  if (v.sensor == "camera") id.bearing_reach = 30;
  if (!v.quality) id.quality_floor = 1;
  const localization::LandmarkMatcher matcher(localization::LandmarkWindow(map),
                                              localization::FeatureScales(types), id);
  if (v.method == "odometry") return std::make_unique<localization::DeadReckoning>(start);
  if (v.method == "slam") return std::make_unique<localization::EkfSlam>(start);
  if (v.method.starts_with("pf"))
    return std::make_unique<localization::ParticleFilter>(
        start, matcher,
        localization::ParticleOptions{
            .particles = 300, .recovery = v.method != "pf", .threads = 1, .weight = {}});
  if (v.method == "ukf") return std::make_unique<localization::UnscentedKalman>(start, matcher);
  if (v.method == "ekf, one Gaussian") return std::make_unique<localization::ExtendedKalman>(start, matcher);
  return std::make_unique<localization::MultiHypothesisFilter>(start, matcher);
}

void run(const Variant& v, const localization::RobotLog& log, const Site& site,
         const localization::LandmarkGrid& map, Sum& sum) {
  localization::PoseEstimate start{*log.start, Eigen::Matrix3d::Zero()};
  start.covariance.diagonal() << 0.02, 0.02, 0.0008;
  const auto localizer = make(v, start, map, site.store.types());
  ScoredLocalizer scored(*localizer, log, map);
  localization::ReplayOptions how;
  // Wheels that slip by some per cent, and a gyro: closer to the vehicle than the defaults.
  how.odometry = {.along_per_metre = 0.01,
                  .across_per_metre = 0.003,
                  .yaw_per_metre = 1e-4,
                  .yaw_per_radian = 0.002,
                  .position_per_second = 1e-6,
                  .yaw_per_second = 1e-6};
  const localization::Track track = localization::replay(log, scored, how);
  const localization::TrackScore s =
      localization::score(track, log.truth, localization::TrackAlignment::none, true);
  sum.rmse.push_back(s.ate_rmse);
  sum.median.push_back(s.ate_median);
  sum.rpe.push_back(s.rpe);
  sum.heading.push_back(s.heading_rmse_deg.value_or(0));
  sum.anees.push_back(s.consistency ? s.consistency->anees : 0);
  sum.spent += scored.spent;
  sum.updates += scored.updates;
  sum.matched += scored.matched;
  sum.correct += scored.correct;
  sum.findable += scored.findable;
}

}  // namespace
}  // namespace waymark::bench

int main(int argc, char** argv) {
  using namespace waymark;
  using namespace waymark::bench;
  if (argc < 8 || (argc - 5) % 3 != 0) {
    fmt::print(stderr, "usage: {} RUNS METRES OUT.md OUT.html NAME SCENARIO.json MAP.gpkg ...\n", argv[0]);
    return 2;
  }
  const int runs = std::stoi(argv[1]);
  const double metres = std::stod(argv[2]);
  std::vector<Variant> variants;
  for (const char* method : {"odometry", "ekf", "ekf, one Gaussian", "ukf", "pf", "pf, recovery", "slam"})
    variants.push_back({method});
  for (const char* sensor : {"stereo", "laser + stereo"})
    for (const char* method : {"ekf", "pf"}) variants.push_back({method, sensor});
  variants.push_back({"pf", "camera"});  // the others are slow or lost with bearings alone
  for (const char* method : {"ekf", "ukf", "pf"}) {
    variants.push_back({method, "laser", false, true});
    variants.push_back({method, "laser", true, false});
    variants.push_back({method, "laser", false, false});
  }
  Tables tables({"method", "sensor", "quality", "features", "ATE RMSE, median of runs", "worst run",
                 "median error", "RPE 1 s", "heading deg", "NEES / 3", "precision", "recall",
                 "us per update"});
  for (int s = 5; s < argc; s += 3) {
    const Site site = open_site(argv[s], argv[s + 1], argv[s + 2]);
    std::vector<localization::MapLandmark> flat = site.landmarks;
    double quality = 0;
    for (localization::MapLandmark& l : flat)
      quality += l.quality / static_cast<double>(flat.size()), l.quality = 1;
    const localization::LandmarkGrid with(site.landmarks), without(flat);
    const localization::LaserDetector detect =
        localization::make_laser_detector(site.store.types(), {.find = "rocks"});
    std::vector<Sum> sums(variants.size());
    for (int r = 0; r < runs; ++r) {
      testbed::DriveSettings drive = site.scenario.drive;
      drive.seed = 1000 + r;
      drive.length = metres;
      const bool laser_only = site.name.find("false rocks added") != std::string::npos;
      drive.stereo.on = drive.camera.on = !laser_only;
      drive.camera.every = 10;
      const testbed::DriveWorld world = testbed::make_drive(drive, site.scene, {}, site.scene.seed);
      const std::string file = fmt::format("{}.{}.jsonl", argv[3], r);  // of this process alone
      std::ofstream(file) << testbed::drive_log(world, {});
      const localization::RobotLog log = importers::import_waymark_log(file, site.store.types());
      std::filesystem::remove(file);
      std::map<std::pair<std::string, bool>, localization::RobotLog> logs;
      for (std::size_t i = 0; i < variants.size(); ++i) {
        const Variant& v = variants[i];
        if (laser_only && (v.sensor != "laser" || v.method == "slam" || v.method == "pf, recovery")) continue;
        const auto [at, made] = logs.try_emplace({v.sensor, v.features});
        if (made) at->second = filter_log(log, v.sensor, v.features, detect);
        run(v, at->second, site, v.quality ? with : without, sums[i]);
        if (r == 0)
          fmt::print(stderr,
                     "{} {} {} {}: RMSE {:.3f} median {:.3f}, {} of {} right of {} findable, {:.1f} s in {} "
                     "updates\n",
                     v.method, v.sensor, v.quality, v.features, sums[i].rmse[0], sums[i].median[0],
                     sums[i].correct, sums[i].matched, sums[i].findable, sums[i].spent, sums[i].updates);
      }
      fmt::print(stderr, "{} {}/{}\n", site.name, r + 1, runs);
    }
    tables.site(fmt::format("{}: {} rocks on the map, mean quality {:.2f}; {} drives of {:g} m", site.name,
                            site.landmarks.size(), quality, runs, metres));
    for (std::size_t i = 0; i < variants.size(); ++i) {
      const Variant& v = variants[i];
      const Sum& sum = sums[i];
      if (sum.rmse.empty()) continue;
      const bool moves = v.method != "odometry", pairs = moves && v.method != "slam";
      const auto ratio = [&](std::int64_t part, std::int64_t all) {
        return pairs && all > 0 ? fmt::format("{:.3f}", double(part) / double(all)) : std::string();
      };
      const auto said = [&](const std::string& word) { return moves ? word : std::string(); };
      tables.row({v.method, said(v.sensor), said(v.quality ? "yes" : "no"), said(v.features ? "yes" : "no"),
                  fmt::format("{:.3f}", middle(sum.rmse)),
                  fmt::format("{:.3f}", *std::ranges::max_element(sum.rmse)),
                  fmt::format("{:.3f}", middle(sum.median)), fmt::format("{:.3f}", mean(sum.rpe)),
                  fmt::format("{:.2f}", mean(sum.heading)), fmt::format("{:.2f}", middle(sum.anees)),
                  ratio(sum.correct, sum.matched), ratio(sum.correct, sum.findable),
                  fmt::format("{:.0f}", 1e6 * sum.spent / double(std::max<std::int64_t>(1, sum.updates)))});
    }
  }
  std::ofstream(argv[3]) << tables.markdown();
  std::ofstream(argv[4]) << tables.html("Localizers compared");
  return 0;
}
