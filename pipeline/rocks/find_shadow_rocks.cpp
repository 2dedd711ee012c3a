// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/find_shadow_rocks.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "pipeline/rocks/position_bias.hpp"
#include "pipeline/rocks/rock_network.hpp"
#include "pipeline/rocks/spot_context.hpp"
#include "pipeline/vision/class_prior.hpp"
#include "pipeline/vision/half_image.hpp"
#include "pipeline/vision/real_fraction.hpp"
namespace waymark::pipeline {
namespace {

constexpr Radians kDefaultElevation = to_radians(Degrees{40});

// One scale detects rocks up to half a tile; a coarser scale takes over below that.
constexpr int kTile = 32;
constexpr double kMaxAtOneScale = 16, kMinAtCoarse = 5;  // pixels of the scale, diameter
constexpr double kSureAtOneScale = 8;  // the same: confidences of rocks are highest up to here
constexpr std::int64_t kMinTiles = 2;  // across an image that is halved once more

// Relief displacement across the light hides one side of the root of the shadow, so the rock is farther to
// that side than the visible centroid: by this fraction of the displacement of its top for a sun above 45
// degrees, less for longer shadows (regression on the training examples, docs/methods/rocks.md).
constexpr double kLateralShift = 0.35;

// Response of the logarithm of the predicted reach to terrain slope, relative to that of the shadow length:
// 0.3 measured (landings 303, 304, 401, 402 and 512); 0.3 to 0.5 give the same spread of heights
// (docs/methods/rocks.md).
constexpr double kReachSlopeResponse = 0.4;

// Same for widths: 0.2 to 0.36 there and on landings 901 to 906; 0.15 to 0.25 perform equally.
constexpr double kDiameterSlopeResponse = 0.2;

// Fraction of the shift towards the image's own prior of rocks that is applied to the confidences (chosen on
// landings 301 and 302, docs/methods/rocks.md).
constexpr double kPriorWeight = 0.6;

// Terrain without small rocks has as many dark spots as gravel, so the prior of rocks is estimated from the
// image. Each scale has its own: texture of the ground is most of the small spots and says nothing about
// boulders.
void adapt_to_prior(std::span<ScoredRock> of_scale) {
  std::vector<double> log_odds;
  for (const ScoredRock& one : of_scale) {
    const double p = std::clamp(one.confidence, 1e-9, 1 - 1e-9);
    log_odds.push_back(std::log(p / (1 - p)));
  }
  const double shift =
      kPriorWeight * prior_shift(log_odds, static_cast<double>(built_in_rock_network().rock_prior));
  for (std::size_t i = 0; i < of_scale.size(); ++i)
    of_scale[i].confidence = 1 / (1 + std::exp(-(log_odds[i] + shift)));
}

LightCoherence light_coherence(const std::vector<ScoredRock>& all, const LightFrame& light) {
  LightCoherence seen;
  for (const ScoredRock& one : all) {
    if (!(one.confidence > 0.5) || !(one.bright.weight > 0)) continue;
    const double x = std::cos(one.bright.angle), y = std::sin(one.bright.angle);
    ++seen.rocks;
    seen.along += std::abs(light.along(x, y)) > std::abs(light.across(x, y));
  }
  return seen;
}

void lower_confidences(std::vector<ScoredRock>& all, double fraction) {
  std::vector<double> confidences;
  for (const ScoredRock& one : all) confidences.push_back(one.confidence);
  lower_to_fraction(confidences, fraction);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].confidence = confidences[i];
}

Detection detection_of(const ScoredRock& judged, const RockSearch& search, const LightFrame& light) {
  const RockCandidate& rock = judged.rock;
  const RockPrediction& say = judged.prediction;
  const double scale = judged.scale, unit = position_unit(rock.size.radius);
  // The centre of a coarse pixel lies between the fine ones that it covers.
  const auto place = [&](double c) { return scale * (c + 0.5) - 0.5; };
  Detection found;
  found.type = search.type;
  const double diameter = 2 * scale * judged.radius();
  const Eigen::Vector2d foot = judged.position();
  double along = unit * say.along;
  if (search.sun_elevation) {
    const double tan_elevation = std::tan(search.sun_elevation->value);
    along -= position_bias({.radius = judged.radius(),
                            .height = rock.size.reach * std::exp(say.log_reach) * tan_elevation,
                            .tan_elevation = tan_elevation,
                            .displacement = judged.displacement_along});
  }
  found.outline = {.x = place(foot.x() + along * light.ux),
                   .y = place(foot.y() + along * light.uy),
                   .major = diameter,
                   .minor = diameter,
                   .angle = 0};
  const double along_sd = scale * unit * say.along_sd, across_sd = scale * unit * say.across_sd;
  Eigen::Matrix2d turn;
  turn << light.ux, -light.uy, light.uy, light.ux;
  found.covariance =
      turn * Eigen::Vector2d{along_sd * along_sd, across_sd * across_sd}.asDiagonal() * turn.transpose();
  found.diameter_sd = diameter * say.log_radius_sd;
  const double reach = scale * rock.size.reach * std::exp(say.log_reach);
  found.shadow_reach = MeasuredValue{reach, reach * say.log_reach_sd};
  found.reach_slope_response = kReachSlopeResponse;
  found.diameter_slope_response = kDiameterSlopeResponse;
  found.confidence = judged.confidence;
  return found;
}

// Returns whether `other` lies on a rock or its shadow.
bool covers(const Detection& rock, const Detection& other, const LightFrame& light) {
  const double dx = other.outline.x - rock.outline.x, dy = other.outline.y - rock.outline.y;
  const double t = light.along(dx, dy), s = light.across(dx, dy), r = 0.5 * rock.outline.diameter();
  return std::abs(s) < r && t > -r && t < std::hypot(r, rock.shadow_reach->value);
}

// Removes rocks found at two scales and parts of large rocks found at a fine scale: keeps the finer
// measurement of rocks that fit both scales, else the coarser one.
std::vector<Detection> remove_duplicates(std::vector<Detection> all, const LightFrame& light) {
  std::stable_sort(all.begin(), all.end(), [](const Detection& a, const Detection& b) {
    return a.outline.diameter() > b.outline.diameter();
  });
  std::vector<char> dropped(all.size(), 0);
  std::vector<std::size_t> by_row(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) by_row[i] = i;
  std::sort(by_row.begin(), by_row.end(), [&](std::size_t a, std::size_t b) {
    return all[a].outline.y != all[b].outline.y ? all[a].outline.y < all[b].outline.y : a < b;
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Detection& large = all[i];
    if (dropped[i] || large.outline.diameter() < 2 * kMinAtCoarse) continue;
    const double far = large.outline.diameter() + large.shadow_reach->value;
    auto next = std::lower_bound(by_row.begin(), by_row.end(), large.outline.y - far,
                                 [&](std::size_t k, double y) { return all[k].outline.y < y; });
    for (; next != by_row.end() && all[*next].outline.y < large.outline.y + far; ++next) {
      const std::size_t j = *next;
      if (j == i || dropped[j] || all[j].outline.diameter() > large.outline.diameter()) continue;
      const double smaller = all[j].outline.diameter();
      if (!covers(large, all[j], light) && !covers(all[j], large, light)) continue;
      const bool same = smaller > 0.6 * large.outline.diameter();
      if (same ? smaller < kMaxAtOneScale * 0.75 : all[j].confidence > large.confidence + 0.2) {
        dropped[i] = 1;
        break;
      }
      dropped[j] = 1;
    }
  }
  std::vector<Detection> kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!dropped[i]) kept.push_back(all[i]);
  return kept;
}

}  // namespace

