// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/particle_filter.hpp"

#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "core/ziggurat.hpp"
#include "localization/filters/particle_blocks.hpp"
#include "localization/filters/resampling.hpp"

namespace waymark::localization {
namespace {

constexpr double kNewError = 15;  // m driven until a landmark's map error has fallen to 1/e of an old one
constexpr int kPatience = 10;     // fixes to ignore while a set of sightings is awaited

Pose2 sample(const PoseEstimate& about, const Eigen::Matrix3d& root, Random& random) {
  const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
  return pose_of(about.pose.vector() + root * noise);
}

}  // namespace

void ParticleOptions::describe(OptionVisitor& option) {
  option("particles", particles, {.help = "Particles while the pose is known", .min = 10, .max = 1e7});
  option("search_particles", search_particles,
         {.help = "Particles during global localization", .min = 10, .max = 1e7});
  option("adaptive", adaptive, {.help = "Use as many particles as their spread needs (KLD sampling)"});
  option("kld_error", kld_error, {.help = "Error bound of KLD sampling", .min = 0.001, .max = 0.5});
  option("resample_below", resample_below,
         {.help = "Resample if fewer than this fraction of the particles are effective", .min = 0, .max = 1});
  option("recovery", recovery, {.help = "Draw new poses when the likelihood of sightings falls"});
  option("recovery_slow", recovery_slow,
         {.help = "Decay of the long-term mean likelihood, per set", .min = 1e-6, .max = 1});
  option("recovery_fast", recovery_fast,
         {.help = "Decay of the short-term mean likelihood, per set", .min = 1e-6, .max = 1});
  weight.describe(option);
}

ParticleFilter::ParticleFilter(std::optional<PoseEstimate> start, LandmarkMatcher matcher,
                               ParticleOptions options, PoseFinder finder)
    : matcher_(std::move(matcher)),
      options_(std::move(options)),
      finder_(std::move(finder)),
      memory_(matcher_.scales()) {
  if (!start) {
    searching_ = true;
    summary_ = pose_anywhere(matcher_.landmarks_near({0, 0}, 0).bounds());
    real_.reset(summary_);
    convergence_.emplace(summary_, matcher_.options().use_identities);
    if (!matcher_.options().use_identities) chance_ = make_chance_fraction(matcher_);
    return;
  }
  if (!start->pose.finite() || !start->covariance.allFinite())
    throw std::invalid_argument("the start of a filter must be finite");
  summary_ = *start;
  real_.reset(summary_);
  const auto count = static_cast<std::size_t>(options_.particles);
  const Eigen::Matrix3d root = square_root(start->covariance);
  Random random(static_cast<std::uint64_t>(options_.seed), "start");
  for (std::size_t i = 0; i < count; ++i) poses_.push_back(sample(*start, root, random));
  weights_.assign(count, 1 / static_cast<double>(count));
}

LocalizationStatus ParticleFilter::status() const {
  if (poses_.empty()) return LocalizationStatus::uninitialized;
  return searching_ || (convergence_ && !convergence_->found()) ? LocalizationStatus::lost
                                                                : LocalizationStatus::tracking;
}

void ParticleFilter::predict(const BodyMotion& motion) {
  pending_ = compose(pending_, motion);
  driven_ += motion.step.at().norm();
  if (finder_) memory_.predict(motion);
  if (convergence_) convergence_->predict(motion);
  if (pending_.covariance(2, 2) > 0.01 || pending_.step.at().squaredNorm() > 4) apply_motion();
}

void ParticleFilter::apply_motion() {
  real_.predict(summary_.pose, pending_);
  summary_ = predict_pose(summary_, pending_);
  const Eigen::Matrix3d root = square_root(pending_.covariance);
  const std::uint64_t stream = named_seed(static_cast<std::uint64_t>(options_.seed), "motion") + ++step_;
  const Ziggurat& normal = Ziggurat::instance();
  for_each_block(poses_.size(), options_.threads, [&](std::size_t first, std::size_t last) {
    Random random(mix_bits(stream) + first);
    for (std::size_t i = first; i < last; ++i) {
      const double a = normal(random), b = normal(random), c = normal(random);
      poses_[i] = poses_[i] * Pose2{pending_.step.x + root(0, 0) * a,
                                    pending_.step.y + root(1, 0) * a + root(1, 1) * b,
                                    pending_.step.yaw + root(2, 0) * a + root(2, 1) * b + root(2, 2) * c};
    }
  });
  pending_ = {};
}

double ParticleFilter::map_error_factor(LandmarkKey key) const {
  const auto used = uses_.find(key);
  if (used == uses_.end()) return 1;
  return 1 + used->second.count * std::exp((used->second.driven - driven_) / kNewError);
}

// The paper's weights are no likelihoods, and several clouds no Gaussian: the particles speak for themselves.
void ParticleFilter::follow_sightings(const PoseEstimate& before, const SightingSet& seen,
                                      const std::vector<Match>& matches, const LandmarkGrid& map) {
  if (searching_ || options_.weight.weights == "paper" || !is_unimodal(summary_) || !is_unimodal(before))
    return real_.reset(summary_);
  real_.follow_sightings(before, summary_, seen, matches, map,
                         [this](LandmarkKey key) { return map_error_factor(key); });
}

template <class Fit>
bool ParticleFilter::reweight(Fit&& fit) {
  const PoseEstimate before = summary_;
  for (std::size_t i = 0; i < poses_.size(); ++i) weights_[i] = std::log(weights_[i]) + fit(poses_[i]);
  weights_ = normalise_log_weights(weights_);
  summary_ = dominant_mode(poses_, weights_, kModeRadius);
  if (is_unimodal(summary_) && is_unimodal(before))
    real_.follow_independent(before, summary_);
  else
    real_.reset(summary_);
  if (effective_sample_size(weights_) < options_.resample_below * static_cast<double>(poses_.size())) {
    Random random(static_cast<std::uint64_t>(options_.seed) + step_, "draw by fix");
    std::vector<Pose2> next;
    for (const std::uint32_t i : resample(weights_, poses_.size(), random.uniform()))
      next.push_back(poses_[i]);
    poses_ = std::move(next);
    weights_.assign(poses_.size(), 1 / static_cast<double>(poses_.size()));
  }
  return true;
}

// Draws any heading; present particles keep the fraction `kept` of the weight.
void ParticleFilter::sample_around_fix(const GnssFix& gnss, double kept) {
  Random random(static_cast<std::uint64_t>(options_.seed) + ++step_, "fix");
  if (!(kept > 0)) poses_.clear(), weights_.clear();
  for (double& w : weights_) w *= kept;
  const auto count = static_cast<std::size_t>(options_.search_particles);
  const Eigen::Matrix2d root = gnss.noise().llt().matrixL();
  for (std::size_t i = 0; i < count; ++i) {
    const double east = random.normal(), north = random.normal();
    const Eigen::Vector2d at = gnss.at + root * Eigen::Vector2d(east, north);
    poses_.push_back({at.x(), at.y(), random.uniform(-std::numbers::pi, std::numbers::pi)});
    weights_.push_back((1 - kept) / static_cast<double>(count));
  }
  summary_ = dominant_mode(poses_, weights_, kModeRadius);
  real_.reset(summary_);
}

bool ParticleFilter::fix(const GnssFix& gnss) {
  apply_motion();
  const double squares = update_pose(summary_, gnss).squares;
  const bool scattered = status() == LocalizationStatus::lost;
  if (!poses_.empty() && !scattered && !gnss_.pass(squares, 2)) return false;
  if (contested_ > 0) {
    --contested_;
    return false;
  }
  double nearest = 1e300;
  for (const Pose2& p : poses_) nearest = std::min(nearest, (p.at() - gnss.at).squaredNorm());
  if (nearest > 9 * gnss.sd * gnss.sd) {  // no particle near the fix
    // Particles that match their sightings stay beside the new ones: GNSS errors are correlated, e.g. under
    // trees.
    const bool fits = !scattered && slow_ > 0 && fast_ > 0.5 * slow_;
    contested_ = fits ? kPatience : 0;
    sample_around_fix(gnss, fits ? 0.5 : 0);
    if (convergence_) convergence_->reset(), convergence_->fix(gnss);
    return true;
  }
  if (convergence_) convergence_->fix(gnss);
  if (!gnss.covariance)
    return reweight(
        [&](const Pose2& p) { return -(p.at() - gnss.at).squaredNorm() / (2 * gnss.sd * gnss.sd); });
  const Eigen::Matrix2d information = gnss.covariance->inverse();
  return reweight([&](const Pose2& p) {
    const Eigen::Vector2d off = p.at() - gnss.at;
    return -off.dot(information * off) / 2;
  });
}

bool ParticleFilter::fix(const HeadingFix& heading) {
  apply_motion();
  if (poses_.empty()) return false;
  // A floor limits outliers: they cannot remove the particles that are right.
  return reweight([&](const Pose2& p) {
    const double v = wrap_angle(heading.yaw - p.yaw) / heading.sd;
    return std::log(std::exp(-v * v / 2) + 1e-4);
  });
}

std::vector<Match> ParticleFilter::update(const SightingSet& seen) {
  apply_motion();
  matcher_.observe(seen);
  const LandmarkGrid& map =
      matcher_.landmarks_near(seen, summary_, options_.weight.expect_unseen ? options_.weight.view_range : 0);
  ++sets_;
  if (finder_) {
    memory_.add(seen);
    if (searching_ || (convergence_ && !convergence_->found()) ||
        (options_.recovery && slow_ > 0 && fast_ < 0.7 * slow_))
      query_finder(seen);
    else
      finder_samples_.clear();
  }
  if (poses_.empty() && !seen.sightings.empty() && can_search(map))
    search(seen, map, static_cast<std::size_t>(options_.search_particles));
  if (poses_.empty()) return std::vector<Match>(seen.sightings.size());

  const PoseEstimate before = summary_;
  weigh(seen, map);
  contested_ = 0;
  summary_ = dominant_mode(poses_, weights_, kModeRadius);
  const double sd = std::sqrt(summary_.covariance(0, 0) + summary_.covariance(1, 1));
  searching_ = sd > (searching_ ? std::max(0.5, 1.5 * found_sd_) : std::max(3 * kModeRadius, 3 * found_sd_));
  if (effective_sample_size(weights_) < options_.resample_below * static_cast<double>(poses_.size()))
    resample_particles(seen, map);

  std::vector<Match> matches = matcher_.identify(seen, summary_, map).matches;
  if (!searching_) matcher_.learn(matches, seen, summary_, map);
  follow_sightings(before, seen, matches, map);
  for (Match& match : matches) {
    if (match.verdict == Verdict::matched) {
      name_landmark(match, map[match.pairing.landmark]);
      uses_[match.key] = {map_error_factor(match.key), driven_};
    }
    match.pairing.evidence = {};  // of the estimate after the update: residuals, not innovations
  }
  if (convergence_)
    convergence_->count(matched_fraction(matches), chance_ ? chance_(seen, summary_, matches) : 0,
                        !searching_, has_bearing(seen));
  return matches;
}

}  // namespace waymark::localization
