// SPDX-License-Identifier: Apache-2.0
#include "localization/global/skyline.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>

#include "localization/global/skyline_index.hpp"
#include "localization/global/skyline_view.hpp"

namespace waymark {
namespace {

constexpr int kBins = 180;  // of the heading
constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kKept = 10;

/// How likely a summit stands on the horizon of someone that far away.
double likely(const SkylineSummit& summit, double distance) {
  return std::clamp(std::max(summit.isolation / distance, summit.prominence / (0.02 * distance)), 0.1, 1.0);
}

struct Guess {
  double score = 0;
  Pose2 pose;
};

}  // namespace

class SkylineSearch {
 public:
  SkylineSearch(std::span<const HorizonTop> tops, const SkylineIndex& index, const SkylineOptions& options)
      : tops_(tops),
        index_(index),
        summits_(index.summits_),
        ground_(index.ground_),
        o_(options),
        bounds_(index.bounds_) {}

  SkylineAnswer find() {
    const int needed = o_.heading ? 2 : 3;
    if (summits_.size() < 3) return {.fix = {}, .reason = "the map has too few summits", .candidates = {}};
    if (static_cast<int>(tops_.size()) < needed)
      return {.fix = {}, .reason = "too few tops on the horizon", .candidates = {}};
    const std::vector<Guess> guesses = vote();
    if (guesses.empty()) return {.fix = {}, .reason = "no place has such a horizon", .candidates = {}};
    SkylineAnswer answer{.fix = {}, .reason = {}, .candidates = {}};
    for (const Guess& guess : guesses)
      if (auto fix = fit(guess)) keep(answer.candidates, std::move(*fix));
    std::ranges::stable_sort(answer.candidates, {}, badness);
    if (answer.candidates.size() > kKept) answer.candidates.resize(kKept);
    answer.reason = verdict(answer.candidates);
    if (answer.reason.empty()) answer.fix = answer.candidates[0];
    return answer;
  }

 private:
  static double badness(const SkylineFix& f) { return f.log_false_alarms + f.squares / 2; }

  // The best heading of each place of the grid, then the best places.
  std::vector<Guess> vote() const {
    std::vector<Guess> all;
    for (const SkylineIndex::Place& place : index_.places_)
      if (const Guess g = vote_at(place); g.score > 0) all.push_back(g);
    const auto most = std::min(all.size(), static_cast<std::size_t>(o_.most_tried));
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(most), all.end(),
                      [](const Guess& a, const Guess& b) {
                        return a.score != b.score ? a.score > b.score
                                                  : a.pose.vector().x() < b.pose.vector().x();
                      });
    all.resize(most);
    return all;
  }

  Guess vote_at(const SkylineIndex::Place& place) const {
    const Eigen::Vector2d& at = place.at;
    // The robot may be half a step away, and as much higher or lower as the ground is there.
    const double slack = o_.step / 2;
    const double tall = (place.highest - place.lowest) / 2 + o_.height_sd * o_.sigmas;
    std::vector<float> sum(kBins, 0), one(kBins);
    std::vector<std::pair<SummitView, double>> seen;
    for (const std::uint32_t i : place.summits) {
      const SummitView v = view_of(summits_[i], at, (place.lowest + place.highest) / 2 + o_.eye, o_);
      seen.emplace_back(v, likely(summits_[i], v.distance));
    }
    for (const HorizonTop& top : tops_) {
      std::ranges::fill(one, 0.0F);
      for (const auto& [v, weight] : seen) {
        if (top.elevation) {
          const double near = tall / v.distance + slack * std::abs(v.elevation) / v.distance;
          if (std::abs(*top.elevation - v.elevation) > o_.sigmas * top.elevation_sd + near) continue;
        }
        const double half = std::min(o_.sigmas * top.bearing_sd + slack / v.distance, 0.5);
        const double yaw = v.azimuth - top.bearing;
        // A wide gate says less.
        const auto worth = static_cast<float>(weight * std::min(1.0, 0.05 / half));
        const int first = static_cast<int>(std::floor((yaw - half) / kTurn * kBins));
        const int last = static_cast<int>(std::floor((yaw + half) / kTurn * kBins));
        for (int b = first; b <= last; ++b) {
          float& bin = one[static_cast<std::size_t>(((b % kBins) + kBins) % kBins)];
          bin = std::max(bin, worth);
        }
      }
      for (std::size_t b = 0; b < kBins; ++b) sum[b] += one[b];
    }
    if (o_.heading)
      for (std::size_t b = 0; b < kBins; ++b) {
        const double off = wrapped((static_cast<double>(b) + 0.5) / kBins * kTurn - *o_.heading);
        if (std::abs(off) > o_.sigmas * o_.heading_sd + kTurn / kBins) sum[b] = 0;
      }
    const auto best = std::ranges::max_element(sum);
    const double yaw = (static_cast<double>(best - sum.begin()) + 0.5) / kBins * kTurn;
    return {*best, {at.x(), at.y(), wrapped(yaw)}};
  }

