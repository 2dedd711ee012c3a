// SPDX-License-Identifier: Apache-2.0
#include "localization/registration/register_circles.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

namespace waymark::localization {
namespace {

constexpr std::size_t kLargest = 14;     // circles of the map whose pairs suggest places
constexpr std::size_t kKeptOfPair = 40;  // suggestions of one pair that are kept
constexpr std::size_t kAdjusted = 400;   // suggestions that are adjusted
constexpr double kSizes = 3;             // standard deviations of a ratio of diameters

struct Suggestion {
  PlaneSimilarity place = {};
  double score = 0;
};

bool better(const Suggestion& a, const Suggestion& b) {
  return std::tuple(-a.score, a.place.log_scale, a.place.yaw, a.place.shift.x(), a.place.shift.y()) <
         std::tuple(-b.score, b.place.log_scale, b.place.yaw, b.place.shift.x(), b.place.shift.y());
}

void keep_best(std::vector<Suggestion>& all, std::size_t count) {
  std::ranges::sort(all, better);
  if (all.size() > count) all.resize(count);
}

double size_sd(const Circle& a, const Circle& b) {
  return std::hypot(a.log_diameter_sd, b.log_diameter_sd);
}

std::vector<Suggestion> suggestions_of(const CircleEvidence& evidence, const Circle& a, const Circle& b,
                                       const CircleRules& rules) {
  std::vector<Suggestion> out;
  const Eigen::Vector2d base = b.at - a.at;
  if (!(base.norm() > 6 * std::hypot(a.position_sd, b.position_sd))) return out;
  const double max_log = std::log(rules.max_scale);
  for (const Circle& first : evidence.catalogue()) {
    const double ratio = std::log(first.diameter / a.diameter), slack = kSizes * size_sd(a, first);
    const double low = std::max(-max_log, ratio - slack), high = std::min(max_log, ratio + slack);
    if (!(low < high)) continue;
    evidence.cells().near(
        {first.at.x(), first.at.y(), 0}, base.norm() * std::exp(high), [&](std::uint32_t k, double square) {
          const Circle& second = evidence.catalogue()[k];
          PlaneSimilarity place{.log_scale = std::log(square) / 2 - std::log(base.norm())};
          if (!(place.log_scale >= low)) return;
          const double other = std::log(second.diameter / b.diameter) - place.log_scale;
          if (!(std::abs(other) < kSizes * size_sd(b, second))) return;
          const Eigen::Vector2d there = second.at - first.at;
          place.yaw = std::remainder(std::atan2(there.y(), there.x()) - std::atan2(base.y(), base.x()),
                                     2 * std::numbers::pi);
          place.shift = first.at - place.linear() * a.at;
          if (!((place * evidence.middle() - evidence.middle()).norm() <= rules.max_shift)) return;
          const Eigen::Vector2d between = (first.at + second.at) / 2;
          out.push_back({place, evidence.quick_score(place, between, there.norm(), kLargest)});
          if (out.size() > 50 * kKeptOfPair) keep_best(out, kKeptOfPair);
        });
  }
  keep_best(out, kKeptOfPair);
  return out;
}

std::vector<Suggestion> suggest(const CircleEvidence& evidence, const CircleRules& rules) {
  const std::size_t n = std::min(kLargest, evidence.map().size());
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) pairs.emplace_back(i, j);
  std::vector<std::vector<Suggestion>> of_pairs(pairs.size());
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t k) {
    of_pairs[k] =
        suggestions_of(evidence, evidence.map()[pairs[k].first], evidence.map()[pairs[k].second], rules);
  });
  std::vector<Suggestion> all;
  for (const auto& some : of_pairs) all.insert(all.end(), some.begin(), some.end());
  keep_best(all, kAdjusted);
  return all;
}

struct Candidate {
  CircleFit fit;
  double log_evidence = 0;
};

double log_evidence(const CircleEvidence& evidence, const CircleFit& fit, const CircleRules& rules) {
  const double area =
      std::min(evidence.catalogue_area(), std::numbers::pi * rules.max_shift * rules.max_shift);
  const double trials = area * 2 * std::numbers::pi * 2 * std::log(rules.max_scale);
  const double volume = std::pow(2 * std::numbers::pi, 2) * std::sqrt(fit.covariance.determinant());
  return evidence.log_ratio(fit.catalogue_from_map) + std::log(volume / trials);
}

bool same_place(const CircleEvidence& evidence, const PlaneSimilarity& a, const PlaneSimilarity& b) {
  const double shift = (a * evidence.middle() - b * evidence.middle()).norm();
  const double turn = (a.linear() - b.linear()).norm() * evidence.extent();
  return std::max(shift, turn) < 0.1 * evidence.extent() * std::exp(a.log_scale);
}

std::vector<Candidate> adjusted(const CircleEvidence& evidence, const CircleRules& rules) {
  std::vector<Candidate> all, out;
  for (const Suggestion& s : suggest(evidence, rules))
    if (const auto fit = evidence.fit(s.place);
        fit && std::abs(fit->catalogue_from_map.log_scale) <= std::log(rules.max_scale))
      all.push_back({*fit, log_evidence(evidence, *fit, rules)});
  std::ranges::stable_sort(all, std::ranges::greater{}, &Candidate::log_evidence);
  for (Candidate& c : all)
    if (std::ranges::none_of(out, [&](const Candidate& o) {
          return same_place(evidence, o.fit.catalogue_from_map, c.fit.catalogue_from_map);
        }))
      out.push_back(std::move(c));
  return out;
}

}  // namespace

CircleRegistration register_circles(std::span<const Circle> map, std::span<const Circle> catalogue,
                                    const CircleRules& rules) {
  if (map.size() < rules.min_matches || catalogue.size() < rules.min_matches)
    return {.message = fmt::format(
                "{} craters of the map and {} of the catalogue are too few: {} of each are needed",
                map.size(), catalogue.size(), rules.min_matches)};
  const CircleEvidence evidence(map, catalogue);
  const std::vector<Candidate> found = adjusted(evidence, rules);
  if (found.empty())
    return {.message = fmt::format("no place in the catalogue explains three of {} craters", map.size())};
  const double largest = std::max(0.0, found.front().log_evidence);
  double others = std::exp(-largest);  // a map that is not in the catalogue has evidence 1
  for (std::size_t i = 1; i < found.size(); ++i) others += std::exp(found[i].log_evidence - largest);
  const double best = std::exp(found.front().log_evidence - largest);
  CircleRegistration out{.wrong = others / (best + others)};
  const CircleFit& fit = found.front().fit;
  if (found.size() > 1 && out.wrong > rules.max_wrong && found[1].log_evidence > 0)
    out.message = fmt::format(
        "the place is ambiguous: two places explain {} and {} of {} craters; the better one is wrong with a "
        "probability of {:.2g}",
        fit.matched, found[1].fit.matched, map.size(), out.wrong);
  else if (out.wrong > rules.max_wrong || fit.matched < rules.min_matches)
    out.message = fmt::format(
        "no place is certain: the best one explains {} of {} craters and is wrong with a probability of "
        "{:.2g}; {} craters and {:.2g} are needed",
        fit.matched, map.size(), out.wrong, rules.min_matches, rules.max_wrong);
  else
    out.fit = fit;
  return out;
}

}  // namespace waymark::localization
