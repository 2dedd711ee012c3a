// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/identification.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/covariance.hpp"
#include "localization/chi_square.hpp"
#include "localization/identification/assignment.hpp"
#include "localization/identification/joint_search.hpp"

namespace waymark::localization {
namespace {

constexpr double kHorizon = 10e3;  // m: types that are identified from farther away are seen on the horizon
constexpr double kNearObjects = 100;  // m: objects that are confused with landmarks

/// Returns quantiles of the gate by degrees of freedom, computed once per gate.
double gate_of(const IdentificationOptions& options, int freedom) {
  constexpr int kMaxFreedom = 2 + static_cast<int>(kMaxFeatures);
  thread_local double last = -1;
  thread_local std::array<double, kMaxFreedom + 1> gates;
  if (last != options.gate) {
    for (int i = 1; i <= kMaxFreedom; ++i)
      gates[static_cast<std::size_t>(i)] = chi_square_quantile(options.gate, i);
    last = options.gate;
  }
  return gates[static_cast<std::size_t>(std::clamp(freedom, 1, kMaxFreedom))];
}

/// Returns the metres by which a sighted line may lie beside its line on the map, along it.
double line_slack(const PoseEstimate& robot, double farthest) {
  constexpr double kEnds = 0.5;  // m: ends are hidden, or cut by cells
  const double turn = std::sqrt(std::max(0.0, robot.covariance(2, 2)));
  return kEnds + 3 * (largest_sd(robot.covariance.topLeftCorner<2, 2>()) + std::min(turn, 1.0) * farthest);
}

/// Returns the landmarks of its type that may pass the gate of a sighting; others cannot.
std::vector<std::uint32_t> landmarks_in_reach(const SeenLandmark& seen, const Pose2& sensor,
                                              const PoseEstimate& robot, const LandmarkGrid& map,
                                              const FeatureScales& scales,
                                              const IdentificationOptions& options) {
  std::vector<std::uint32_t> found;
  const double sigmas = std::sqrt(gate_of(options, 2 + static_cast<int>(kMaxFeatures)));
  const double place = largest_sd(robot.covariance.topLeftCorner<2, 2>());
  const double turn = std::sqrt(std::max(0.0, robot.covariance(2, 2)));
  // The noise of the least trusted landmark: a quality q multiplies standard deviations by 1 / sqrt(q).
  const bool trusts = options.distance != "paper" && options.quality == "paper" && options.quality_floor < 1;
  const double noise = trusts ? 1 / std::sqrt(std::max(map.min_quality(), options.quality_floor)) : 1;
  const double apex = sigmas * std::hypot(place, noise * map.largest_sd());
  const double half = std::min(sigmas * std::hypot(turn, noise * seen.bearing_sd), 3.2);
  const double along = sensor.yaw + seen.bearing.value_or(0);
  const auto keep = [&](std::uint32_t i) {
    if (seen.may_be(map[i].type) && !is_left_out(map[i], options)) found.push_back(i);
  };
  const auto at = [&](double range) -> Eigen::Vector2d {
    return sensor.at() + range * Eigen::Vector2d(std::cos(along), std::sin(along));
  };
  if (seen.extent) {
    const double farthest = std::max(std::abs(seen.extent->from), std::abs(seen.extent->to));
    const double slack = line_slack(robot, farthest);
    const double reach =
        std::hypot(*seen.range, farthest) + map.max_half_length() + slack + sigmas * noise * seen.range_sd;
    map.near(sensor.at(), reach, [&](std::uint32_t i) {
      if (map[i].is_line() && may_overlap(*seen.extent, sensor.at(), map[i], slack)) keep(i);
    });
    return found;
  }
  if (!seen.bearing) {  // a ring
    const double width = apex + sigmas * noise * seen.range_sd;
    map.near(sensor.at(), *seen.range + width, [&](std::uint32_t i) {
      if (std::abs((map[i].at - sensor.at()).norm() - *seen.range) <= width) keep(i);
    });
    return found;
  }
  if (seen.range) {
    const double chord = 2 * *seen.range * std::sin(std::min(half, 3.14) / 2);
    map.near(at(*seen.range), apex + sigmas * noise * seen.range_sd + chord, keep);
    return found;
  }
  const double reach = options.reach_of(seen, scales);
  if (half > 0.7) {
    map.near(sensor.at(), apex + reach, keep);
  } else {
    // Discs along the wedge, each 1.6 times as wide as the wedge there and half as far from the next.
    for (double t = 0; t <= reach + apex;) {
      const double wide = std::max(apex + t * std::tan(half), 0.02 * reach);
      map.near(at(t), 1.6 * wide, keep);
      t += wide;
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Bounds on the errors of range and bearing that pass the widest gate, from the largest deviation of each
/// source. They need no inverse and no angle.
class WidestGate {
 public:
  WidestGate(const SeenLandmark& seen, const Pose2& robot_from_sensor, const PoseEstimate& robot,
             const IdentificationOptions& options)
      : seen_(seen),
        options_(options),
        sensor_((robot.pose * robot_from_sensor).at()),
        gate_(gate_of(options, 2 + static_cast<int>(kMaxFeatures)) * (1 + 1e-6)),  // rounding
        place_(largest_sd(robot.covariance.topLeftCorner<2, 2>())),
        turn_(std::sqrt(std::max(0.0, robot.covariance(2, 2)))),
        lever_(robot_from_sensor.at().norm()) {
    const double along = robot.pose.yaw + robot_from_sensor.yaw + seen.bearing.value_or(0);
    cosine_ = std::cos(along), sine_ = std::sin(along);
  }

  bool excludes(const MapLandmark& landmark) const {
    if (seen_.extent) return false;
    const Eigen::Vector2d to = landmark.at - sensor_;
    const double square = to.squaredNorm(), range = std::sqrt(square),
                 trust = noise_divisor(landmark, options_);
    const double sd = largest_sd(landmark.covariance), map_error = sd * sd;
    const double left = cosine_ * to.y() - sine_ * to.x();
    const double sideways = place_ + (range + lever_) * turn_, ahead = place_ + lever_ * turn_;
    const double bearing = seen_.bearing_sd * seen_.bearing_sd;
    if (seen_.bearing && left * left > gate_ * ((bearing * square + map_error) / trust + sideways * sideways))
      return true;
    if (!seen_.range) return false;
    const double off = std::abs(*seen_.range - range) - kMinRange;
    return off > 0 &&
           off * off > gate_ * ((seen_.range_sd * seen_.range_sd + map_error) / trust + ahead * ahead);
  }

 private:
  static constexpr double kMinRange = 1e-3;  // m: expect() takes no range below
  const SeenLandmark& seen_;
  const IdentificationOptions& options_;
  Eigen::Vector2d sensor_;
  double gate_, place_, turn_, lever_;
  double cosine_ = 1, sine_ = 0;
};

double paper_distance(const SeenLandmark& seen, const Eigen::Vector2d& v, const FeatureComparison& features) {
  const double range = seen.range ? v[0] / seen.range_sd : 0,
               bearing = seen.bearing ? v[1] / seen.bearing_sd : 0;
  return range * range + bearing * bearing + features.weighted_squares;
}

Match match_from(const Candidates& c, std::optional<std::size_t> chosen, Verdict otherwise) {
  if (c.pairings.empty()) return {.verdict = c.verdict, .pairing = {}};
  if (!chosen) return {.verdict = otherwise, .pairing = {}};
  return {.verdict = Verdict::matched, .pairing = c.pairings[*chosen], .unmapped = 0};
}

std::vector<Match> assign_individually(const std::vector<Candidates>& all,
                                       const IdentificationOptions& options) {
  const bool exclusive = options.chosen_association() != "nearest";
  ChosenColumns chosen(all.size());
  std::vector<std::vector<Choice>> rows;
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto& row = rows.emplace_back();
    for (const CandidatePair& p : all[i].pairings) row.push_back({static_cast<int>(p.landmark), p.score});
    if (!row.empty()) chosen[i] = 0;  // best first
  }
  if (options.association == "greedy") chosen = assign_greedily(rows);
  if (exclusive && options.association != "greedy") chosen = assign_cheapest(rows, 1e6);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < all.size(); ++i) {
    matches.push_back(match_from(all[i], chosen[i], Verdict::taken));
    if (matches[i].verdict != Verdict::matched || !(options.ambiguity > 0)) continue;
    for (const CandidatePair& p : all[i].pairings)
      if (p.landmark != matches[i].pairing.landmark && p.score < matches[i].pairing.score + options.ambiguity)
        matches[i].verdict = Verdict::ambiguous;
  }
  return matches;
}

std::vector<Match> assign_by_probability(const SightingSet& seen, const std::vector<Candidates>& all,
                                         const std::vector<JointHypothesis>& hypotheses,
                                         const IdentificationOptions& options) {
  std::vector<Match> matches;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> probability(all[i].pairings.size(), 0);
    double none = 0;
    for (const JointHypothesis& h : hypotheses)
      (h.choice[i] < 0 ? none : probability[static_cast<std::size_t>(h.choice[i])]) += h.probability;
    std::optional<std::size_t> best;
    for (std::size_t c = 0; c < probability.size(); ++c)
      if (!best || probability[c] > probability[*best]) best = c;
    Match match = match_from(all[i], best, Verdict::too_far);
    if (match.verdict == Verdict::matched) {
      match.probability = probability[*best];
      match.unmapped = none;
      if (none > 0.5)
        match.verdict = Verdict::too_far;
      else if (certainty_of(seen.sightings[i], match.probability, none) <
               options.required_certainty(seen.sightings[i]))
        match.verdict = Verdict::ambiguous;
    }
    matches.push_back(match);
  }
  return matches;
}

PoseEstimate mixture(const PoseEstimate& before, const std::vector<JointHypothesis>& hypotheses) {
  std::vector<PoseEstimate> after;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // relative to the pose before
  const auto off = [](const Pose2& from, const Pose2& to) {
    return Eigen::Vector3d(to.x - from.x, to.y - from.y, wrap_angle(to.yaw - from.yaw));
  };
  for (const JointHypothesis& h : hypotheses) {
    after.push_back(update_pose(before, h.evidence));
    mean += h.probability * off(before.pose, after.back().pose);
  }
  PoseEstimate mixed{pose_of(before.pose.vector() + mean), Eigen::Matrix3d::Zero()};
  for (std::size_t i = 0; i < after.size(); ++i) {
    const Eigen::Vector3d d = off(mixed.pose, after[i].pose);
    mixed.covariance += hypotheses[i].probability * (after[i].covariance + d * d.transpose());
  }
  return mixed;
}

}  // namespace

double IdentificationOptions::reach_of(const SeenLandmark& seen, const FeatureScales& scales) const {
  if (bearing_reach > 0) return bearing_reach;
  const double reach = scales.identification_reach(seen.type);
  return sensor_range > 0 && reach < kHorizon ? std::min(reach, sensor_range) : reach;
}

double IdentificationOptions::clutter_reach() const {
  return bearing_reach > 0 ? bearing_reach : sensor_range > 0 ? sensor_range : kNearObjects;
}

void IdentificationOptions::describe(OptionVisitor& option) {
  option("distance", distance,
         {.help = "Distance of a sighting and a landmark: with all covariances, or eq. 11 of the paper",
          .choices = {"mahalanobis", "paper"}});
  option("association", association,
         {.help = "Data association of the sightings of one set",
          .choices = {"auto", "nearest", "greedy", "hungarian", "jcbb", "joint"}});
  option("gate", gate, {.help = "Probability that a right pairing passes", .min = 0.5, .max = 0.999999});
  option("certainty", certainty,
         {.help = "joint: pairings less probable are rejected as ambiguous", .min = 0, .max = 1});
  option("bearing_certainty", bearing_certainty,
         {.help = "joint: the same for sightings without a range or a bearing, if it is more",
          .min = 0,
          .max = 1});
  option("ambiguity", ambiguity,
         {.help = "Other associations: lead in squared distance a landmark needs over the next", .min = 0});
  option("feature_tolerance", feature_tolerance,
         {.help = "Fraction of a feature's value by which two sensors may disagree", .min = 0, .max = 10});
  option("feature_limit", feature_limit,
         {.help = "Squared standard deviations by which one feature may differ", .min = 0});
  option(
      "alpha", alpha,
      {.help = "Weights alpha_f of eq. 11 of the paper, e.g. rock.radius=4,rock.height=2; others follow from "
               "the landmark types"});
  option("clutter", clutter,
         {.help = "Least density of sightings without a landmark, per metre of range and radian of bearing",
          .min = 1e-12,
          .max = 1e3});
  option("learn_clutter", learn_clutter,
         {.help = "Estimate the density of sightings without a landmark over the drive"});
  option("bearing_reach", bearing_reach,
         {.help = "Largest range of a sighting without range, metres; 0: that of its landmark type, or of a "
                  "sensor that measures no ranges",
          .min = 0,
          .max = 1e6});
  option("node_limit", node_limit,
         {.help = "Largest number of nodes of a joint search", .min = 1, .max = 1e9});
  option(
      "quality", quality,
      {.help = "Use the probability that a landmark exists as prior of its pairings, or divide its noise by "
               "eq. 8 of the paper",
       .choices = {"existence", "paper"}});
  option("quality_floor", quality_floor,
         {.help = "Smallest quality that the noise of a landmark is divided by; 1 turns quality off",
          .min = 1e-3,
          .max = 1});
  option("use_terrain", use_terrain,
         {.help = "With --dem: landmarks that the terrain hides from the sensor are no candidates"});
  option("use_identities", use_identities, {.help = "Use the identities of landmarks in the log"});
}

std::string_view IdentificationOptions::chosen_association() const {
  return association != "auto" ? association : distance == "paper" ? "nearest" : "joint";
}

bool IdentificationOptions::may_be_mapped(const SeenLandmark& seen) const {
  return held_types.empty() ||
         std::ranges::any_of(held_types, [&](TypeId type) { return seen.may_be(type); });
}

bool IdentificationOptions::distance_applies() const {
  return distance != "paper" || (association != "joint" && association != "jcbb");
}

std::string_view wording(Verdict verdict) {
  constexpr std::array<std::string_view, kVerdicts> kWords{
      "matched",          "not a usable number", "no such landmark in the map",
      "no landmark near", "features differ",     "outside the gate",
      "ambiguous",        "landmark taken"};
  return kWords[static_cast<std::size_t>(verdict)];
}

std::string_view verdict_name(Verdict verdict) {
  constexpr std::array<std::string_view, kVerdicts> kNames{
      "matched",         "unsound", "unknown_type", "nothing_near",
      "features_differ", "too_far", "ambiguous",    "taken"};
  return kNames[static_cast<std::size_t>(verdict)];
}

std::vector<AngleFix> headings_from_angles(const SeenLandmark& seen, const Pose2& robot_from_sensor,
                                           const MapLandmark& landmark, double robot_yaw,
                                           const FeatureScales& scales,
                                           const IdentificationOptions& options) {
  if (!seen.type || *seen.type != landmark.type) return {};
  std::vector<AngleFix> fixes =
      yaws_from_angles(scales, landmark.type, seen.features, landmark.features,
                       robot_yaw + robot_from_sensor.yaw, options.feature_tolerance);
  for (AngleFix& fix : fixes) {
    fix.heading.yaw = wrap_angle(fix.heading.yaw - robot_from_sensor.yaw);
    fix.heading.sd /= std::sqrt(noise_divisor(landmark, options));
  }
  return fixes;
}

Candidates candidates(const SeenLandmark& seen, const Pose2& robot_from_sensor, const PoseEstimate& robot,
                      const LandmarkGrid& map, const FeatureScales& scales,
                      const IdentificationOptions& options) {
  Candidates result;
  if (!seen.is_valid()) return {Verdict::unsound, {}};
  const bool paper = options.distance == "paper";
  const Pose2 sensor = robot.pose * robot_from_sensor;
  std::vector<std::uint32_t> reach;
  if (seen.type == kNoSuchType) return {Verdict::unknown_type, {}};
  const bool known = options.use_identities && seen.identity;
  if (known) {
    const auto found = map.find(*seen.identity);
    if (!found) return {Verdict::unknown_type, {}};
    reach = {*found};
  } else if (!options.may_be_mapped(seen)) {
    return {Verdict::unknown_type, {}};
  } else {
    reach = landmarks_in_reach(seen, sensor, robot, map, scales, options);
    if (options.use_terrain)
      std::erase_if(reach, [&](std::uint32_t i) {
        return is_hidden(sensor, robot.covariance.topLeftCorner<2, 2>(), map[i].at, options.visible);
      });
  }
  result.verdict = Verdict::nothing_near;
  const KnownFeatures seen_features =
      seen.type ? features_in_map(scales, *seen.type, seen.features, sensor.yaw, robot.covariance(2, 2))
                : seen.features;
  const WidestGate widest(seen, robot_from_sensor, robot, options);
  for (const std::uint32_t i : reach) {
    const MapLandmark& landmark = map[i];
    if (!known && !seen.may_be(landmark.type)) continue;
    if (seen.extent && !landmark.is_line()) continue;
    // `too_far` is final: only landmarks inside the gate still count.
    if (result.verdict == Verdict::too_far && widest.excludes(landmark)) continue;
    FeatureComparison features;
    if (seen.type == landmark.type)
      features = compare_features(scales, landmark.type, seen_features, landmark.features,
                                  options.feature_tolerance);
    else if (const KnownFeatures* possible = seen.features_as(landmark.type))
      features =
          compare_features(scales, landmark.type, *possible, landmark.features, options.feature_tolerance);
    if (!known && (paper ? features.largest_weighted : features.largest) > options.feature_limit) {
      if (result.verdict == Verdict::nothing_near) result.verdict = Verdict::features_differ;
      continue;
    }
    const ExpectedSighting expected = expect(robot.pose, robot_from_sensor, seen, landmark);
    Eigen::Matrix2d map_error = landmark.covariance;
    if (seen.extent)
      map_error += swing_variance(landmark, sensor.at()) * landmark.normal * landmark.normal.transpose();
    CandidatePair p{
        .landmark = i,
        .evidence = seen.bearing || seen.extent
                        ? evidence_of(seen, expected, map_error, noise_divisor(landmark, options))
                        : evidence_of(correct_curvature(seen, robot, robot_from_sensor, landmark.at),
                                      expected, landmark.covariance, noise_divisor(landmark, options))};
    // Angles depend on the heading as bearings do: they are rows of the innovation, not features apart.
    if (!paper && seen.type && *seen.type == landmark.type && scales.has_angles(landmark.type)) {
      for (const AngleFix& fix :
           headings_from_angles(seen, robot_from_sensor, landmark, robot.pose.yaw, scales, options))
        p.evidence += evidence_of(fix.heading, robot.pose, fix.period);
      features = compare_features(scales, landmark.type,
                                  features_without_angles(scales, landmark.type, seen_features),
                                  landmark.features, options.feature_tolerance);
    }
    const JointDistance d = joint_distance(p.evidence, robot.covariance);
    p.features = features.squares + features.missing;
    p.feature_count = features.used + features.missing;
    if (paper) {
      p.squares = p.score = paper_distance(seen, innovation(seen, expected.value), features);
    } else {
      p.squares = d.squares + features.squares;
      p.score = d.squares + d.log_det + p.features - 2 * std::log(existence_prior(landmark, options));
    }
    if (!(p.squares <= gate_of(options, p.evidence.rows + features.used)))
      result.verdict = Verdict::too_far;
    else
      result.pairings.push_back(p);
  }
  std::ranges::stable_sort(result.pairings, {}, &CandidatePair::score);
  return result;
}

Identification identify(const SightingSet& seen, const PoseEstimate& robot, const LandmarkGrid& map,
                        const FeatureScales& scales, const IdentificationOptions& options) {
  if (!options.distance_applies())
    throw std::invalid_argument("association " + options.association + " does not use distance=paper");
  std::vector<Candidates> all;
  for (const SeenLandmark& sighting : seen.sightings)
    all.push_back(candidates(sighting, seen.robot_from_sensor, robot, map, scales, options));
  if (options.chosen_association() == "joint") {
    if (const auto hypotheses = joint_hypotheses(all, seen, map, robot.covariance, options))
      return {assign_by_probability(seen, all, *hypotheses, options), mixture(robot, *hypotheses)};
  } else if (options.association == "jcbb") {
    if (const auto choice = joint_compatibility(all, robot.covariance, options)) {
      std::vector<Match> matches;
      for (std::size_t i = 0; i < all.size(); ++i) {
        const int c = (*choice)[i];
        matches.push_back(
            match_from(all[i], c < 0 ? std::nullopt : std::optional<std::size_t>(c), Verdict::too_far));
      }
      return {std::move(matches), {}};
    }
  }
  return {assign_individually(all, options), {}};
}

}  // namespace waymark::localization
