// SPDX-License-Identifier: Apache-2.0
#include "localization/global/constellation_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <set>

namespace waymark::localization {
namespace {

constexpr std::size_t kMaxSightings = 40;  // the nearest ones; more only cost time
constexpr std::size_t kSeenNeighbours = 7;
constexpr double kMaxCells = 3000;  // of one triangle; with more its lengths are too uncertain to look up
constexpr double kRepeats = 0.05;   // expected chance poses below which a second pose is no chance
constexpr double kUnmapped = 0.2;   // least fraction of what is seen that the map may lack
constexpr std::size_t kMaxGuesses = 30000;  // from the triangles with the fewest hits

}  // namespace

TangentPlane plane_at(const LandmarkPosition& place) {
  const Eigen::Vector3d pole = Eigen::Vector3d::UnitZ();
  if (place.up.dot(pole) > 1 - 1e-12) return {.origin = place.at};
  const Eigen::Vector3d east = pole.cross(place.up).normalized();
  return {.origin = place.at, .east = east, .north = place.up.cross(east)};
}

/// On the plane, at the true distance from its origin.
Eigen::Vector2d flatten(const TangentPlane& plane, const Eigen::Vector3d& at) {
  const Eigen::Vector3d d = at - plane.origin;
  const Eigen::Vector2d p(plane.east.dot(d), plane.north.dot(d));
  const double flat = p.norm();
  return flat > 0 ? Eigen::Vector2d(p * (d.norm() / flat)) : p;
}

ConstellationSearch::ConstellationSearch(const ConstellationIndex& index, const SightingSet& seen)
    : index_(index), o_(index.options_), volume_(index.area_ * 2 * std::numbers::pi) {
  for (std::size_t i = 0; i < seen.sightings.size(); ++i) add(seen, i);
  std::ranges::stable_sort(points_, {}, [](const Seen& s) { return s.range; });
  if (points_.size() > kMaxSightings) points_.resize(kMaxSightings);
  for (Seen& s : points_) s.rarity = rarity(s);
  for (const Seen& s : points_) middle_ += s.at / static_cast<double>(points_.size());
  for (const Seen& s : points_) extent_ = std::max(extent_, (s.at - middle_).norm());
  total_ = seen.sightings.size();
}

ConstellationAnswer ConstellationSearch::find() {
  if (index_.size() == 0) return {.fix = {}, .reason = "the map is empty", .candidates = {}};
  const std::size_t named = count_named();
  if (named < 2 && points_.size() < static_cast<std::size_t>(o_.min_matches))
    return {.fix = {}, .reason = kTooFewSightings, .candidates = {}};
  if (named >= 2) guess_by_names();
  if (named < 2) guess_by_triangles();
  if (guesses_.empty()) return {.fix = {}, .reason = "no such constellation in the map", .candidates = {}};
  ConstellationAnswer answer{.fix = {}, .reason = {}, .candidates = fit_guesses()};
  answer.reason = verdict(answer.candidates, named);
  if (answer.reason.empty()) answer.fix = answer.candidates[0];
  return answer;
}

std::optional<ConstellationFix> ConstellationSearch::check(const Pose2& expected) {
  if (index_.size() == 0 || points_.empty()) return {};
  const Eigen::Vector2d origin = index_.positions_[0].at.head<2>();
  const Eigen::Vector2d middle = expected.at() + rotation(expected.yaw) * middle_ - origin;
  std::optional<ConstellationFix> found =
      fit({.anchor = 0, .middle = middle, .yaw = expected.yaw, .weight = 1});
  if (found && !objection(*found, count_named()).empty()) found.reset();
  return found;
}

std::size_t ConstellationSearch::count_named() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(points_, [](const Seen& s) { return s.named.has_value(); }));
}

