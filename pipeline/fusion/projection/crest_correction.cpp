// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/crest_correction.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/crater_degradation.hpp"
#include "pipeline/fusion/projection/rim_profile.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kStep = DiffusingCrater::kSpacing;
constexpr double kFar = 8;  // radii, where the solver ends
constexpr double kMaxBlur = 1.4, kBlurStep = 0.03;
constexpr double kShallowest = 0.02;

double sampled(const std::vector<float>& z, double r) {
  const double position = std::min(r / kStep, double(z.size()) - 1.001);
  const auto i = static_cast<std::size_t>(position);
  return std::lerp(double(z[i]), double(z[i + 1]), position - double(i));
}

DegradationProfiles::State measured(double blur, const std::vector<double>& z) {
  const auto inside = static_cast<std::ptrdiff_t>(0.5 / kStep);
  const auto crest = std::max_element(z.begin() + inside, z.end()) - z.begin();
  auto edge = inside;
  double max_bend = 0;
  for (auto i = inside; i <= crest; ++i) {
    const auto at = z.begin() + i;
    const double bend = 2 * at[0] - at[-1] - at[1];
    if (bend > max_bend) max_bend = bend, edge = i;
  }
  const double radius = double(crest) * kStep;
  return {(z[static_cast<std::size_t>(crest)] - z.front()) / radius, blur, radius,
          std::log(double(crest) / double(edge))};
}

using Profile = Eigen::Vector<double, kRimRings>;

constexpr double kMinCells = 3;
// Brightness is averaged over some width, so its edge appears slightly outside the sharpest bend (the crest
// of a fresh rim). Mean residual on landings 7, 303, 901 and 902 (docs/methods/craters.md).
constexpr double kEdgeOutside = 0.045;
constexpr double kCellBlur = 0.5;    // cells: mean over a cell, then bilinear (1/12 + 1/6 of a cell squared)
constexpr double kUnresolved = 0.1;  // prior probability that the DEM does not resolve the crater
constexpr double kLawSd = 0.06;      // scatter of ln(crest / outline) about the law; docs/methods/craters.md

// Weights by area.
Profile ring_weights() {
  Profile weights;
  for (int ring = 0; ring < kRimRings; ++ring) weights[ring] = rim_ring(ring) + 0.05;
  return weights / weights.sum();
}

Profile about_mean(const Profile& heights, const Profile& weights) {
  return heights.array() - weights.dot(heights);
}

Profile medians(RimHeights heights) {
  Profile median;
  for (int ring = 0; ring < kRimRings; ++ring) {
    Eigen::Vector<double, kRimAzimuths> row = heights.row(ring);
    std::nth_element(row.begin(), row.begin() + kRimAzimuths / 2, row.end());
    median[ring] = row[kRimAzimuths / 2];
  }
  return median;
}

// Returns the mean variance over the azimuths.
double unevenness(const RimHeights& heights, const Profile& weights) {
  double variance = 0;
  for (int ring = 0; ring < kRimRings; ++ring)
    variance += weights[ring] * (heights.row(ring).array() - heights.row(ring).mean()).square().mean();
  return variance;
}

// Depth between the highest point near the crest and the floor, in diameters of the worn crest.
double profile_depth(const DegradationProfiles& worn, const DegradationProfiles::State& state, double blur) {
  double crest = 0;
  for (const double r : {0.9, 0.94, 0.98, 1.02, 1.06, 1.1})
    crest = std::max(crest, worn.height(blur, r * state.crest));
  return (crest - worn.height(blur, 0.06 * state.crest)) / state.crest;
}

constexpr double kGoodMisfit = 0.5;  // expected of the profile that is right

// Offsets of the crest from the law, whose scatter they sample to three standard deviations.
constexpr int kOffsets = 13;
constexpr double kOffsetStep = 0.03;

double offset_at(int k) {
  return (k - kOffsets / 2) * kOffsetStep;
}

double offset_chance(double offset) {
  return std::exp(-offset * offset / (2 * kLawSd * kLawSd));
}

}  // namespace

DegradationProfiles::DegradationProfiles() {
  DiffusingCrater crater(kFar);
  const std::vector<double>& z = crater.heights();
  for (double blur = 0; blur < kMaxBlur; blur += kBlurStep) {
    crater.advance_to(blur * blur / 2);
    blurs_.push_back(std::sqrt(2 * crater.time()));
    heights_.emplace_back(z.begin(), z.end());
    if (const State state = measured(blurs_.back(), z); state.depth >= kShallowest) states_.push_back(state);
  }
}