double ScoredRock::radius() const {
  return rock.size.radius * std::exp(prediction.log_radius);
}

Eigen::Vector2d ScoredRock::position() const {
  return {rock.x + lateral_shift.x(), rock.y + lateral_shift.y()};
}

std::vector<ScoredRock> score_shadows(const ShadowMap& map, const LightFrame& light, const RockTable& table,
                                      const std::optional<ReliefDisplacement>& displacement) {
  const float smooth_noise = 0.5F * map.noise;  // after filtering
  const SegmentLimits limits{.grow = std::max(0.04F, 2.5F * smooth_noise),
                             .seed = std::max(0.06F, 4.5F * smooth_noise),
                             .merge = 0.88F,
                             .max_cells = static_cast<std::size_t>(4 * map.tile * map.tile)};
  std::vector<ScoredRock> judged;
  for (const ShadowSegment& segment : find_segments(map, limits)) {
    RockCandidate rock;
    rock.shadow = measure_shadow(map, segment, light);
    rock.catchment_cells = segment.catchment_cells;
    if (!(rock.shadow.area > 0)) continue;
    ScoredRock one;
    one.noise = static_cast<double>(map.noise);
    one.texture = static_cast<double>(map.texture_at(rock.shadow.x, rock.shadow.y));
    rock.size = table.estimate_size(rock.shadow, one.noise, one.texture);
    rock.x = rock.shadow.x - light.ux * rock.size.offset;
    rock.y = rock.shadow.y - light.uy * rock.size.offset;
    rock.log_ratio_excess = std::log(rock.size.reach / rock.size.radius) - table.mean_log_ratio();
    one.rock = rock;
    if (displacement) {
      const Eigen::Vector2d top_shift = displacement->at(rock.x, rock.y);
      const double tan_elevation = std::exp(table.log_tan_elevation());
      one.displacement_along = light.along(top_shift.x(), top_shift.y());
      one.rock.visible = visible_shadow(top_shift, light, tan_elevation);
      const double height = std::min(rock.size.reach * tan_elevation, 2 * rock.size.radius);
      const double across = kLateralShift * std::min(1.0, tan_elevation * tan_elevation) * height *
                            light.across(top_shift.x(), top_shift.y());
      one.lateral_shift = {-light.uy * across, light.ux * across};
    }
    judged.push_back(one);
  }
  std::vector<DarkSpot> spots;
  for (const ScoredRock& one : judged)
    spots.push_back({one.rock.shadow.x, one.rock.shadow.y, one.rock.shadow.peak});
  const auto contexts = spot_contexts(spots, map.alpha.columns(), map.alpha.rows());
  const RockNetwork& network = built_in_rock_network();
  for (std::size_t i = 0; i < judged.size(); ++i) {
    judged[i].evidence = gather_evidence(map, judged[i].rock, light, contexts[i], table);
    judged[i].prediction = predict_rock(network, judged[i].evidence);
    judged[i].confidence = judged[i].prediction.confidence;
    const ShadowShape& shadow = judged[i].rock.shadow;
    constexpr double kPossible = 0.1;
    if (judged[i].confidence > kPossible)
      judged[i].bright = bright_side(map, {shadow.x, shadow.y, shadow.area, shadow.peak});
  }
  return judged;
}

