// SPDX-License-Identifier: Apache-2.0
// Where particles are drawn whose place is not known.
#include <numbers>

#include "localization/filters/particle_filter.hpp"

namespace waymark {

std::optional<Pose2> ParticleFilter::pose_that_explains(const SightingSet& seen, const LandmarkGrid& map,
                                                        Random& random) const {
  if (!hints_.empty() && random.chance(0.5)) return hints_[random.below(hints_.size())];
  const SeenLandmark& s = seen.sightings[random.below(seen.sightings.size())];
  if (!s.sound() || map.empty()) return {};
  const auto known = identification_.use_identities && s.identity ? map.find(*s.identity) : std::nullopt;
  const std::uint32_t l = known ? *known : static_cast<std::uint32_t>(random.below(map.size()));
  if (!known && s.type && *s.type != map[l].type) return {};
  const double range = s.range ? std::max(0.0, *s.range + s.range_sd * random.normal())
                               : identification_.bearing_reach * std::sqrt(random.uniform());
  const double from = random.uniform(-std::numbers::pi, std::numbers::pi);  // landmark to sensor
  const double yaw = wrapped(from + std::numbers::pi - s.bearing + s.bearing_sd * random.normal());
  const Pose2 sensor{map[l].at.x() + range * std::cos(from), map[l].at.y() + range * std::sin(from), yaw};
  return sensor * inverse(seen.robot_from_sensor);
}

// At most every fifth set: the finder looks at the whole map.
void ParticleFilter::ask_finder(const SightingSet& seen) {
  if (asked_ != 0 && sets_ < asked_ + 5) return;
  asked_ = sets_;
  hints_.clear();
  FoundPoses found = finder_(with_bearings(memory_.recall(), seen));
  if (found.sure) found.possible = {*found.sure};
  Random random(static_cast<std::uint64_t>(options_.seed) + sets_, "hints");
  for (const PoseEstimate& e : found.possible) {
    const Eigen::Matrix3d root = square_root(e.covariance);
    for (int i = 0; i < 50; ++i)
      hints_.push_back(pose_of(e.pose.vector() +
                               root * Eigen::Vector3d(random.normal(), random.normal(), random.normal())));
  }
  // It is somewhere else than all particles: begin again.
  if (found.sure && doubt_ && !searching_) {
    doubt_->confirm(*found.sure, summary_);
    searching_ = !doubt_->found();
  }
  if (found.sure && searching_) {
    poses_.clear();
    found_sd_ = std::sqrt(found.sure->covariance(0, 0) + found.sure->covariance(1, 1));
  }
}

void ParticleFilter::search(const SightingSet& seen, const LandmarkGrid& map, std::size_t count) {
  Random random(static_cast<std::uint64_t>(options_.seed) + step_, "search");
  poses_.clear();
  for (std::size_t tries = 0; poses_.size() < count && tries < 50 * count; ++tries)
    if (const auto pose = pose_that_explains(seen, map, random)) poses_.push_back(*pose);
  weights_.assign(poses_.size(), poses_.empty() ? 0 : 1 / static_cast<double>(poses_.size()));
}

}  // namespace waymark
