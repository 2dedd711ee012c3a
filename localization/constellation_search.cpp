// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <set>
#include <unordered_map>

#include "localization/constellation.hpp"

namespace waymark {
namespace {

constexpr std::size_t kMostSightings = 40;  // the nearest ones; more add time and nothing else
constexpr std::size_t kSeenNeighbours = 7;
constexpr double kMostCells = 3000;  // of one triangle: beyond, its lengths are too uncertain to look up
constexpr std::size_t kMostGuesses = 30000;  // from the triangles that fit the fewest places
constexpr std::size_t kKept = 10;

TangentPlane plane_at(const PlacedLandmark& place) {
  const Eigen::Vector3d pole = Eigen::Vector3d::UnitZ();
  if (place.up.dot(pole) > 1 - 1e-12) return {.origin = place.at};
  const Eigen::Vector3d east = pole.cross(place.up).normalized();
  return {.origin = place.at, .east = east, .north = place.up.cross(east)};
}

/// On the plane, at the true distance from its origin.
Eigen::Vector2d flattened(const TangentPlane& plane, const Eigen::Vector3d& at) {
  const Eigen::Vector3d d = at - plane.origin;
  const Eigen::Vector2d p(plane.east.dot(d), plane.north.dot(d));
  const double flat = p.norm();
  return flat > 0 ? Eigen::Vector2d(p * (d.norm() / flat)) : p;
}

Eigen::Matrix2d turned(double yaw) {
  return Eigen::Rotation2Dd(yaw).toRotationMatrix();
}

}  // namespace

class ConstellationSearch {
 public:
  ConstellationSearch(const ConstellationIndex& index, const SightingSet& seen)
      : index_(index), o_(index.options_) {
    for (std::size_t i = 0; i < seen.sightings.size(); ++i) add(seen, i);
    std::ranges::stable_sort(points_, {}, [](const Seen& s) { return s.range; });
    if (points_.size() > kMostSightings) points_.resize(kMostSightings);
    for (Seen& s : points_) s.rarity = rarity(s);
    for (const Seen& s : points_) middle_ += s.at / static_cast<double>(points_.size());
    for (const Seen& s : points_) extent_ = std::max(extent_, (s.at - middle_).norm());
    total_ = seen.sightings.size();
  }

  ConstellationAnswer find() {
    if (index_.size() == 0) return {.fix = {}, .reason = "the map is empty", .candidates = {}};
    std::size_t named = 0;
    for (const Seen& s : points_) named += s.named.has_value();
    if (named < 2 && points_.size() < static_cast<std::size_t>(o_.least_matches))
      return {.fix = {}, .reason = "too few sightings with a range", .candidates = {}};
    if (named >= 2) guess_by_names();
    if (named < 2) guess_by_triangles();
    if (guesses_.empty()) return {.fix = {}, .reason = "no such constellation in the map", .candidates = {}};
    ConstellationAnswer answer{.fix = {}, .reason = {}, .candidates = fitted()};
    answer.reason = verdict(answer.candidates, named);
    if (answer.reason.empty()) answer.fix = answer.candidates[0];
    return answer;
  }

 private:
  struct Seen {
    std::size_t index = 0;  // in the set
    const SeenLandmark* sighting = nullptr;
    Eigen::Vector2d at;  // from the robot
    Eigen::Matrix2d covariance;
    double range = 0, sd = 0, rarity = 1;
    std::optional<std::uint32_t> named;
  };
  /// A pose that three sightings and three landmarks vote for.
  struct Guess {
    std::uint32_t anchor;    // landmark whose plane the pose is on
    Eigen::Vector2d middle;  // where the middle of the sightings is
    double yaw, weight;
  };
  using Matches = std::vector<std::optional<std::uint32_t>>;
  using Hit = std::pair<std::array<const Seen*, 3>, std::array<std::uint32_t, 3>>;

  void add(const SightingSet& seen, std::size_t i) {
    const SeenLandmark& s = seen.sightings[i];
    if (!s.sound() || !s.range || s.type == kNoSuchType) return;
    Seen p{.index = i,
           .sighting = &s,
           .at = {},
           .covariance = {},
           .range = *s.range,
           .sd = 0,
           .rarity = 1,
           .named = {}};
    const Pose2& mount = seen.robot_from_sensor;
    const double along = mount.yaw + s.bearing;
    p.at = mount.at() + *s.range * Eigen::Vector2d(std::cos(along), std::sin(along));
    const Eigen::Vector2d sd(s.range_sd, *s.range * std::min(s.bearing_sd, 1.0));
    const Eigen::Matrix2d r = turned(along);
    p.covariance = r * sd.cwiseAbs2().asDiagonal() * r.transpose();
    p.sd = sd.maxCoeff();
    if (o_.use_identities && s.identity) {
      const auto found = index_.by_key_.find(*s.identity);
      if (found == index_.by_key_.end()) return;
      p.named = found->second;
    }
    points_.push_back(p);
  }