ScoredImage score_scales(const Pixels& image, const RockSearch& search, Radians sun_angle) {
  const LightFrame light = LightFrame::of(sun_angle);
  const Radians elevation = search.sun_elevation.value_or(kDefaultElevation);
  ScoredImage scored;
  std::vector<ScoredRock>& all = scored.spots;
  std::optional<float> umbra;
  std::optional<RockTable> table;
  Pixels coarse;
  double blur = search.blur > 0 ? search.blur : 0.6;
  for (double scale = 1;; scale *= 2) {
    if (scale > 1) {
      coarse = half_image(scale > 2 ? coarse : image);
      blur = std::max(0.25, blur / 2);  // coarser pixels are sharp: one table serves all of them
    }
    const Pixels& pixels = scale > 1 ? coarse : image;
    const auto map = map_shadows(pixels, kTile, umbra);
    if (!map) break;
    umbra = map->umbra;
    if (scale <= 1) scored.shaded = map->shaded;
    // The centre of a coarse pixel lies between the fine ones that it covers.
    std::optional<ReliefDisplacement> displacement = search.displacement;
    if (displacement)
      displacement = ReliefDisplacement{displacement->at(0.5 * (scale - 1), 0.5 * (scale - 1)),
                                        scale * displacement->per_pixel};
    if (scale <= 2) table = RockTable(elevation, search.sun_elevation.has_value(), blur);
    const std::size_t first = all.size();
    for (ScoredRock& one : score_shadows(*map, light, *table, displacement)) {
      const double diameter = 2 * one.rock.size.radius;
      one.scale = scale;
      if (scale == 1 || diameter > kMinAtCoarse) all.push_back(std::move(one));
    }
    adapt_to_prior(std::span(all).subspan(first));
    if (scale * kSureAtOneScale >= search.max_diameter ||
        std::min(pixels.columns(), pixels.rows()) < kMinTiles * kTile)
      break;
  }
  return scored;
}

RocksFound find_shadow_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle) {
  const LightFrame light = LightFrame::of(sun_angle);
  auto [scored, shaded] = score_scales(image, search, sun_angle);
  RocksFound found{
      .rocks = {}, .light = sun_angle, .coherence = light_coherence(scored, light), .shaded = shaded};
  lower_confidences(scored, found.coherence.real_fraction());
  for (const ScoredRock& judged : scored) {
    const double diameter = 2 * judged.scale * judged.radius();
    if (judged.confidence >= search.min_confidence && diameter >= search.min_diameter &&
        diameter <= search.max_diameter)
      found.rocks.push_back(detection_of(judged, search, light));
  }
  found.rocks = remove_duplicates(std::move(found.rocks), light);
  return found;
}

}  // namespace waymark::pipeline
