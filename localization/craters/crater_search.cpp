// SPDX-License-Identifier: Apache-2.0
#include "localization/craters/crater_search.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <limits>
#include <numbers>
#include <set>

#include "localization/global/pose_finder.hpp"

namespace waymark::localization {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kAsLarge = 0.7;  // radius of a neighbour over that of the crater; the map's 0.8, with errors
constexpr double kDistortion = 0.01;  // relative error of sides by tilt, perspective and curvature
constexpr std::size_t kScored = 15;   // detections around a triangle that score it
constexpr double kHopeless = -3;      // score at which a position is given up
constexpr std::size_t kMinBatch = 4, kMaxBatch = 64, kTriedAtOnce = 4, kKept = 10;
constexpr std::size_t kMaxScored = 400000;  // positions; without a certain one the search then ends
constexpr double kSurelyRight = -25;        // ln of the chance positions of one that needs no further search
constexpr double kWorthAFit = 4;            // score from which a position is adjusted at once

}  // namespace

CraterSearch::CraterSearch(const CraterIndex& index, const CraterImage& image,
                           const CraterSearchOptions& options)
    : index_(index), image_(image), o_(options) {
  for (std::uint32_t i = 0; i < image.craters.size(); ++i)
    if (image.craters[i].at.allFinite() && image.craters[i].radius > 0 &&
        std::isfinite(image.craters[i].radius))
      used_.push_back(i);
  std::ranges::stable_sort(used_, std::greater<>{}, [&](std::uint32_t i) { return image.craters[i].radius; });
  if (used_.size() > static_cast<std::size_t>(o_.max_detections))
    used_.resize(static_cast<std::size_t>(o_.max_detections));
}

double CraterSearch::sd(std::size_t seen) const {
  return std::hypot(o_.position_sd, o_.position_error * image_.craters[seen].radius);
}

std::optional<CraterSearch::Triangle> CraterSearch::ordered(std::array<std::uint32_t, 3> c) const {
  const auto at = [&](std::size_t i) { return image_.craters[c[i]].at; };
  Triangle t{.corners = {}, .side = {}, .slack = {}, .weight = 0};
  std::array<double, 3> opposite;
  for (std::size_t i = 0; i < 3; ++i) opposite[i] = (at((i + 1) % 3) - at((i + 2) % 3)).norm();
  std::array<std::size_t, 3> order{0, 1, 2};
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return opposite[a] > opposite[b]; });
  for (std::size_t i = 0; i < 3; ++i) t.corners[i] = c[order[i]], t.side[i] = opposite[order[i]];
  const double longest = t.side[0];
  if (!(longest > 0)) return {};
  for (std::size_t i = 0; i < 3; ++i) {
    const double error = std::hypot(sd(t.corners[(i + 1) % 3]), sd(t.corners[(i + 2) % 3]));
    t.slack[i] = o_.sigmas * error + kDistortion * t.side[i];
  }
  // Too flat for a sign of its area, or too small for its errors.
  const Eigen::Vector2d ab = at(1) - at(0), ac = at(2) - at(0);
  const double height = std::abs(ab.x() * ac.y() - ab.y() * ac.x()) / longest;
  if (!(height > t.slack[0]) || !(t.slack[0] < 0.15 * longest)) return {};
  t.weight = t.slack[1] / longest * (t.slack[2] / longest);
  return t;
}

std::vector<CraterSearch::Triangle> CraterSearch::image_triangles() const {
  std::set<std::array<std::uint32_t, 3>> triples;
  std::vector<std::pair<double, std::uint32_t>> near;
  for (const std::uint32_t i : used_) {
    near.clear();
    for (const std::uint32_t j : used_)
      if (j != i && image_.craters[j].radius >= kAsLarge * image_.craters[i].radius)
        near.emplace_back((image_.craters[i].at - image_.craters[j].at).squaredNorm(), j);
    std::ranges::sort(near);
    const std::size_t count = std::min(near.size(), static_cast<std::size_t>(o_.neighbours));
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b) {
        std::array<std::uint32_t, 3> t{i, near[a].second, near[b].second};
        std::ranges::sort(t);
        triples.insert(t);
      }
  }
  std::vector<Triangle> all;
  for (const auto& t : triples)
    if (const auto triangle = ordered(t)) all.push_back(*triangle);
  // Precise triangles have the fewest positions.
  std::ranges::stable_sort(all, {}, &Triangle::weight);
  return all;
}

