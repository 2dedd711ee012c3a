// SPDX-License-Identifier: Apache-2.0
// Samples poses during global localization.
#include <numbers>

#include "localization/filters/particle_filter.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kPerLandmark = 10;  // particles of a search in which one may be right

}  // namespace

std::optional<Pose2> ParticleFilter::sample_pose(const SightingSet& seen, const LandmarkGrid& map,
                                                 Random& random) const {
  if (!finder_samples_.empty() && random.bernoulli(0.5))
    return finder_samples_[random.uniform_index(finder_samples_.size())];
  const SeenLandmark& s = seen.sightings[random.uniform_index(seen.sightings.size())];
  if (!s.is_valid() || s.extent || map.empty()) return {};  // a line gives no position
  const auto known = matcher_.options().use_identities && s.identity ? map.find(*s.identity) : std::nullopt;
  const std::uint32_t l = known ? *known : static_cast<std::uint32_t>(random.uniform_index(map.size()));
  if (!known && !s.may_be(map[l].type)) return {};
  const double range = s.range
                           ? std::max(0.0, *s.range + s.range_sd * random.normal())
                           : matcher_.options().reach_of(s, matcher_.scales()) * std::sqrt(random.uniform());
  const double from = random.uniform(-std::numbers::pi, std::numbers::pi);  // landmark to sensor
  const double yaw = s.bearing
                         ? wrap_angle(from + std::numbers::pi - *s.bearing + s.bearing_sd * random.normal())
                         : random.uniform(-std::numbers::pi, std::numbers::pi);
  const Pose2 sensor{map[l].at.x() + range * std::cos(from), map[l].at.y() + range * std::sin(from), yaw};
  return sensor * inverse(seen.robot_from_sensor);
}

// Calls the finder at most every fifth set, since it searches the whole map; more often at first.
void ParticleFilter::query_finder(const SightingSet& seen) {
  if (queried_set_ != 0 &&
      sets_ < queried_set_ + static_cast<std::uint64_t>(search_interval(static_cast<std::int64_t>(sets_))))
    return;
  queried_set_ = sets_;
  finder_samples_.clear();
  PoseSearchResult found = memory_.find(finder_, seen);
  if (!found.accepted && convergence_ && !convergence_->found())  // odometry may have bent what is remembered
    if (PoseSearchResult at_once = finder_(seen); at_once.accepted) found = std::move(at_once);
  if (found.accepted) found.candidates = {*found.accepted};
  Random random(static_cast<std::uint64_t>(options_.seed) + sets_, "hints");
  for (const PoseEstimate& e : found.candidates) {
    const Eigen::Matrix3d root = square_root(e.covariance);
    for (int i = 0; i < 50; ++i)
      finder_samples_.push_back(pose_of(
          e.pose.vector() + root * Eigen::Vector3d(random.normal(), random.normal(), random.normal())));
  }
  // Restarts if the pose found is not that of the particles.
  if (found.accepted && convergence_ && !searching_) {
    convergence_->confirm(*found.accepted, summary_);
    // Particles that ranges alone have gathered may face another way.
    searching_ = !convergence_->found() || !has_bearing(seen);
  }
  if (found.accepted && searching_) {
    poses_.clear();
    found_sd_ = std::sqrt(found.accepted->covariance(0, 0) + found.accepted->covariance(1, 1));
    if (convergence_) sample_found(*found.accepted);
  }
}

// The finder is certain: all particles start there.
void ParticleFilter::sample_found(const PoseEstimate& at) {
  Random random(static_cast<std::uint64_t>(options_.seed) + sets_, "found");
  const auto count = static_cast<std::size_t>(options_.particles);
  const Eigen::Matrix3d root = square_root(at.covariance);
  for (std::size_t i = 0; i < count; ++i)
    poses_.push_back(pose_of(at.pose.vector() +
                             root * Eigen::Vector3d(random.normal(), random.normal(), random.normal())));
  weights_.assign(count, 1 / static_cast<double>(count));
  summary_ = at;
  real_.reset(summary_);
  searching_ = false;
  slow_ = fast_ = 0;
  convergence_->accept();
}

// A pose drawn from one sighting lies anywhere on a circle about one of the landmarks, so each needs several.
bool ParticleFilter::can_search(const LandmarkGrid& map) const {
  return !finder_ || matcher_.options().use_identities ||
         kPerLandmark * map.size() <= static_cast<std::size_t>(options_.search_particles);
}

void ParticleFilter::search(const SightingSet& seen, const LandmarkGrid& map, std::size_t count) {
  Random random(static_cast<std::uint64_t>(options_.seed) + step_, "search");
  poses_.clear();
  for (std::size_t tries = 0; poses_.size() < count && tries < 50 * count; ++tries)
    if (const auto pose = sample_pose(seen, map, random)) poses_.push_back(*pose);
  weights_.assign(poses_.size(), poses_.empty() ? 0 : 1 / static_cast<double>(poses_.size()));
}

}  // namespace waymark::localization
