// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/find_shadow_rocks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/rocks/rock_network.hpp"
#include "pipeline/rocks/spot_context.hpp"
#include "pipeline/vision/class_share.hpp"
namespace waymark {
namespace {

constexpr Radians kUsualElevation = to_radians(Degrees{40});

// One scale sees rocks up to half a tile well; a coarser scale takes over before that.
constexpr int kTile = 32;
constexpr double kLargestAtOneScale = 16, kSmallestAtCoarse = 5;  // pixels of the scale, diameter

// A rock that leans across the light hides one side of its shadow's root: it stands further that way than the
// middle of what is seen, by this share of the way its top is moved where the sun stands above 45 degrees,
// and less the longer the shadow is (regression on the lessons, docs/rocks.md).
constexpr double kAside = 0.35;

// Logarithms of the reaches judged follow the ground's slope by 0.3 of what the shadow's length does
// (landings 303, 304, 401, 402 and 512; 0.3 to 0.5 spread heights alike, docs/rocks.md).
constexpr double kReachFollows = 0.4;

// The same of widths, which follow by 0.2 to 0.36 there and on landings 901 to 906; 0.15 to 0.25 do alike.
constexpr double kDiameterFollows = 0.2;

// Share of rocks among the dark spots the confidence was fitted on, and how far towards the image's own share
// the confidences are moved (chosen on landings 301 and 302, docs/rocks.md).
constexpr double kShareTrust = 0.6;

// Ground without small rocks has as many dark spots as gravel: how many of them are rocks is seen in the
// image.
void adapt_to_share(std::vector<JudgedRock>& all) {
  std::vector<double> log_odds;
  for (const JudgedRock& one : all) {
    const double p = std::clamp(one.confidence, 1e-9, 1 - 1e-9);
    log_odds.push_back(std::log(p / (1 - p)));
  }
  const double shift = kShareTrust * share_shift(log_odds, static_cast<double>(rock_network::kShareOfRocks));
  for (std::size_t i = 0; i < all.size(); ++i) all[i].confidence = 1 / (1 + std::exp(-(log_odds[i] + shift)));
}

Pixels halved(const Pixels& image) {
  Pixels half(image.columns() / 2, image.rows() / 2);
  for (std::int64_t y = 0; y < half.rows(); ++y)
    for (std::int64_t x = 0; x < half.columns(); ++x)
      half(x, y) = 0.25F * (image(2 * x, 2 * y) + image(2 * x + 1, 2 * y) + image(2 * x, 2 * y + 1) +
                            image(2 * x + 1, 2 * y + 1));
  return half;
}

Detection detection_of(const JudgedRock& judged, const RockSearch& search, const LightFrame& light) {
  const RockCandidate& rock = judged.rock;
  const RockJudgement& say = judged.judgement;
  const double scale = judged.scale, unit = place_unit(rock.size.radius);
  // The centre of a coarser pixel lies amid the finer ones it covers.
  const auto place = [&](double c) { return scale * (c + 0.5) - 0.5; };
  Detection found;
  found.type = search.type;
  const double diameter = 2 * scale * judged.radius();
  const Eigen::Vector2d foot = judged.place();
  found.outline = {.x = place(foot.x() + unit * say.along * light.ux),
                   .y = place(foot.y() + unit * say.along * light.uy),
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
  found.shadow_reach = Measured{reach, reach * say.log_reach_sd};
  found.reach_follows = kReachFollows;
  found.diameter_follows = kDiameterFollows;
  found.confidence = judged.confidence;
  return found;
}

// Whether `other` lies on a rock or its shadow.
bool covers(const Detection& rock, const Detection& other, const LightFrame& light) {
  const double dx = other.outline.x - rock.outline.x, dy = other.outline.y - rock.outline.y;
  const double t = light.along(dx, dy), s = light.across(dx, dy), r = 0.5 * rock.outline.diameter();
  return std::abs(s) < r && t > -r && t < std::hypot(r, rock.shadow_reach->value);
}

// The same rock at two scales, or a piece of a large one at a fine scale: the finer measurement of what both
// see whole, the coarser of all else.
std::vector<Detection> without_repeats(std::vector<Detection> all, const LightFrame& light) {
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
    if (dropped[i] || large.outline.diameter() < 2 * kSmallestAtCoarse) continue;
    const double far = large.outline.diameter() + large.shadow_reach->value;
    auto next = std::lower_bound(by_row.begin(), by_row.end(), large.outline.y - far,
                                 [&](std::size_t k, double y) { return all[k].outline.y < y; });
    for (; next != by_row.end() && all[*next].outline.y < large.outline.y + far; ++next) {
      const std::size_t j = *next;
      if (j == i || dropped[j] || all[j].outline.diameter() > large.outline.diameter()) continue;
      const double smaller = all[j].outline.diameter();
      if (!covers(large, all[j], light) && !covers(all[j], large, light)) continue;
      const bool same = smaller > 0.6 * large.outline.diameter();
      if (same ? smaller < kLargestAtOneScale * 0.75 : all[j].confidence > large.confidence + 0.2) {
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

double JudgedRock::radius() const {
  return rock.size.radius * std::exp(judgement.log_radius);
}

Eigen::Vector2d JudgedRock::place() const {
  return {rock.x + aside.x(), rock.y + aside.y()};
}

std::vector<JudgedRock> judge_shadows(const ShadowMap& map, const LightFrame& light, const RockTable& table,
                                      const std::optional<ImageLean>& lean) {
  const float smooth_noise = 0.5F * map.noise;  // under the mask
  const SegmentLimits limits{.grow = std::max(0.04F, 2.5F * smooth_noise),
                             .seed = std::max(0.06F, 4.5F * smooth_noise),
                             .merge = 0.88F,
                             .most_cells = static_cast<std::size_t>(4 * map.tile * map.tile)};
  std::vector<JudgedRock> judged;
  for (const ShadowSegment& segment : find_segments(map, limits)) {
    RockCandidate rock;
    rock.shadow = measure_shadow(map, segment, light);
    rock.segment_cells = segment.surroundings;
    if (!(rock.shadow.area > 0)) continue;
    JudgedRock one;
    one.noise = static_cast<double>(map.noise);
    one.texture = static_cast<double>(map.texture_at(rock.shadow.x, rock.shadow.y));
    rock.size = table.explain(rock.shadow, one.noise, one.texture);
    rock.x = rock.shadow.x - light.ux * rock.size.offset;
    rock.y = rock.shadow.y - light.uy * rock.size.offset;
    rock.log_ratio_excess = std::log(rock.size.reach / rock.size.radius) - table.usual_log_ratio();
    one.rock = rock;
    if (lean) {
      const Eigen::Vector2d leans = lean->at(rock.x, rock.y);
      const double tan_elevation = std::exp(table.log_tan_elevation());
      one.rock.seen = seen_shadow(leans, light, tan_elevation);
      const double height = std::min(rock.size.reach * tan_elevation, 2 * rock.size.radius);
      const double across =
          kAside * std::min(1.0, tan_elevation * tan_elevation) * height * light.across(leans.x(), leans.y());
      one.aside = {-light.uy * across, light.ux * across};
    }
    judged.push_back(one);
  }
  std::vector<DarkSpot> spots;
  for (const JudgedRock& one : judged)
    spots.push_back({one.rock.shadow.x, one.rock.shadow.y, one.rock.shadow.peak});
  const auto contexts = spot_contexts(spots, map.alpha.columns(), map.alpha.rows());
  for (std::size_t i = 0; i < judged.size(); ++i) {
    judged[i].evidence = gather_evidence(map, judged[i].rock, light, contexts[i], table);
    judged[i].judgement = judge_rock(judged[i].evidence);
    judged[i].confidence = judged[i].judgement.confidence;
  }
  return judged;
}

std::vector<JudgedRock> judge_scales(const Pixels& image, const RockSearch& search, Radians sun_angle) {
  const LightFrame light = LightFrame::of(sun_angle);
  const Radians elevation = search.sun_elevation.value_or(kUsualElevation);
  std::vector<JudgedRock> all;
  std::optional<float> umbra;
  std::optional<RockTable> table;
  Pixels coarse;
  double blur = search.blur > 0 ? search.blur : 0.6;
  for (double scale = 1;; scale *= 2) {
    if (scale > 1) {
      coarse = halved(scale > 2 ? coarse : image);
      blur = std::max(0.25, blur / 2);  // from there on pixels are sharp: one table serves all coarser scales
    }
    const Pixels& pixels = scale > 1 ? coarse : image;
    const auto map = map_shadows(pixels, kTile, umbra);
    if (!map) break;
    umbra = map->umbra;
    // A coarser pixel's centre lies amid the finer ones it covers.
    std::optional<ImageLean> lean = search.lean;
    if (lean) lean = ImageLean{lean->at(0.5 * (scale - 1), 0.5 * (scale - 1)), scale * lean->per_pixel};
    if (scale <= 2) table = RockTable(elevation, search.sun_elevation.has_value(), blur);
    for (JudgedRock& one : judge_shadows(*map, light, *table, lean)) {
      const double diameter = 2 * one.rock.size.radius;
      one.scale = scale;
      if (scale == 1 || diameter > kSmallestAtCoarse) all.push_back(std::move(one));
    }
    if (scale * kLargestAtOneScale >= search.max_diameter ||
        std::min(pixels.columns(), pixels.rows()) < 3 * kTile)
      break;
  }
  adapt_to_share(all);
  return all;
}

std::optional<Radians> direction_with_rocks(const Pixels& image, const RockSearch& search,
                                            std::optional<Radians> pooled) {
  constexpr std::int64_t kSide = 1000;
  const std::int64_t columns = std::min(kSide, image.columns()), rows = std::min(kSide, image.rows());
  const std::int64_t x0 = (image.columns() - columns) / 2, y0 = (image.rows() - rows) / 2;
  Pixels middle(columns, rows);
  for (std::int64_t y = 0; y < rows; ++y)
    for (std::int64_t x = 0; x < columns; ++x) middle(x, y) = image(x0 + x, y0 + y);
  const auto map = map_shadows(middle, kTile);
  if (!map) return std::nullopt;
  const RockTable table(search.sun_elevation.value_or(kUsualElevation), search.sun_elevation.has_value(),
                        search.blur > 0 ? search.blur : 0.6);
  const auto rocks_under = [&](double angle) {
    double sum = 0;
    for (const JudgedRock& one : judge_shadows(*map, LightFrame::of(Radians{angle}), table))
      if (one.confidence > 0.5) sum += one.confidence;
    return sum;
  };
  double best = 0, most = -1;
  const auto look = [&](double angle) {
    const double sum = rocks_under(angle);
    if (sum > most) {
      most = sum;
      best = angle;
    }
  };
  constexpr double kTurn = 6.283185307179586;
  for (int k = 0; k < 16; ++k) look(k * kTurn / 16);
  const double coarse = best;
  for (const double step : {-0.26, -0.13, 0.13, 0.26}) look(coarse + step);
  if (most < 2) return std::nullopt;
  if (pooled && rocks_under(pooled->value) > 0.5 * most) return pooled;
  if (pooled && rocks_under(pooled->value + kTurn / 2) > 0.5 * most)
    return Radians{std::remainder(pooled->value + kTurn / 2, kTurn)};
  return Radians{std::remainder(best, kTurn)};
}

std::vector<Detection> find_shadow_rocks(const Pixels& image, const RockSearch& search, Radians sun_angle) {
  const LightFrame light = LightFrame::of(sun_angle);
  std::vector<Detection> found;
  for (const JudgedRock& judged : judge_scales(image, search, sun_angle)) {
    const double diameter = 2 * judged.scale * judged.radius();
    if (judged.confidence >= search.min_confidence && diameter >= search.min_diameter &&
        diameter <= search.max_diameter)
      found.push_back(detection_of(judged, search, light));
  }
  return without_repeats(std::move(found), light);
}

}  // namespace waymark