bool CraterSearch::is_possible_scale(double scale) const {
  return (o_.min_scale <= 0 || scale >= o_.min_scale) && (o_.max_scale <= 0 || scale <= o_.max_scale);
}

void CraterSearch::look_up(const Triangle& t, Proposals& into) const {
  // Sides of about equal length may be in another order in the map.
  std::array<std::size_t, 3> order{0, 1, 2};
  do {
    Triangle p = t;
    for (std::size_t i = 0; i < 3; ++i)
      p.corners[i] = t.corners[order[i]], p.side[i] = t.side[order[i]], p.slack[i] = t.slack[order[i]];
    if (p.side[0] + p.slack[0] < p.side[1] - p.slack[1] || p.side[1] + p.slack[1] < p.side[2] - p.slack[2])
      continue;
    const auto at = [&](std::size_t i) -> const Eigen::Vector2d& { return image_.craters[p.corners[i]].at; };
    const Eigen::Vector2d ab = at(1) - at(0), ac = at(2) - at(0);
    const bool left = ab.x() * ac.y() - ab.y() * ac.x() < 0;  // y is down
    const double longest = p.side[0];
    const auto ratio = [&](std::size_t i, double sign) {
      return (p.side[i] + sign * p.slack[i]) / (longest - sign * p.slack[0]);
    };
    std::array<int, 3> low, high;
    for (std::size_t i = 0; i < 3; ++i) {
      const double size = std::log(image_.craters[p.corners[i]].radius / longest);
      const double slack = o_.sigmas * o_.radius_error + p.slack[0] / longest;
      low[i] = crater_cells::size_cell(size - slack), high[i] = crater_cells::size_cell(size + slack);
    }
    const int last_middle = crater_cells::middle_cell(ratio(1, 1)),
              last_short = crater_cells::short_cell(ratio(2, 1));
    for (int m = crater_cells::middle_cell(ratio(1, -1)); m <= last_middle; ++m)
      for (int s = crater_cells::short_cell(ratio(2, -1)); s <= last_short; ++s)
        for (int a = low[0]; a <= high[0]; ++a)
          for (int b = low[1]; b <= high[1]; ++b) {
            // Cells of the last size are neighbours in memory.
            const std::size_t first = crater_cells::cell(left, m, s, {a, b, low[2]});
            const std::size_t end = first + static_cast<std::size_t>(high[2] - low[2]) + 1;
            for (std::uint32_t k = index_.first_[first]; k < index_.first_[end]; ++k)
              compare(p, index_.corners_[k], into);
          }
  } while (std::ranges::next_permutation(order).found);
}

void CraterSearch::compare(const Triangle& t, const CraterIndex::Corners& mapped, Proposals& into) const {
  std::array<double, 3> side;
  for (std::size_t i = 0; i < 3; ++i)
    side[i] = (index_.points_[mapped[(i + 1) % 3]] - index_.points_[mapped[(i + 2) % 3]]).norm();
  const double scale = (side[0] + side[1] + side[2]) / (t.side[0] + t.side[1] + t.side[2]);
  if (!is_possible_scale(scale)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sd =
        std::hypot(index_.craters_[mapped[(i + 1) % 3]].sd, index_.craters_[mapped[(i + 2) % 3]].sd);
    if (!(std::abs(side[i] - scale * t.side[i]) <= scale * t.slack[i] + o_.sigmas * sd)) return;
    const double size =
        std::log(index_.craters_[mapped[i]].radius / scale / image_.craters[t.corners[i]].radius);
    if (!(std::abs(size) <= o_.sigmas * o_.radius_error + kDistortion)) return;
  }
  CraterGuess guess{.anchor = mapped[0], .seen = t.corners, .mapped = mapped, .factor = {}, .shift = {}};
  const CraterPlane plane = plane_at(guess.anchor);
  std::array<std::complex<double>, 3> from, to;
  std::complex<double> from_middle, to_middle, product;
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = {image_.craters[t.corners[i]].at.x(), -image_.craters[t.corners[i]].at.y()};
    to[i] = plane.flat(index_.points_[mapped[i]]);
    from_middle += from[i] / 3.0, to_middle += to[i] / 3.0;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    product += std::conj(from[i] - from_middle) * (to[i] - to_middle);
    squares += std::norm(from[i] - from_middle);
  }
  guess.factor = product / squares;
  guess.shift = to_middle - guess.factor * from_middle;
  guess.score = score(guess, plane);
  ++into.scored;
  if (guess.score > 0) into.likely.push_back(guess);
}