  bool alike(const Seen& s, std::uint32_t landmark) const {
    if (s.named) return *s.named == landmark;
    const MapLandmark& l = index_.landmarks_[landmark];
    if (!s.sighting->type) return true;
    if (*s.sighting->type != l.type) return false;
    return compare_features(index_.scales_, l.type, s.sighting->features, l.features, o_.feature_tolerance)
               .largest <= o_.feature_limit;
  }

  /// Part of the landmarks that a sighting could be by type and features.
  double rarity(const Seen& s) const {
    if (s.named) return 1 / static_cast<double>(index_.size());
    std::size_t alike_count = 0;
    for (const std::uint32_t i : index_.sample_) alike_count += alike(s, i);
    return (static_cast<double>(alike_count) + 0.5) / (static_cast<double>(index_.sample_.size()) + 0.5);
  }

  void guess(std::uint32_t anchor, const std::array<const Seen*, 3>& seen,
             const std::array<std::uint32_t, 3>& landmarks, std::size_t count, double weight) {
    const TangentPlane plane = plane_at(index_.places_[anchor]);
    Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = from;
    std::array<Eigen::Vector2d, 3> flat;
    for (std::size_t i = 0; i < count; ++i) {
      flat[i] = flattened(plane, index_.places_[landmarks[i]].at);
      from += seen[i]->at / static_cast<double>(count), to += flat[i] / static_cast<double>(count);
    }
    double cosine = 0, sine = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2d a = seen[i]->at - from, b = flat[i] - to;
      cosine += a.dot(b), sine += a.x() * b.y() - a.y() * b.x();
    }
    const double yaw = std::atan2(sine, cosine);
    guesses_.push_back({anchor, to + turned(yaw) * (middle_ - from), yaw, weight});
  }

  void guess_by_names() {
    for (std::size_t i = 0; i < points_.size(); ++i)
      for (std::size_t j = i + 1; j < points_.size(); ++j) {
        const Seen &a = points_[i], &b = points_[j];
        if (!a.named || !b.named || *a.named == *b.named) continue;
        const double seen = (a.at - b.at).norm();
        const double real = (index_.places_[*a.named].at - index_.places_[*b.named].at).norm();
        const double sd = std::sqrt(a.sd * a.sd + b.sd * b.sd + 2 * index_.typical_sd_ * index_.typical_sd_);
        if (std::abs(seen - real) <= o_.sigmas * sd && seen > 2 * sd)
          guess(*a.named, {&a, &b, nullptr}, {*a.named, *b.named, 0}, 2, 1);
      }
  }

  void guess_by_triangles() {
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
    // What fits few places says most.
    std::ranges::stable_sort(all, {}, &std::vector<Hit>::size);
    for (const auto& hits : all) {
      const double weight = 1 / static_cast<double>(hits.size());
      for (const auto& [seen, corners] : hits) guess(corners[0], seen, corners, 3, weight);
      if (guesses_.size() > kMostGuesses) break;
    }
  }

  void look_up(const std::array<std::size_t, 3>& triple) {
    std::array<std::size_t, 3> order{0, 1, 2};
    hits_.clear();
    do look_up({&points_[triple[order[0]]], &points_[triple[order[1]]], &points_[triple[order[2]]]});
    while (std::ranges::next_permutation(order).found);
  }

  // Corner i lies opposite side i, longest first.
  void look_up(const std::array<const Seen*, 3>& c) {
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
    // Too flat to say how it turns: the height over the longest side is within the error.
    if (!(std::abs(area) > side[0] * std::max(slack[0], slack[2]) / 2)) return;
    const double cell = index_.length_cell_;
    const auto low = [&](std::size_t i) { return std::floor(std::max(0.0, side[i] - slack[i]) / cell); };
    const auto high = [&](std::size_t i) { return std::floor((side[i] + slack[i]) / cell); };
    if ((high(0) - low(0) + 1) * (high(1) - low(1) + 1) > kMostCells || index_.corners_.empty()) return;
    for (const auto& types : types_of(c))
      for (double x = low(0); x <= high(0); ++x)
        for (double y = low(1); y <= std::min(high(1), x); ++y) {
          const std::size_t bucket = index_.bucket(index_.key(types, x, y, area > 0));
          for (std::uint32_t k = index_.first_[bucket]; k < index_.first_[bucket + 1]; ++k)
            compare(c, index_.corners_[k], side, slack, x, y, area > 0);
        }
  }

