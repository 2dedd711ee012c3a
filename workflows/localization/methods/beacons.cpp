// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <unordered_map>
#include <variant>
#include <vector>

#include "localization/slam/range_slam.hpp"
#include "workflows/localization/localize_method.hpp"
#include "workflows/localization/slam_update.hpp"

namespace waymark::workflows {
namespace {

class Beacons final : public LocalizeMethod {
 public:
  std::string_view name() const override { return "beacons"; }
  std::string_view summary() const override {
    return "ranges to beacons that identify themselves; those that the map lacks are placed, offsets of "
           "radios estimated; the map may be none; --write-map and --update-map store the beacons";
  }
  bool requires_map() const override { return false; }
  bool updates_map() const override { return true; }
  SettingGroups groups() const override { return SettingGroups::without_matching(); }
  void describe(OptionVisitor& option) override {
    options_.describe(option);
    option(
        "slant_ranges", slant_,
        {.help = "Ranges are slant: beacons are at their height in the map, the antenna at antenna_height"});
    option("antenna_height", antenna_,
           {.help = "Height of the antenna in the heights of the map, metres", .min = -1e5, .max = 1e5});
  }

  localization::Track run(LocalizeTask& task) override {
    localization::RangeSlam slam(*task.start, known_beacons(task), options_);
    const std::size_t known = slam.beacons().size();
    localization::Track track = run_localizer(task, slam);
    const std::size_t placed = slam.beacons().size() - known;
    if (placed + slam.open_beacons() > 0)
      task.callbacks.summary(
          fmt::format("beacons that the map lacks: {} placed, {} open\n", placed, slam.open_beacons()));
    for (const localization::RangeSlam::Placed& b : slam.beacons())
      if (options_.offset_sd > 0)
        task.callbacks.summary(fmt::format("beacon at {:.2f}, {:.2f}: offset {:.2f} ({:.2g}) m\n", b.mean.x(),
                                           b.mean.y(), b.mean.z(), std::sqrt(b.covariance(2, 2))));
    write_updated_map(task, landmarks_of(slam, known, heard_beacons(task.log)), kConfirmed, name());
    return track;
  }

 private:
  static constexpr double kConfirmed = 3;  // log odds, of beacons that are certain in place: 0.95

  /// Returns how many ranges of each beacon the log has.
  static std::unordered_map<localization::LandmarkKey, std::int64_t> heard_beacons(
      const localization::RobotLog& log) {
    std::unordered_map<localization::LandmarkKey, std::int64_t> heard;
    for (const localization::LogEvent& event : log.events)
      if (const auto* set = std::get_if<localization::SightingSet>(&event.what))
        for (const localization::SeenLandmark& seen : set->sightings)
          if (seen.identity && seen.range) ++heard[*seen.identity];
    return heard;
  }

  /// Returns the beacons that were heard, those of the map first, with their positions after the drive.
  static std::vector<localization::SlamLandmark> landmarks_of(
      const localization::RangeSlam& slam, std::size_t known,
      const std::unordered_map<localization::LandmarkKey, std::int64_t>& heard) {
    std::vector<localization::SlamLandmark> landmarks;
    const std::vector<localization::RangeSlam::Placed> all = slam.beacons();
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto ranges = heard.find(all[i].key);
      if (ranges == heard.end()) continue;
      localization::SlamLandmark one;
      one.at = all[i].mean.head<2>();
      one.covariance = all[i].covariance.topLeftCorner<2, 2>();
      one.log_odds = kConfirmed + 1;
      one.matches = one.expected = ranges->second;
      one.key = all[i].key;
      one.was_mapped = i < known;
      landmarks.push_back(one);
    }
    return landmarks;
  }

  std::vector<localization::RangeBeacon> known_beacons(const LocalizeTask& task) const {
    std::vector<localization::RangeBeacon> known;
    const RobotMap& map = task.map.map;
    for (const Landmark& l : map.store->query({.min_confidence = map.min_confidence})) {
      const localization::MapLandmark m =
          localization::map_landmark(l, map.types()[l.type], map.frame, task.sensor);
      const double z = l.position.xyz.z();
      known.push_back({.key = m.key,
                       .at = m.at,
                       .covariance = m.covariance,
                       .height = slant_ && std::isfinite(z) ? z - antenna_ : 0});
    }
    return known;
  }

  localization::RangeSlamOptions options_;
  bool slant_ = false;
  double antenna_ = 0;
};

}  // namespace

void register_method_beacons(MethodTable& methods);
void register_method_beacons(MethodTable& methods) {
  methods.add<Beacons>();
}

}  // namespace waymark::workflows
