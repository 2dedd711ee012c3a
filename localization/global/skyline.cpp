// SPDX-License-Identifier: Apache-2.0
#include "localization/global/skyline.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "localization/global/skyline_fit.hpp"
#include "localization/global/skyline_index.hpp"
#include "localization/global/skyline_profile.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kKept = 10, kHeadings = 3;
constexpr std::size_t kBeam[] = {1500, 600, 250, 150};  // positions refined, by level

double badness(const SkylineFix& f) {
  return f.log_false_alarms;
}

bool usable(const HorizonTop& t) {
  return t.elevation && std::abs(*t.elevation) < 1.5 && std::isfinite(t.bearing) && t.bearing_sd > 0 &&
         t.elevation_sd > 0 && std::isfinite(t.bearing_sd + t.elevation_sd);
}

void keep_best(std::vector<HorizonGuess>& guesses, std::size_t max_count) {
  std::ranges::stable_sort(guesses, std::greater<>{}, &HorizonGuess::score);
  if (guesses.size() > max_count) guesses.resize(max_count);
}

}  // namespace

class SkylineSearch {
 public:
  SkylineSearch(std::span<const HorizonTop> tops, const SkylineIndex& index, const SkylineOptions& options)
      : tops_(tops), index_(index), o_(options) {}

  /// Searches by the whole horizon.
  SkylineSearch(const SeenHorizon& seen, const SkylineIndex& index, const SkylineOptions& options)
      : index_(index), o_(options), seen_(&seen) {}

  SkylineAnswer find() const {
    if (seen_) return find_by_profile();
    const auto usable = static_cast<double>(
        std::ranges::count_if(tops_, [](const HorizonTop& t) { return t.elevation.has_value(); }));
    if (index_.summits_.size() < 3)
      return {.fix = {}, .reason = "too few summits in the map", .candidates = {}};
    if (usable < (o_.heading ? 2 : 3))
      return {.fix = {}, .reason = "too few tops on the horizon", .candidates = {}};
    SkylineAnswer answer = look_at(best_headings(index_.viewpoints_, tops_, 1, o_));
    answer.reason = verdict(answer.candidates, usable);
    if (answer.reason.empty()) answer.fix = answer.candidates[0];
    return answer;
  }

 private:
  SkylineAnswer find_by_profile() const {
    if (index_.summits_.size() < 3)
      return {.fix = {}, .reason = "too few summits in the map", .candidates = {}};
    if (!seen_->is_usable())
      return {.fix = {}, .reason = "too little of the horizon is known", .candidates = {}};
    SkylineAnswer answer = look_at(headings(index_.viewpoints_, 1));
    answer.reason = profile_verdict(answer.candidates);
    if (answer.reason.empty()) answer.fix = answer.candidates[0];
    return answer;
  }

  std::vector<HorizonGuess> headings(std::span<const HorizonViewpoint> viewpoints,
                                     std::size_t max_count) const {
    return seen_ ? best_headings(viewpoints, *seen_, max_count, o_)
                 : best_headings(viewpoints, tops_, max_count, o_);
  }

  std::string_view profile_verdict(const std::vector<SkylineFix>& fixes) const {
    if (fixes.empty()) return "no position has such a horizon";
    if (fixes[0].matched < o_.min_fraction * fixes[0].compared)
      return "too little of the horizon fits one pose";
    if (!(fixes[0].log_false_alarms < std::log(o_.false_alarms))) return "the best pose may fit by chance";
    if (fixes.size() > 1 && !(badness(fixes[1]) - badness(fixes[0]) > std::log(o_.lead)))
      return "two poses fit alike";
    return "";
  }

  SkylineAnswer look_at(std::vector<HorizonGuess> guesses) const {
    double step = index_.options_.step;
    for (std::size_t level = 0; step > 2.5 * index_.terrain_.cell(); ++level) {
      keep_best(guesses,
                std::min(kBeam[std::min(level, std::size(kBeam) - 1)], index_.viewpoints_.size() / 4 + 1));
      guesses = refine(guesses, step);
      step /= 2;
    }
    // The whole horizon ranks positions better than its tops do.
    keep_best(guesses, static_cast<std::size_t>(seen_ ? o_.max_tried / 2 : o_.max_tried));
    std::vector<std::optional<SkylineFix>> fits(guesses.size());
    const SkylineScene scene{index_.terrain_, index_.summits_, o_};
    tbb::parallel_for(std::size_t{0}, guesses.size(), [&](std::size_t i) {
      fits[i] = seen_ ? fit_profile(scene, *seen_, guesses[i], step / 2)
                      : fit_horizon(scene, tops_, guesses[i], step / 2);
    });
    std::erase_if(fits, [](const auto& fix) { return !fix; });
    std::ranges::stable_sort(fits, {}, [](const auto& fix) { return badness(*fix); });
    SkylineAnswer answer{.fix = {}, .reason = {}, .candidates = {}};
    for (auto& fix : fits)
      if (answer.candidates.size() < kKept && is_new(answer.candidates, *fix))
        answer.candidates.push_back(std::move(*fix));
    return answer;
  }