const DegradationProfiles& DegradationProfiles::instance() {
  static const DegradationProfiles craters;
  return craters;
}

double DegradationProfiles::height(double blur, double r) const {
  const auto after = std::upper_bound(blurs_.begin() + 1, blurs_.end() - 1, blur);
  const auto i = static_cast<std::size_t>(after - blurs_.begin());
  const double part = std::clamp((blur - blurs_[i - 1]) / (blurs_[i] - blurs_[i - 1]), 0.0, 1.0);
  return std::lerp(sampled(heights_[i - 1], r), sampled(heights_[i], r), part);
}

double depth_growth(double shown, double cells) {
  if (!(shown > 0)) return 1;
  const DegradationProfiles& worn = DegradationProfiles::instance();
  double before = 0, growth_before = 1;  // of the next deeper state
  for (const auto& state : worn.states()) {
    const double cell = 2 * state.crest / std::max(cells, 1.0);  // radii of the fresh crater
    const double seen = profile_depth(worn, state, std::hypot(state.blur, kCellBlur * cell));
    const double growth = std::max(1.0, profile_depth(worn, state, state.blur) / seen);
    if (seen <= shown)
      return before > seen ? std::lerp(growth, growth_before, (shown - seen) / (before - seen)) : growth;
    before = seen, growth_before = growth;
  }
  return growth_before;
}

std::optional<CrestCorrection> crest_correction(const Terrain& terrain, const GroundOutline& outline,
                                                double outline_edge_fraction) {
  const double cell = std::max(terrain.step_x(), terrain.step_y()), cells = outline.diameter() / cell;
  if (!(cells >= kMinCells)) return std::nullopt;
  const auto heights = rim_heights(terrain, outline);
  if (!heights) return std::nullopt;
  static const Profile weights = ring_weights();
  const Profile seen = about_mean(medians(*heights), weights);
  // Neighbouring azimuths and rings are correlated, but the median over azimuths is less uneven than they are
  // (docs/evaluation/2026-11-28-crater-diameters-by-heights.md).
  const double independent = std::clamp(cells * cells / 1.5, 8.0, 120.0);
  const double variance = std::max(1e-6, unevenness(*heights, weights) / independent);

  const DegradationProfiles& worn = DegradationProfiles::instance();
  const auto misfit = [&](const Profile& made) {
    return (weights.array() * (seen - about_mean(made, weights)).array().square()).sum() / variance / 2;
  };
  std::vector<double> misfits{misfit(Profile::Zero())}, chances{kUnresolved}, growths{0};
  double depths = 0;  // sum of chances
  for (std::size_t i = 0; i < worn.states().size(); ++i) {
    const auto& state = worn.states()[i];
    const double next = i + 1 < worn.states().size() ? worn.states()[i + 1].depth : state.depth;
    const double chance = state.depth * std::max(state.depth - next, 0.0);
    const double law = outline_edge_fraction * std::max(0.0, state.crest_over_edge - kEdgeOutside);
    for (int k = 0; k < kOffsets; ++k) {
      const double growth = law + offset_at(k);
      const double fresh_radius = outline.diameter() / 2 * std::exp(growth) / state.crest;
      const double blur = std::hypot(state.blur, kCellBlur * cell / fresh_radius);
      Profile made;
      for (int ring = 0; ring < kRimRings; ++ring)
        made[ring] =
            2 * fresh_radius * worn.height(blur, rim_ring(ring) * outline.diameter() / 2 / fresh_radius);
      misfits.push_back(misfit(made));
      chances.push_back(chance * offset_chance(offset_at(k)));
      growths.push_back(growth);
      depths += chances.back();
    }
  }
  const double best = *std::min_element(misfits.begin(), misfits.end());
  // Heights that no profile fits, as of a pit without a rim, say less.
  const double spread = std::max(1.0, best / kGoodMisfit);
  double total = 0, mean = 0, squares = 0;
  for (std::size_t i = 0; i < misfits.size(); ++i) {
    const double fraction = (i == 0 ? kUnresolved : (1 - kUnresolved) * chances[i] / depths) *
                            std::exp((best - misfits[i]) / spread);
    total += fraction, mean += fraction * growths[i], squares += fraction * growths[i] * growths[i];
  }
  mean /= total, squares /= total;
  return CrestCorrection{mean, std::hypot(kLawSd, std::sqrt(std::max(squares - mean * mean, 0.0)))};
}

}  // namespace waymark::pipeline
