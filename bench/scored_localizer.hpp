// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

#include "localization/identification/landmark_grid.hpp"
#include "localization/localizer.hpp"
#include "localization/robot_log.hpp"
namespace waymark::bench {

// Counts matches that contradict the true pose: the landmark must be within a metre (or its radius) of the
// true position of the sighting.
class ScoredLocalizer final : public localization::Localizer {
 public:
  ScoredLocalizer(localization::Localizer& inner, const localization::RobotLog& log,
                  const localization::LandmarkGrid& map)
      : inner_(inner), map_(map) {
    for (const localization::LogEvent& e : log.events)
      if (std::holds_alternative<localization::SightingSet>(e.what))
        truth_.push_back(localization::pose_at(log.truth, e.t));
  }
  void predict(const localization::BodyMotion& motion) override { inner_.predict(motion); }
  localization::PoseEstimate estimate() const override { return inner_.estimate(); }
  localization::LocalizationStatus status() const override { return inner_.status(); }
  std::vector<localization::Match> update(const localization::SightingSet& seen) override {
    const double before = now();
    std::vector<localization::Match> matches = inner_.update(seen);
    spent += now() - before;
    ++updates;
    const auto truth = truth_[next_++];
    if (!truth) return matches;
    const localization::Pose2 sensor = *truth * seen.robot_from_sensor;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const localization::SeenLandmark& s = seen.sightings[i];
      bool possible = false, right = false;
      const auto fits = [&](const localization::MapLandmark& l) {
        const double wide = std::max(1.0, 1.2 * (l.features.known(0) ? l.features.value[0] : 0));
        if (s.has_position()) {
          const double a = sensor.yaw + *s.bearing;
          return (sensor.at() + *s.range * Eigen::Vector2d(std::cos(a), std::sin(a)) - l.at).norm() < wide;
        }
        const Eigen::Vector2d to = l.at - sensor.at();
        if (s.range) return std::abs(to.norm() - *s.range) < wide;
        return to.norm() < 25 &&
               std::abs(localization::wrap_angle(std::atan2(to.y(), to.x()) - sensor.yaw - *s.bearing)) <
                   std::max(0.02, wide / to.norm() / 2);
      };
      map_.near(sensor.at(), 27, [&](std::uint32_t l) {
        if (!fits(map_[l])) return;
        possible = true;
        right =
            right || (matches[i].verdict == localization::Verdict::matched && map_[l].key == matches[i].key);
      });
      matched += matches[i].verdict == localization::Verdict::matched;
      correct += right;
      findable += possible;
    }
    return matches;
  }
  double spent = 0;
  std::int64_t updates = 0, matched = 0, correct = 0, findable = 0;

 private:
  static double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  localization::Localizer& inner_;
  const localization::LandmarkGrid& map_;
  std::vector<std::optional<localization::Pose2>> truth_;
  std::size_t next_ = 0;
};

}  // namespace waymark::bench