void ConstellationSearch::add(const SightingSet& seen, std::size_t i) {
  const SeenLandmark& s = seen.sightings[i];
  if (!s.is_valid() || !s.has_position() || s.type == kNoSuchType) return;
  const bool is_named = o_.identification.use_identities && s.identity;
  const auto may_be = [&](TypeId type) { return s.may_be(type); };
  if (!is_named && std::ranges::none_of(index_.types_, may_be)) return;
  Seen p{.index = i,
         .sighting = &s,
         .features = s.type ? features_without_angles(index_.scales_, *s.type, s.features) : s.features,
         .mount_yaw = seen.robot_from_sensor.yaw,
         .at = {},
         .covariance = {},
         .range = *s.range,
         .sd = 0,
         .rarity = 1,
         .named = {}};
  const Pose2& mount = seen.robot_from_sensor;
  const double along = mount.yaw + *s.bearing;
  p.at = mount.at() + *s.range * Eigen::Vector2d(std::cos(along), std::sin(along));
  const Eigen::Vector2d sd(s.range_sd, *s.range * std::min(s.bearing_sd, 1.0));
  const Eigen::Matrix2d r = rotation(along);
  p.covariance = r * sd.cwiseAbs2().asDiagonal() * r.transpose();
  p.sd = sd.maxCoeff();
  if (is_named) {
    const auto found = index_.by_key_.find(*s.identity);
    if (found == index_.by_key_.end()) return;
    p.named = found->second;
  }
  points_.push_back(p);
}

bool ConstellationSearch::alike(const Seen& s, std::uint32_t landmark) const {
  if (s.named) return *s.named == landmark;
  const MapLandmark& l = index_.landmarks_[landmark];
  if (s.sighting->may_be_anything()) return true;
  const KnownFeatures* const possible = s.sighting->features_as(l.type);
  if (!possible) return false;
  return compare_features(index_.scales_, l.type, s.sighting->type ? s.features : *possible, l.features,
                          o_.identification.feature_tolerance)
             .largest <= o_.identification.feature_limit;
}

bool ConstellationSearch::faces_alike(const Seen& s, std::uint32_t landmark, double yaw) const {
  constexpr double kYawSd = 0.05;  // rad, of the heading of a guess
  if (s.named || !s.sighting->type || !index_.scales_.has_angles(*s.sighting->type)) return true;
  const double sensor_yaw = yaw + s.mount_yaw;
  for (const AngleFix& fix : yaws_from_angles(index_.scales_, *s.sighting->type, s.sighting->features,
                                              index_.landmarks_[landmark].features, sensor_yaw,
                                              o_.identification.feature_tolerance)) {
    const double off = wrap_angle(fix.heading.yaw - sensor_yaw);
    const double variance = fix.heading.sd * fix.heading.sd + kYawSd * kYawSd;
    if (!(off * off <= o_.identification.feature_limit * variance)) return false;
  }
  return true;
}

double ConstellationSearch::rarity(const Seen& s) const {
  if (s.named) return 1 / static_cast<double>(index_.size());
  std::size_t alike_count = 0;
  for (const std::uint32_t i : index_.sample_) alike_count += alike(s, i);
  return (static_cast<double>(alike_count) + 0.5) / (static_cast<double>(index_.sample_.size()) + 0.5);
}

void ConstellationSearch::guess(std::uint32_t anchor, const std::array<const Seen*, 3>& seen,
                                const std::array<std::uint32_t, 3>& landmarks, std::size_t count,
                                double weight) {
  const TangentPlane plane = plane_at(index_.positions_[anchor]);
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = from;
  std::array<Eigen::Vector2d, 3> flat;
  for (std::size_t i = 0; i < count; ++i) {
    flat[i] = flatten(plane, index_.positions_[landmarks[i]].at);
    from += seen[i]->at / static_cast<double>(count), to += flat[i] / static_cast<double>(count);
  }
  double cosine = 0, sine = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d a = seen[i]->at - from, b = flat[i] - to;
    cosine += a.dot(b), sine += a.x() * b.y() - a.y() * b.x();
  }
  const double yaw = std::atan2(sine, cosine);
  guesses_.push_back({anchor, to + rotation(yaw) * (middle_ - from), yaw, weight});
}