CraterPlane CraterSearch::plane_at(std::uint32_t crater) const {
  const Eigen::Vector3d up = index_.surface_.up(index_.points_[crater]);
  const Eigen::Vector3d aside = std::abs(up.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d east = aside.cross(up).normalized();
  return {index_.points_[crater], east, up.cross(east)};
}

double CraterSearch::score(const CraterGuess& g, const CraterPlane& plane) const {
  const double scale = std::abs(g.factor);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double extent = 0, error = 0;
  for (const std::uint32_t i : g.seen) middle += image_.craters[i].at / 3;
  for (const std::uint32_t i : g.seen) {
    extent += (image_.craters[i].at - middle).squaredNorm() / 3;
    error += sd(i) * sd(i) / 3;
  }
  // The nearest detections: the triangle predicts them best.
  std::array<std::pair<double, std::uint32_t>, kScored> near;
  std::size_t count = 0;
  for (const std::uint32_t i : used_) {
    if (std::ranges::find(g.seen, i) != g.seen.end()) continue;
    std::pair<double, std::uint32_t> one{(image_.craters[i].at - middle).squaredNorm(), i};
    if (count == kScored && !(one < near[count - 1])) continue;
    std::size_t k = count < kScored ? count++ : kScored - 1;
    for (; k > 0 && one < near[k - 1]; --k) near[k] = near[k - 1];
    near[k] = one;
  }
  double sum = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const auto& [square, i] = near[n];
    const ImageCrater& seen = image_.craters[i];
    const double grown =
        error * (1.0 / 3 + square / (3 * extent)) + std::pow(kDistortion, 2) * square * square / (4 * extent);
    const double variance = scale * scale * (sd(i) * sd(i) + grown);
    const double reach = o_.sigmas * std::sqrt(variance);
    const Eigen::Vector3d at =
        index_.surface_.nearest(plane.point(g.factor * std::complex(seen.at.x(), -seen.at.y()) + g.shift));
    const double radius = scale * seen.radius, rare = index_.density(std::log(radius));
    double density = 0;
    index_.near(at, reach, radius * std::exp(-o_.sigmas * o_.radius_error), [&](std::uint32_t k, double d) {
      const double size = std::log(index_.craters_[k].radius / radius) / o_.radius_error;
      if (size * size > o_.sigmas * o_.sigmas) return;
      density = std::max(density, std::exp(-(d / variance + size * size) / 2));
    });
    density /= std::pow(2 * kPi, 1.5) * variance * o_.radius_error;
    sum += std::log(1 - o_.mapped + o_.mapped * density / rare);
    if (sum < kHopeless) break;
  }
  return sum;
}

std::optional<CraterFix> CraterSearch::fit(const CraterGuess& g) const {
  const CraterPlane plane = plane_at(g.anchor);
  const Eigen::Vector3d middle = index_.surface_.nearest(plane.point(g.shift));
  ImagePose pose = image_pose(index_.surface_, middle, std::abs(g.factor), 0);
  // The upward direction of the image on the body gives the turn.
  const std::complex<double> above = g.factor * std::complex<double>(0, 1) / std::abs(g.factor);
  const Eigen::Vector3d upward = above.real() * plane.east + above.imag() * plane.north;
  const double right = upward.dot(pose.axes.col(0)), forward = -upward.dot(pose.axes.col(1));
  ImagePose::Step turn = ImagePose::Step::Zero();
  turn[3] = std::atan2(right, forward);
  pose = pose.moved(turn, index_.surface_);
  return CraterFitter(index_, image_, o_, used_).fit(pose, g.seen, g.mapped);
}