  using Matches = std::vector<std::optional<std::uint32_t>>;

  // Nearest summit of each top inside a gate widened by `place` metres and `turn` radians.
  Matches match(const Pose2& pose, double place, double turn) const {
    Matches matches(tops_.size());
    const auto height = ground_(pose.at());
    if (!height) return matches;
    std::vector<double> least(tops_.size(), o_.sigmas * o_.sigmas);
    for (std::uint32_t j = 0; j < summits_.size(); ++j) {
      const SummitView v = view_of(summits_[j], pose.at(), *height + o_.eye, o_);
      if (v.distance > o_.reach) continue;
      for (std::size_t i = 0; i < tops_.size(); ++i) {
        const double across = (o_.place_sd + place) / v.distance;
        const double db = wrapped(tops_[i].bearing - v.azimuth + pose.yaw);
        const double vb = tops_[i].bearing_sd * tops_[i].bearing_sd + across * across + turn * turn;
        double squares = db * db / vb;
        if (tops_[i].elevation) {
          const double up = (o_.height_sd + 0.3 * place) / v.distance;
          const double de = *tops_[i].elevation - v.elevation;
          squares += de * de / (tops_[i].elevation_sd * tops_[i].elevation_sd + up * up);
        }
        if (squares < least[i]) {
          least[i] = squares;
          matches[i] = j;
        }
      }
    }
    return matches;
  }

  std::optional<SkylineFix> fit(const Guess& guess) const {
    PoseEstimate e{guess.pose, Eigen::Matrix3d::Identity()};
    double place = o_.step / 2, turn = kTurn / kBins / 2;
    Matches matches;
    for (int round = 0; round < 7; ++round) {
      matches = match(e.pose, place, turn);
      const auto next = resection(tops_, summits_, matches, e, ground_, o_);
      if (!next || (next->pose.at() - guess.pose.at()).norm() > 4 * o_.step) return {};
      e = *next;
      place *= 0.4, turn *= 0.4;
    }
    return judged(e);
  }