void ConstellationSearch::guess_by_names() {
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (std::size_t j = i + 1; j < points_.size(); ++j) {
      const Seen &a = points_[i], &b = points_[j];
      if (!a.named || !b.named || *a.named == *b.named) continue;
      const double seen = (a.at - b.at).norm();
      const double real = (index_.positions_[*a.named].at - index_.positions_[*b.named].at).norm();
      const double sd = std::sqrt(a.sd * a.sd + b.sd * b.sd + 2 * index_.typical_sd_ * index_.typical_sd_);
      if (std::abs(seen - real) <= o_.sigmas * sd && seen > 2 * sd)
        guess(*a.named, {&a, &b, nullptr}, {*a.named, *b.named, 0}, 2, 1);
    }
}

void ConstellationSearch::guess_by_triangles() {
  std::set<std::array<std::size_t, 3>> triples;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    near.clear();
    for (std::size_t j = 0; j < points_.size(); ++j)
      if (j != i) near.emplace_back((points_[i].at - points_[j].at).squaredNorm(), j);
    std::ranges::sort(near);
    const std::size_t count = std::min(near.size(), kSeenNeighbours);
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b) {
        std::array<std::size_t, 3> t{i, near[a].second, near[b].second};
        std::ranges::sort(t);
        triples.insert(t);
      }
  }
  std::vector<std::vector<Hit>> all;
  for (const auto& t : triples)
    if (look_up(t); !hits_.empty()) all.push_back(std::move(hits_));
  // Triangles with few hits are the most informative.
  std::ranges::stable_sort(all, {}, &std::vector<Hit>::size);
  for (const auto& hits : all) {
    const double weight = 1 / static_cast<double>(hits.size());
    for (const auto& [seen, corners] : hits) guess(corners[0], seen, corners, 3, weight);
    if (guesses_.size() > kMaxGuesses) break;
  }
}

void ConstellationSearch::look_up(const std::array<std::size_t, 3>& triple) {
  std::array<std::size_t, 3> order{0, 1, 2};
  hits_.clear();
  do look_up({&points_[triple[order[0]]], &points_[triple[order[1]]], &points_[triple[order[2]]]});
  while (std::ranges::next_permutation(order).found);
}

void ConstellationSearch::look_up(const std::array<const Seen*, 3>& c) {
  std::array<double, 3> side, slack;
  for (std::size_t i = 0; i < 3; ++i) {
    const Seen &a = *c[(i + 1) % 3], &b = *c[(i + 2) % 3];
    const Eigen::Vector2d d = a.at - b.at;
    side[i] = d.norm();
    if (!(side[i] > 0)) return;
    const double variance = d.dot((a.covariance + b.covariance) * d) / (side[i] * side[i]);
    slack[i] = o_.sigmas * std::sqrt(variance + 2 * index_.typical_sd_ * index_.typical_sd_);
  }
  if (side[0] + slack[0] < side[1] - slack[1] || side[1] + slack[1] < side[2] - slack[2]) return;
  const Eigen::Vector2d ab = c[1]->at - c[0]->at, ac = c[2]->at - c[0]->at;
  const double area = ab.x() * ac.y() - ab.y() * ac.x();
  // Too flat to have an orientation: the height over the longest side is within the error.
  if (!(std::abs(area) > side[0] * std::max(slack[0], slack[2]) / 2)) return;
  const double cell = index_.length_cell_;
  const auto low = [&](std::size_t i) { return std::floor(std::max(0.0, side[i] - slack[i]) / cell); };
  const auto high = [&](std::size_t i) { return std::floor((side[i] + slack[i]) / cell); };
  if ((high(0) - low(0) + 1) * (high(1) - low(1) + 1) > kMaxCells || index_.corners_.empty()) return;
  for (const auto& types : possible_types(c))
    for (double x = low(0); x <= high(0); ++x)
      for (double y = low(1); y <= std::min(high(1), x); ++y) {
        const std::size_t bucket = index_.bucket(index_.key(types, x, y, area > 0));
        for (std::uint32_t k = index_.first_[bucket]; k < index_.first_[bucket + 1]; ++k)
          compare(c, index_.corners_[k], side, slack, x, y, area > 0);
      }
}

