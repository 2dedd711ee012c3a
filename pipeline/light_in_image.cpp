// SPDX-License-Identifier: Apache-2.0
#include "pipeline/light_in_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/craters/find_craters.hpp"
#include "pipeline/rocks/rock_sun_angle.hpp"
#include "pipeline/vision/middle_of.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kManyCraters = 40;   // boulders of one image are fewer
constexpr int kSomeCraters = 10;   // fewer are no evidence against the shadows of rocks
constexpr double kClearLead = 3;   // objects by which one direction has to lead
constexpr double kMinCrater = 16;  // pixels

// Smallest crater, and the rock that looks like it under the opposite sun: with its shadow it is about twice
// as long as wide.
constexpr double kFineCrater = 8, kFineRock = 4;  // pixels

double count_craters(const Pixels& image, Radians sun_angle, double min_diameter = kMinCrater) {
  double sum = 0;
  for (const Detection& crater : find_craters(image, {.sun_angle = sun_angle,
                                                     .min_diameter = min_diameter,
                                                     .min_confidence = 0.3,
                                                     .second_opinion = false}))
    sum += crater.confidence;
  return sum;
}

// Returns whether the bowls lit from `angle` are boulders lit from the opposite side. A fresh crater and a
// boulder are each other's image under the opposite sun; worn craters are craters under the true one only, so
// the direction that explains more objects is taken.
bool are_boulders(const Pixels& image, Radians angle) {
  const Radians opposite{angle.value + std::numbers::pi};
  const double boulders = count_boulders(image, opposite) - count_boulders(image, angle);
  return boulders >= kClearLead &&
         boulders + count_craters(image, opposite) - count_craters(image, angle) >= kClearLead;
}

bool are_opposite(Radians a, Radians b) {
  return std::abs(std::remainder(a.value - b.value, 2 * std::numbers::pi)) > std::numbers::pi / 2;
}

// Returns whether rocks lit from `by_rocks` are more than craters lit from the opposite `by_craters`. Each
// counts beyond what the other direction shows of it.
bool rocks_explain_more(const Pixels& image, Radians by_rocks, Radians by_craters) {
  const double rocks = count_rocks(image, by_rocks, kFineRock) - count_rocks(image, by_craters, kFineRock);
  const double craters =
      count_craters(image, by_craters, kFineCrater) - count_craters(image, by_rocks, kFineCrater);
  return rocks > craters;
}

constexpr std::int64_t kLitSide = 1024;  // of the middle of an image that is searched: a second of work

// Returns the direction by craters of the middle of an image if it is sure; boulders turn it.
std::optional<SunAngle> sure_sun_angle(const Pixels& middle, const std::optional<CraterSunAngle>& seen) {
  constexpr double kSystematic = 0.035;  // radians, found on 14 synthetic scenes
  if (!seen || !seen->sure) return std::nullopt;
  const double of_mean = seen->sd.value / std::sqrt(std::max(1, seen->craters));
  const bool turned = seen->craters < kManyCraters && are_boulders(middle, seen->angle);
  return SunAngle{{std::remainder(seen->angle.value + (turned ? std::numbers::pi : 0), 2 * std::numbers::pi)},
                  {std::hypot(of_mean, kSystematic)},
                  seen->craters};
}

}  // namespace

std::optional<SunAngle> crater_sun_angle(const Pixels& image) {
  const Pixels middle = middle_of(image, kLitSide);
  return sure_sun_angle(middle, estimate_crater_sun_angle(middle));
}

std::optional<Radians> sun_angle_of_ground(const Pixels& image) {
  const auto craters = crater_sun_angle(image);
  if (const auto seen = estimate_rock_sun_angle(image, craters)) return seen->angle;
  return craters ? std::optional(craters->angle) : std::nullopt;
}

std::optional<SunAngle> sun_angle_for_craters(const Pixels& image) {
  const auto seen = estimate_crater_sun_angle(image);
  if (!seen) return std::nullopt;
  const SunAngle craters{seen->angle, seen->sd, seen->craters};
  if (seen->sure && seen->craters >= kManyCraters) return craters;
  const Pixels middle = middle_of(image, kLitSide);
  const bool is_whole = middle.columns() == image.columns() && middle.rows() == image.rows();
  const auto rocks = estimate_rock_sun_angle(
      middle, sure_sun_angle(middle, is_whole ? seen : estimate_crater_sun_angle(middle)));
  if (!rocks || !are_opposite(rocks->angle, craters.angle) ||
      !rocks_explain_more(middle, rocks->angle, craters.angle))
    return craters;
  return SunAngle{rocks->angle, rocks->sd, craters.shadows};
}

std::optional<SunAngle> sun_angle_for_rocks(const Pixels& image) {
  const Pixels middle = middle_of(image, kLitSide);
  const auto seen = estimate_crater_sun_angle(middle);
  const auto rocks = estimate_rock_sun_angle(image, sure_sun_angle(middle, seen));
  if (!rocks) return std::nullopt;
  if (!seen || seen->craters < kSomeCraters || !are_opposite(rocks->angle, seen->angle) ||
      rocks_explain_more(middle, rocks->angle, seen->angle))
    return rocks;
  return SunAngle{seen->angle, seen->sd, seen->craters};
}

std::string unusual_ground_warning(const LightCoherence& seen) {
  return fmt::format(
      "{:.0f} % of {} supposed rocks have their bright side along the light (50 % by chance, 62 % or more "
      "among "
      "rocks), as on leaves, roofs and ripples or under a wrong sun: their confidences are lowered so that "
      "at "
      "most {:.0f} % count as real",
      100 * seen.fraction(), seen.rocks, 100 * seen.real_fraction());
}

std::string shaded_ground_warning(const ShadedGround& seen) {
  return fmt::format(
      "{:.0f} % of the pixels lie in shadow: rocks there cast none and are not found, those beside it are "
      "found less often; a higher sun would show them",
      100 * seen.fraction());
}

}  // namespace waymark::pipeline