  std::optional<SkylineFix> judged(PoseEstimate e) const {
    const auto height = ground_(e.pose.at());
    if (!height) return {};
    Matches matches = match(e.pose, 0, 0);
    const Eigen::Vector3d eye(e.pose.x, e.pose.y, *height + o_.eye);
    const auto visible = [&](const SkylineSummit& s) {
      const Eigen::Vector3d top(s.at.x(), s.at.y(), s.height + o_.height_sd);
      return clears_ground(eye, top, ground_, o_, std::max(30.0, o_.place_sd), 3 * o_.place_sd + 100);
    };
    for (auto& m : matches)
      if (m && !visible(summits_[*m])) m.reset();
    const auto refined = resection(tops_, summits_, matches, e, ground_, o_);
    if (!refined) return {};
    e = *refined;
    SkylineFix fix{.at = e, .summits = matches, .matched = 0, .squares = 0, .log_false_alarms = 0};
    // Views of all summits in reach: how many would fit by chance.
    std::vector<SummitView> views;
    double low = 1, high = -1;
    for (const SkylineSummit& s : summits_) {
      const SummitView v = view_of(s, e.pose.at(), eye.z(), o_);
      if (v.distance > o_.reach) continue;
      views.push_back(v);
    }
    for (const HorizonTop& t : tops_)
      if (t.elevation) low = std::min(low, *t.elevation), high = std::max(high, *t.elevation);
    const double band = std::max(high - low, 0.02);
    std::vector<double> tail{1};
    for (std::size_t i = 0; i < tops_.size(); ++i) {
      double expected = 0;
      for (const SummitView& v : views) {
        const double wide = o_.sigmas * std::hypot(tops_[i].bearing_sd, o_.place_sd / v.distance);
        double part = std::min(1.0, 2 * wide / kTurn);
        if (tops_[i].elevation) {
          if (v.elevation < low - 0.01 || v.elevation > high + 0.01) continue;
          part *= std::min(
              1.0, 2 * o_.sigmas * std::hypot(tops_[i].elevation_sd, o_.height_sd / v.distance) / band);
        }
        expected += part;
      }
      const double p = std::clamp(1 - std::exp(-expected), 1e-9, 1 - 1e-9);
      tail.push_back(0);
      for (std::size_t m = tail.size() - 1; m > 0; --m) tail[m] = tail[m] * (1 - p) + tail[m - 1] * p;
      tail[0] *= 1 - p;
      if (!matches[i]) continue;
      ++fix.matched;
      const SummitView v = view_of(summits_[*matches[i]], e.pose.at(), eye.z(), o_);
      const double db = wrapped(tops_[i].bearing - v.azimuth + e.pose.yaw), across = o_.place_sd / v.distance;
      fix.squares += db * db / (tops_[i].bearing_sd * tops_[i].bearing_sd + across * across);
    }
    double chance = 0;
    for (std::size_t m = tail.size(); m-- > static_cast<std::size_t>(fix.matched);) chance += tail[m];
    const double one = std::pow(kTurn, 1.5) * std::sqrt(std::max(e.covariance.determinant(), 1e-300));
    fix.log_false_alarms =
        std::log(std::max(chance, 1e-300)) + std::log(std::max(1.0, bounds_.volume() * kTurn / one));
    return fix;
  }

  void keep(std::vector<SkylineFix>& fixes, SkylineFix fix) const {
    for (SkylineFix& other : fixes)
      if ((other.at.pose.at() - fix.at.pose.at()).norm() < o_.step) {
        if (badness(fix) < badness(other)) other = std::move(fix);
        return;
      }
    fixes.push_back(std::move(fix));
  }

  std::string_view verdict(const std::vector<SkylineFix>& fixes) const {
    if (fixes.empty()) return "no place has such a horizon";
    const SkylineFix& best = fixes[0];
    if (best.matched < (o_.heading ? std::min<std::int64_t>(o_.least_matches, 3) : o_.least_matches))
      return "too few tops fit one place";
    if (!(best.log_false_alarms < std::log(o_.false_alarms))) return "the best place may fit by chance";
    if (fixes.size() > 1 && !(badness(fixes[1]) - badness(best) > std::log(o_.lead)))
      return "two places fit alike";
    return "";
  }

  std::span<const HorizonTop> tops_;
  const SkylineIndex& index_;
  std::span<const SkylineSummit> summits_;
  const GroundHeight& ground_;
  const SkylineOptions& o_;
  Eigen::AlignedBox2d bounds_;
};

void SkylineOptions::describe(OptionVisitor& option) {
  option("refraction", refraction,
         {.help = "Skyline: part of the curvature the air takes away; 0 is taken as 0.13 on Earth",
          .min = 0,
          .max = 0.9});
  option("eye", eye, {.help = "Skyline: metres of the camera above the ground", .min = 0, .max = 1000});
  option("skyline_reach", reach, {.help = "Skyline: metres to the farthest summit", .min = 100, .max = 1e6});
  option("skyline_step", step,
         {.help = "Skyline: metres between the places tried first", .min = 1, .max = 1e5});
  option("summit_height_sd", height_sd,
         {.help = "Skyline: error of the heights of summits and ground, metres", .min = 0.1, .max = 1000});
  option("summit_place_sd", place_sd,
         {.help = "Skyline: error of the places of summits, metres", .min = 0.1, .max = 1e4});
}

SkylineAnswer SkylineIndex::find(std::span<const HorizonTop> tops, std::optional<double> heading) const {
  SkylineOptions options = options_;
  if (heading) options.heading = heading;
  return SkylineSearch(tops, *this, options).find();
}

SkylineAnswer find_by_skyline(std::span<const HorizonTop> tops, std::span<const SkylineSummit> summits,
                              const GroundHeight& ground, const SkylineOptions& options) {
  return SkylineIndex({summits.begin(), summits.end()}, ground, options).find(tops);
}

}  // namespace waymark