void ConstellationSearch::compare(const std::array<const Seen*, 3>& c,
                                  const std::array<std::uint32_t, 3>& corners,
                                  const std::array<double, 3>& side, const std::array<double, 3>& slack,
                                  double x, double y, bool left) {
  const auto at = [&](std::size_t i) -> const Eigen::Vector3d& { return index_.positions_[corners[i]].at; };
  for (std::size_t i = 0; i < 3; ++i) {
    const double real = (at((i + 1) % 3) - at((i + 2) % 3)).norm();
    if (!(std::abs(real - side[i]) <= slack[i])) return;
    // Another key in the same bucket is found again in its own cell.
    if (i < 2 && std::floor(real / index_.length_cell_) != (i == 0 ? x : y)) return;
  }
  if (index_.turns_left(corners) != left) return;
  for (std::size_t i = 0; i < 3; ++i)
    if (!alike(*c[i], corners[i])) return;
  hits_.push_back({c, corners});
}

std::vector<std::array<TypeId, 3>> ConstellationSearch::possible_types(
    const std::array<const Seen*, 3>& c) const {
  std::vector<std::array<TypeId, 3>> all{{}};
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<std::array<TypeId, 3>> next;
    for (auto types : all) {
      for (const TypeId type : index_.types_) {
        if (!c[i]->sighting->may_be(type)) continue;
        types[i] = type;
        next.push_back(types);
      }
    }
    all = std::move(next);
  }
  return all;
}

std::string_view ConstellationSearch::objection(const ConstellationFix& fix, std::size_t named) const {
  if (named >= 2) {
    const double min_matched = std::max(2.0, 0.6 * static_cast<double>(named));
    return fix.matched >= min_matched ? "" : "the identities contradict the distances";
  }
  if (fix.matched < o_.min_matches) return "too few sightings fit one pose";
  if (!(fix.log_false_alarms < std::log(o_.false_alarms))) return "the best pose may fit by chance";
  return "";
}

std::string_view ConstellationSearch::verdict(const std::vector<ConstellationFix>& fixes,
                                              std::size_t named) const {
  if (fixes.empty()) return "no such constellation in the map";
  const std::string_view doubt = objection(fixes[0], named);
  if (!doubt.empty() || named >= 2 || fixes.size() == 1) return doubt;
  const ConstellationFix &best = fixes[0], &next = fixes[1];
  if (!(badness(next) - badness(best) > std::log(o_.lead))) return "two poses fit alike";
  // Two places that chance does not explain repeat each other. What only one of them shows may be missing in
  // the map at the other, which may lack as large a part of what is seen as at the best pose.
  const auto seen = static_cast<double>(points_.size());
  const double unmapped =
      o_.had_pose ? kUnmapped : std::max(kUnmapped, (seen - best.matched + 1) / (seen + 2));
  const double more = (best.matched - next.matched) * std::log((1 - unmapped) / unmapped);
  const bool repeats = badness(next) < std::log(kRepeats);
  return repeats && !(more > std::log(o_.lead)) ? "the map has two such places" : "";
}

ConstellationAnswer ConstellationIndex::find(const SightingSet& seen) const {
  return ConstellationSearch(*this, seen).find();
}

std::optional<ConstellationFix> ConstellationIndex::check(const SightingSet& seen,
                                                          const Pose2& expected) const {
  return ConstellationSearch(*this, seen).check(expected);
}

}  // namespace waymark::localization