  void compare(const std::array<const Seen*, 3>& c, const std::array<std::uint32_t, 3>& corners,
               const std::array<double, 3>& side, const std::array<double, 3>& slack, double x, double y,
               bool left) {
    const auto at = [&](std::size_t i) -> const Eigen::Vector3d& { return index_.places_[corners[i]].at; };
    for (std::size_t i = 0; i < 3; ++i) {
      const double real = (at((i + 1) % 3) - at((i + 2) % 3)).norm();
      if (!(std::abs(real - side[i]) <= slack[i])) return;
      // Another key in the same bucket would be met again in its own cell.
      if (i < 2 && std::floor(real / index_.length_cell_) != (i == 0 ? x : y)) return;
    }
    if (index_.turns_left(corners) != left) return;
    for (std::size_t i = 0; i < 3; ++i)
      if (!alike(*c[i], corners[i])) return;
    hits_.push_back({c, corners});
  }

  // A sighting without a type may be of any.
  std::vector<std::array<TypeId, 3>> types_of(const std::array<const Seen*, 3>& c) const {
    std::vector<std::array<TypeId, 3>> all{{}};
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<std::array<TypeId, 3>> next;
      for (auto types : all) {
        if (c[i]->sighting->type) {
          types[i] = *c[i]->sighting->type;
          next.push_back(types);
          continue;
        }
        for (const TypeId type : index_.types_) {
          types[i] = type;
          next.push_back(types);
        }
      }
      all = std::move(next);
    }
    return all;
  }

  // Guesses that agree stand together; the best of each crowd is fitted.
  std::vector<ConstellationFix> fitted() {
    double sd = index_.typical_sd_;
    for (const Seen& s : points_) sd = std::max(sd, s.sd);
    const double cell = std::max(3 * sd, 1e-6), turn = 0.15;
    struct Crowd {
      double weight = 0;
      std::size_t first = 0;
    };
    std::unordered_map<std::uint64_t, Crowd> crowds;
    const auto key = [&](const Guess& g) {
      const Eigen::Vector3d at = plane_at(index_.places_[g.anchor]).place(g.middle) / cell;
      std::uint64_t k = mixed(static_cast<std::uint64_t>(std::llround(wrapped(g.yaw) / turn)));
      for (int i = 0; i < 3; ++i) k = mixed(k ^ static_cast<std::uint64_t>(std::llround(at[i])));
      return k;
    };
    for (std::size_t i = 0; i < guesses_.size(); ++i) {
      auto [crowd, fresh] = crowds.try_emplace(key(guesses_[i]), Crowd{0, i});
      crowd->second.weight += guesses_[i].weight;
    }
    std::vector<Crowd> ranked;
    for (const auto& [k, crowd] : crowds) ranked.push_back(crowd);
    const auto best = std::min(ranked.size(), static_cast<std::size_t>(o_.most_tried));
    std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(best), ranked.end(),
                      [](const Crowd& a, const Crowd& b) {
                        return a.weight != b.weight ? a.weight > b.weight : a.first < b.first;
                      });
    std::vector<ConstellationFix> fixes;
    for (std::size_t i = 0; i < best; ++i)
      if (auto fix = fit(guesses_[ranked[i].first])) keep(fixes, std::move(*fix));
    std::ranges::stable_sort(fixes, {}, badness);
    if (fixes.size() > kKept) fixes.resize(kKept);
    return fixes;
  }

  static double badness(const ConstellationFix& f) { return f.log_false_alarms + f.squares / 2; }

  // The same pose found twice counts once.
  void keep(std::vector<ConstellationFix>& fixes, ConstellationFix fix) const {
    for (ConstellationFix& other : fixes) {
      const Eigen::Vector3d apart =
          other.plane.place(other.on_plane.pose.at()) - fix.plane.place(fix.on_plane.pose.at());
      std::size_t shared = 0;
      for (std::size_t i = 0; i < fix.landmarks.size(); ++i)
        shared += fix.landmarks[i] && fix.landmarks[i] == other.landmarks[i];
      if (2 * shared < static_cast<std::size_t>(fix.matched) && apart.norm() > 3 * near_enough(fix, other))
        continue;
      if (2 * shared < static_cast<std::size_t>(fix.matched)) continue;
      if (badness(fix) < badness(other)) other = std::move(fix);
      return;
    }
    fixes.push_back(std::move(fix));
  }

  static double near_enough(const ConstellationFix& a, const ConstellationFix& b) {
    return std::sqrt(a.on_plane.covariance.diagonal().head<2>().sum() +
                     b.on_plane.covariance.diagonal().head<2>().sum());
  }

  struct Local {
    std::uint32_t landmark;
    Eigen::Vector2d at;
  };

  std::optional<ConstellationFix> fit(const Guess& g) const {
    // The plane touches where the middle of the sightings is thought to be: distances are true there.
    PlacedLandmark middle = index_.places_[g.anchor];
    const TangentPlane first = plane_at(middle);
    TangentPlane plane = first;
    Eigen::Vector2d offset = g.middle;
    std::vector<Local> locals;
    const double reach = 1.3 * extent_ + 3 * o_.sigmas * index_.typical_sd_ + 1e-9;
    index_.cells_.near(first.place(offset), reach, [&](std::uint32_t i, double) {
      locals.push_back({i, flattened(plane, index_.places_[i].at)});
    });
    if (locals.size() < 2) return {};
    std::ranges::sort(locals, {}, &Local::landmark);

    // From the pose of the middle to that of the robot.
    const Eigen::Vector2d robot = offset - turned(g.yaw) * middle_;
    PoseEstimate e{{robot.x(), robot.y(), wrapped(g.yaw)}, Eigen::Matrix3d::Zero()};
    double slack = 2;  // the guess is of three sightings only; tightened as all of them join
    Matches matches, last;
    for (int round = 0; round < 6; ++round) {
      matches = match(e.pose, locals, slack);
      if (round > 1 && matches == last) break;
      last = matches;
      if (!adjust(e, matches, locals)) return {};
      slack = std::max(1.0, slack * 0.7);
    }
    matches = match(e.pose, locals, 1);
    if (!adjust(e, matches, locals)) return {};
    return judged(e, plane, matches, locals);
  }

  Eigen::Matrix2d spread(const Seen& s, const Pose2& pose, std::uint32_t landmark) const {
    const Eigen::Matrix2d r = turned(pose.yaw);
    return r * s.covariance * r.transpose() + index_.landmarks_[landmark].covariance;
  }

  // One sighting per landmark, the nearest pairs first. Indices into `locals`.
  Matches match(const Pose2& pose, const std::vector<Local>& locals, double slack) const {
    struct Pair {
      double squares;
      std::size_t seen;
      std::uint32_t local;
    };
    std::vector<Pair> pairs;
    const double gate = o_.sigmas * o_.sigmas * slack * slack;
    const Eigen::Matrix2d r = turned(pose.yaw);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector2d at = pose.at() + r * points_[i].at;
      const Eigen::Matrix2d seen = r * points_[i].covariance * r.transpose();
      for (std::uint32_t k = 0; k < locals.size(); ++k) {
        const double dx = locals[k].at.x() - at.x(), dy = locals[k].at.y() - at.y(),
                     square = dx * dx + dy * dy;
        const Eigen::Matrix2d& mapped = index_.landmarks_[locals[k].landmark].covariance;
        const double a = seen(0, 0) + mapped(0, 0), d = seen(1, 1) + mapped(1, 1);
        if (square > gate * (a + d)) continue;
        const double b = seen(0, 1) + mapped(0, 1);
        const double squares = (d * dx * dx - 2 * b * dx * dy + a * dy * dy) / (a * d - b * b);
        if (squares <= gate && alike(points_[i], locals[k].landmark)) pairs.push_back({squares, i, k});
      }
    }
    std::ranges::stable_sort(pairs, {}, &Pair::squares);
    Matches matches(points_.size());
    std::vector<bool> taken(locals.size(), false);
    for (const Pair& p : pairs)
      if (!matches[p.seen] && !taken[p.local]) {
        matches[p.seen] = p.local;
        taken[p.local] = true;
      }
    return matches;
  }

  // Gauss-Newton step of the weighted least squares over all that matched.
  bool adjust(PoseEstimate& e, const Matches& matches, const std::vector<Local>& locals) const {
    for (int step = 0; step < 2; ++step) {
      Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
      Eigen::Vector3d pull = Eigen::Vector3d::Zero();
      const Eigen::Matrix2d r = turned(e.pose.yaw);
      int count = 0;
      for (std::size_t i = 0; i < matches.size(); ++i) {
        if (!matches[i]) continue;
        const Local& l = locals[*matches[i]];
        const Eigen::Vector2d seen = r * points_[i].at;
        Eigen::Matrix<double, 2, 3> j;
        j << 1, 0, -seen.y(), 0, 1, seen.x();
        const Eigen::Matrix2d weight = spread(points_[i], e.pose, l.landmark).inverse();
        information += j.transpose() * weight * j;
        pull += j.transpose() * weight * (l.at - e.pose.at() - seen);
        ++count;
      }
      if (count < 2) return false;
      const Eigen::LDLT<Eigen::Matrix3d> solver(information);
      if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
      const Eigen::Vector3d change = solver.solve(pull);
      if (!change.allFinite()) return false;
      e.pose = pose_of(e.pose.vector() + change);
      e.covariance = solver.solve(Eigen::Matrix3d::Identity());
    }
    return e.covariance.allFinite();
  }

  // How many poses of the whole map would match as much by chance.
  ConstellationFix judged(const PoseEstimate& e, const TangentPlane& plane, const Matches& matches,
                          const std::vector<Local>& locals) const {
    ConstellationFix fix{
        .plane = plane, .on_plane = e, .landmarks = {}, .matched = 0, .squares = 0, .log_false_alarms = 0};
    fix.landmarks.resize(total_);
    const double reach = 1.3 * extent_ + 1e-9;
    const double density = static_cast<double>(locals.size()) / (std::numbers::pi * reach * reach);
    std::vector<double> tail{1};  // tail[m]: probability of exactly m chance matches so far
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::uint32_t typical = matches[i] ? locals[*matches[i]].landmark : locals[0].landmark;
      const double area = std::numbers::pi * o_.sigmas * o_.sigmas *
                          std::sqrt(spread(points_[i], e.pose, typical).determinant());
      const double p = std::clamp(1 - std::exp(-density * area * points_[i].rarity), 1e-12, 1 - 1e-9);
      tail.push_back(0);
      for (std::size_t m = tail.size() - 1; m > 0; --m) tail[m] = tail[m] * (1 - p) + tail[m - 1] * p;
      tail[0] *= 1 - p;
      if (!matches[i]) continue;
      const Local& l = locals[*matches[i]];
      const Eigen::Vector2d d = l.at - e.pose.at() - turned(e.pose.yaw) * points_[i].at;
      fix.squares += d.dot(spread(points_[i], e.pose, l.landmark).inverse() * d);
      fix.landmarks[points_[i].index] = l.landmark;
      ++fix.matched;
    }
    double chance = 0;
    for (std::size_t m = tail.size(); m-- > static_cast<std::size_t>(fix.matched);) chance += tail[m];
    // Poses that can be told apart: the volume of all over the volume of one.
    const double one =
        std::pow(2 * std::numbers::pi, 1.5) * std::sqrt(std::max(e.covariance.determinant(), 1e-300));
    fix.log_false_alarms = std::log(std::max(chance, 1e-300)) +
                           std::log(std::max(1.0, index_.area_ * 2 * std::numbers::pi / one));
    return fix;
  }

  std::string_view verdict(const std::vector<ConstellationFix>& fixes, std::size_t named) const {
    if (fixes.empty()) return "no such constellation in the map";
    const ConstellationFix& best = fixes[0];
    if (named >= 2) {
      const double least = std::max(2.0, 0.6 * static_cast<double>(named));
      return best.matched >= least ? "" : "the names contradict the distances";
    }
    if (best.matched < o_.least_matches) return "too few sightings fit one place";
    if (2 * best.matched < static_cast<int>(points_.size()) && best.matched < 8)
      return "most sightings do not fit the best place";
    if (!(best.log_false_alarms < std::log(o_.false_alarms))) return "the best place may fit by chance";
    if (fixes.size() > 1 && !(badness(fixes[1]) - badness(best) > std::log(o_.lead)))
      return "two places fit alike";
    return "";
  }

  const ConstellationIndex& index_;
  const ConstellationOptions& o_;
  std::vector<Seen> points_;
  std::size_t total_ = 0;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  double extent_ = 0;
  std::vector<Hit> hits_;
  std::vector<Guess> guesses_;
};

ConstellationAnswer ConstellationIndex::find(const SightingSet& seen) const {
  return ConstellationSearch(*this, seen).find();
}

}  // namespace waymark
