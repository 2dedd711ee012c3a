// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/rim_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/fusion/cleaning/rim_axes.hpp"
#include "pipeline/fusion/projection/rim_profile.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinCells = 3;
constexpr double kMinDepth = 0.01;  // diameters; smaller ones are noise, and fractions of them, too
// Logistic regression with the log odds of the image as offset, landings 6101 to 6104, 6111 and 6112
// (docs/evaluation/2026-11-27-craters-on-landings.md).
constexpr double kPerEvenness = 4.9, kPerDepth = 70, kFullDepth = 0.06, kPerRaised = 2.85, kConstant = -6.2;
// (Difference of means) / variance of the log odds of both kinds from which on heights are fully trusted. 1
// for odds that hold and known kinds; images of landings with cells of 1 m have about 0.45.
constexpr double kTrusted = 0.3;
constexpr double kPriorCount = 5;  // weight of the prior of each kind, in observations

template <class Values>
double quantile(Values values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * double(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Weighted mean and variance of the log odds of one kind.
struct Kind {
  double mean, variance;
};

struct Rim {
  std::size_t observation;
  double odds;  // log, by heights
};

Kind kind_of(std::span<const Rim> rims, const auto& weight, const Kind& before) {
  double total = kPriorCount, sum = kPriorCount * before.mean, squares = kPriorCount * before.variance;
  for (const Rim& rim : rims) total += weight(rim), sum += weight(rim) * rim.odds;
  const double mean = sum / total;
  for (const Rim& rim : rims) squares += weight(rim) * (rim.odds - mean) * (rim.odds - mean);
  return {mean, squares / total};
}

double log_odds(double p) {
  const double bounded = std::clamp(p, 1e-4, 1 - 1e-4);
  return std::log(bounded / (1 - bounded));
}

std::vector<Rim> rims_of(std::span<const Observation> observations, const TypeRegistry& types,
                         const Terrain& terrain, double metres_per_unit) {
  std::vector<Rim> rims;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& o = observations[i];
    const LandmarkType& type = types[o.type];
    if (type.evidence != EvidenceModel::bowl || !o.rejected.empty()) continue;
    GroundOutline outline;
    outline.centre = o.position.xyz;
    outline.centre.head<2>() *= metres_per_unit;
    const auto axes = rim_axes(o, type);
    if (!axes) continue;
    outline.major = axes->major, outline.minor = axes->minor, outline.orientation = axes->orientation;
    if (const auto shape = measure_rim_shape(terrain, outline)) rims.push_back({i, crater_log_odds(*shape)});
  }
  return rims;
}

}  // namespace

std::optional<RimShape> measure_rim_shape(const Terrain& terrain, const GroundOutline& outline) {
  if (!(outline.diameter() >= kMinCells * std::max(terrain.step_x(), terrain.step_y()))) return std::nullopt;
  const auto heights = rim_heights(terrain, outline);
  if (!heights) return std::nullopt;
  const auto values = [](const auto& some) { return std::vector<double>(some.begin(), some.end()); };
  const Eigen::RowVector<double, kRimAzimuths> highest = heights->middleRows<3>(6).colwise().maxCoeff();
  const std::vector<double> crest = values(highest);
  const double floor = quantile(values(heights->topRows<4>().reshaped().eval()), 0.2);
  const double outside = quantile(values(heights->bottomRows<3>().reshaped().eval()), 0.5);
  const double middle = quantile(crest, 0.5), depth = (middle - floor) / outline.diameter();
  const double whole = std::max(depth, kMinDepth) * outline.diameter();
  return RimShape{.depth = depth,
                  .evenness = std::clamp((quantile(crest, 0.05) - floor) / whole, -1.0, 1.0),
                  .raised = std::clamp((middle - outside) / whole, -1.0, 1.0)};
}

double crater_log_odds(const RimShape& rim) {
  return kConstant + kPerEvenness * rim.evenness + kPerDepth * std::clamp(rim.depth, 0.0, kFullDepth) +
         kPerRaised * rim.raised;
}

void update_crater_confidences(std::span<Observation> observations, const TypeRegistry& types,
                               const Terrain& terrain, double metres_per_unit) {
  const std::vector<Rim> rims = rims_of(observations, types, terrain, metres_per_unit);
  if (rims.empty()) return;
  double mean = 0;
  for (const Rim& rim : rims) mean += rim.odds / double(rims.size());
  const auto chance = [&](const Rim& rim) { return observations[rim.observation].confidence; };
  const Kind crater = kind_of(rims, chance, {mean, 9});
  const Kind none = kind_of(rims, [&](const Rim& rim) { return 1 - chance(rim); }, {mean, 6});
  const double apart = std::max(0.0, crater.mean - none.mean);
  const double trust = std::min(1.0, 2 * apart / (crater.variance + none.variance) / kTrusted);
  for (const Rim& rim : rims) {
    double& confidence = observations[rim.observation].confidence;
    const double odds = log_odds(confidence) + trust * rim.odds;
    confidence = std::clamp(1 / (1 + std::exp(-odds)), 1e-6, 1.0);
  }
}

}  // namespace waymark::pipeline
