// SPDX-License-Identifier: Apache-2.0
#include "planning/observability.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace waymark::planning {
namespace {

constexpr int kDoublings = 7;  // 128 sightings per drive

void add(Information& sum, const Information& more, double factor) {
  planning::add(sum.rate, more.rate, factor);
  sum.quality += factor * more.quality;
}

Symmetric3 scaled(const Symmetric3& j, double factor) {
  return {factor * j.xx, factor * j.xy, factor * j.yy, factor * j.xt, factor * j.yt, factor * j.tt};
}

using InDirections = std::array<Information, kHeadings>;

InDirections look(double x, double y, const localization::LandmarkGrid& map, const LandmarkSensing& sensing) {
  return information_in_directions({x, y}, informative_headings(sensing), map, sensing);
}

Observability observability_of(const InDirections& in_directions, const ObservabilityRules& rules) {
  const bool all_round = !(rules.sensing.coverage.view < 360);
  const double step = rules.drive / (1 << kDoublings);
  Observability out;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const localization::Pose2 pose = heading_pose(0, 0, heading);
    const Information& seen = in_directions[all_round ? 0 : static_cast<std::size_t>(heading)];
    add(out.mean, seen, 1.0 / kHeadings);
    out.landmarks += static_cast<double>(seen.landmarks) / kHeadings;
    const Symmetric3 after = covariance_after(drive_segment({step, std::cos(pose.yaw), std::sin(pose.yaw), 0},
                                                            scaled(seen.rate, step), rules.noise),
                                              kDoublings);
    out.position_sd = std::max(out.position_sd, position_sd(after));
    out.yaw_sd = std::max(out.yaw_sd, std::sqrt(std::max(0.0, after.tt)));
  }
  out.mean.landmarks = static_cast<int>(std::lround(out.landmarks));
  return out;
}

}  // namespace

Observability observability_at(double x, double y, const localization::LandmarkGrid& map,
                               const ObservabilityRules& rules) {
  return observability_of(look(x, y, map, rules.sensing), rules);
}

ObservabilityField::ObservabilityField(const localization::LandmarkGrid& map, const ObservabilityRules& rules)
    : map_(map), rules_(rules), unseen_(observability_of({}, rules)) {}

Observability ObservabilityField::at(double x, double y) const {
  const InDirections seen = look(x, y, map_, rules_.sensing);
  const bool none = std::ranges::all_of(seen, [](const Information& i) { return i.landmarks == 0; });
  return none ? unseen_ : observability_of(seen, rules_);
}

std::array<double, std::size(kObservabilityBands)> observability_bands(const Observability& at) {
  const Symmetric3& j = at.mean.rate;
  return {at.position_sd, to_degrees(Radians{at.yaw_sd}).value,
          at.landmarks,   at.mean.quality,
          j.xx,           j.yy,
          j.xy,           j.tt};
}

}  // namespace waymark::planning