void CraterSearch::keep(std::vector<CraterFix>& fixes, CraterFix fix) const {
  for (CraterFix& other : fixes) {
    const double sd = std::sqrt(fix.covariance.topLeftCorner<2, 2>().trace() +
                                other.covariance.topLeftCorner<2, 2>().trace());
    std::size_t shared = 0;
    for (std::size_t i = 0; i < fix.craters.size(); ++i)
      shared += fix.craters[i] && fix.craters[i] == other.craters[i];
    if ((fix.pose.ground - other.pose.ground).norm() > 4 * sd &&
        2 * shared < static_cast<std::size_t>(fix.matched))
      continue;
    if (fix.log_false_alarms < other.log_false_alarms) other = std::move(fix);
    return;
  }
  fixes.push_back(std::move(fix));
}

std::string_view CraterSearch::verdict(const CraterAnswer& answer) const {
  if (answer.candidates.empty()) return "no position has such craters";
  const CraterFix& best = answer.candidates[0];
  if (best.matched < o_.min_matches) return "too few craters fit one position";
  if (answer.wrong <= o_.max_wrong) return "";
  if (answer.candidates.size() > 1 && answer.candidates[1].log_false_alarms < 0)
    return "two positions fit alike";
  return "the best position may fit by chance";
}

CraterAnswer CraterSearch::find() const {
  CraterAnswer answer;
  answer.reason = index_.size() < 5 ? "the map has too few craters" : "too few craters in the image";
  if (index_.size() < 5 || used_.size() < static_cast<std::size_t>(o_.min_matches)) return answer;
  const std::vector<Triangle> triangles = image_triangles();
  std::vector<CraterGuess> best;
  std::vector<CraterFix>& fixes = answer.candidates;
  const auto by_score = [](const CraterGuess& a, const CraterGuess& b) {
    return a.score != b.score ? a.score > b.score : std::pair(a.seen, a.mapped) < std::pair(b.seen, b.mapped);
  };
  const auto try_best = [&](std::size_t count, double min_score) {
    std::size_t used = 0;
    while (used < std::min(count, best.size()) && best[used].score >= min_score) ++used;
    std::vector<std::optional<CraterFix>> some(used);
    tbb::parallel_for(std::size_t{0}, used, [&](std::size_t i) { some[i] = fit(best[i]); });
    for (auto& fix : some)
      if (fix) keep(fixes, std::move(*fix));
    best.erase(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(used));
  };
  const auto is_certain = [&] {
    return std::ranges::any_of(fixes, [](const CraterFix& f) { return f.log_false_alarms < kSurelyRight; });
  };
  std::size_t scored = 0;
  for (std::size_t first = 0, batch = kMinBatch;
       first < triangles.size() && !is_certain() && scored < kMaxScored;
       first += batch, batch = std::min(2 * batch, kMaxBatch)) {
    const std::size_t count = std::min(batch, triangles.size() - first);
    std::vector<Proposals> found(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { look_up(triangles[first + i], found[i]); });
    for (const Proposals& some : found) {
      scored += some.scored;
      best.insert(best.end(), some.likely.begin(), some.likely.end());
    }
    std::ranges::sort(best, by_score);
    const auto max_kept = static_cast<std::size_t>(o_.max_tried);
    if (best.size() > max_kept) best.resize(max_kept);
    try_best(kTriedAtOnce, kWorthAFit);
  }
  if (!is_certain()) try_best(best.size(), -std::numeric_limits<double>::infinity());
  std::ranges::stable_sort(fixes, {}, &CraterFix::log_false_alarms);
  if (fixes.size() > kKept) fixes.resize(kKept);
  std::vector<double> chances;
  for (const CraterFix& f : fixes) chances.push_back(f.log_false_alarms);
  answer.wrong = wrong_probability(chances);
  answer.reason = verdict(answer);
  if (answer.reason.empty()) answer.fix = fixes[0];
  return answer;
}

}  // namespace waymark::localization