  /// Returns four positions at half the step for each guess.
  std::vector<HorizonGuess> refine(std::span<const HorizonGuess> guesses, double step) const {
    std::vector<Eigen::Vector2d> at;
    for (const HorizonGuess& g : guesses)
      for (const auto& [dx, dy] : {std::pair{-1, -1}, {-1, 1}, {1, -1}, {1, 1}})
        at.push_back(g.at + step / 4 * Eigen::Vector2d(dx, dy));
    const std::size_t count = step / 2 > 2.5 * index_.terrain_.cell() ? 1 : kHeadings;
    return headings(compute_horizons(index_.terrain_, at, step / 2, o_), count);
  }

  /// Returns whether a fix is at another position than all of these.
  bool is_new(std::span<const SkylineFix> fixes, const SkylineFix& fix) const {
    return std::ranges::none_of(fixes, [&](const SkylineFix& other) {
      return (other.at.pose.at() - fix.at.pose.at()).norm() < index_.options_.step / 2;
    });
  }

  std::string_view verdict(const std::vector<SkylineFix>& fixes, double usable) const {
    if (fixes.empty()) return "no position has such a horizon";
    const SkylineFix& best = fixes[0];
    const auto min_matched = o_.heading ? std::min<std::int64_t>(o_.min_matches, 3) : o_.min_matches;
    if (best.matched < min_matched || best.matched < o_.min_fraction * usable)
      return "too few tops fit one pose";
    if (!(best.squares < o_.max_squares * best.matched)) return "the best pose fits badly";
    if (!(best.log_false_alarms < std::log(o_.false_alarms))) return "the best pose may fit by chance";
    if (fixes.size() > 1 && !(badness(fixes[1]) - badness(best) > std::log(o_.lead)))
      return "two poses fit alike";
    return "";
  }

  std::span<const HorizonTop> tops_;
  const SkylineIndex& index_;
  const SkylineOptions& o_;
  const SeenHorizon* seen_ = nullptr;  // null: by tops
};

void SkylineOptions::describe(OptionVisitor& option) {
  option("refraction", refraction,
         {.help = "Skyline: fraction of the curvature that air compensates; 0 means 0.13 on Earth",
          .min = 0,
          .max = 0.9});
  option("eye", eye,
         {.help = "Skyline: height of the camera above the ground, metres", .min = 0, .max = 1000});
  option("skyline_reach", reach,
         {.help = "Skyline: distance of the farthest summit, metres", .min = 100, .max = 1e6});
  option("skyline_step", step,
         {.help = "Skyline: metres between the positions of the coarse grid", .min = 1, .max = 1e5});
  option("summit_height_sd", height_sd,
         {.help = "Skyline: error of the heights of summits and terrain, metres", .min = 0.1, .max = 1000});
  option("summit_position_sd", position_sd,
         {.help = "Skyline: error of the positions of summits, metres",
          .min = 0.1,
          .max = 1e4,
          .formerly = "summit_place_sd"});
}

SkylineAnswer SkylineIndex::find(std::span<const HorizonTop> tops, std::optional<double> heading) const {
  SkylineOptions options = options_;
  if (heading) options.heading = heading;
  std::vector<HorizonTop> sound(tops.begin(), tops.end());
  for (HorizonTop& t : sound)
    if (!usable(t)) t = {.bearing = 0, .elevation = {}};
  return SkylineSearch(sound, *this, options).find();
}

SkylineAnswer SkylineIndex::find(const HorizonProfile& horizon, std::optional<double> heading) const {
  SkylineOptions options = options_;
  if (heading) options.heading = heading;
  const SeenHorizon seen(horizon);
  return SkylineSearch(seen, *this, options).find();
}

SkylineAnswer find_by_skyline(std::span<const HorizonTop> tops, std::span<const SkylineSummit> summits,
                              const TerrainHeight& ground, const SkylineOptions& options) {
  return SkylineIndex({summits.begin(), summits.end()}, ground, options).find(tops);
}

}  // namespace waymark::localization
