// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/rim_closure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/fusion/cleaning/rim_axes.hpp"
#include "pipeline/fusion/projection/rim_profile.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinCells = 3;
// Maximum likelihood on landings 7, 303, 901 and 902 (docs/methods/craters.md): log odds per closed rim,
// neutral point between the two means, gain of the image's log odds once heights confirm its craters.
constexpr double kPerRim = 63, kEven = 0.25, kSharper = 0.35;
constexpr double kTrusted = 40;  // (difference of means) / variance; median of the images of those landings
constexpr double kMin = -0.1, kMax = 0.2;  // diameters; values are clamped

template <class Values>
double quantile(Values values, double fraction) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * double(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// Weighted mean and variance of the closed rims of one kind.
struct Kind {
  double mean, variance;
};

struct Rim {
  std::size_t observation;
  double closed;
};

Kind kind_of(std::span<const Rim> rims, const auto& weight, const Kind& before) {
  constexpr double kBefore = 5;  // weight of the prior, in observations
  double total = kBefore, sum = kBefore * before.mean, squares = kBefore * before.variance;
  for (const Rim& rim : rims) total += weight(rim), sum += weight(rim) * rim.closed;
  const double mean = sum / total;
  for (const Rim& rim : rims) squares += weight(rim) * (rim.closed - mean) * (rim.closed - mean);
  return {mean, squares / total};
}

double log_odds(double p) {
  const double bounded = std::clamp(p, 1e-4, 1 - 1e-4);
  return std::log(bounded / (1 - bounded));
}

}  // namespace

std::optional<double> rim_closure(const Terrain& terrain, const GroundOutline& outline) {
  if (!(outline.diameter() >= kMinCells * std::max(terrain.step_x(), terrain.step_y()))) return std::nullopt;
  const auto heights = rim_heights(terrain, outline);
  if (!heights) return std::nullopt;
  const auto crest = heights->middleRows<3>(6).colwise().maxCoeff().eval();
  const auto floor = heights->topRows<4>().reshaped().eval();
  return (quantile(std::vector<double>(crest.begin(), crest.end()), 0.15) -
          quantile(std::vector<double>(floor.begin(), floor.end()), 0.2)) /
         outline.diameter();
}

void update_crater_confidences(std::span<Observation> observations, const TypeRegistry& types,
                               const Terrain& terrain, double metres_per_unit) {
  std::vector<Rim> rims;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& o = observations[i];
    const LandmarkType& type = types[o.type];
    if (type.evidence != EvidenceModel::bowl || !o.rejected.empty()) continue;
    GroundOutline outline;
    outline.centre = o.position.xyz;
    outline.centre.head<2>() *= metres_per_unit;
    const auto rim = rim_axes(o, type);
    if (!rim) continue;
    outline.major = rim->major, outline.minor = rim->minor, outline.orientation = rim->orientation;
    if (const auto closed = rim_closure(terrain, outline))
      rims.push_back({i, std::clamp(*closed, kMin, kMax)});
  }
  const auto chance = [&](const Rim& rim) { return observations[rim.observation].confidence; };
  const Kind crater = kind_of(rims, chance, {0.08, 0.04 * 0.04});
  const Kind none = kind_of(rims, [&](const Rim& rim) { return 1 - chance(rim); }, {0.012, 0.018 * 0.018});
  const double apart = std::max(0.0, crater.mean - none.mean);
  const double trust = std::min(1.0, 2 * apart / (crater.variance + none.variance) / kTrusted);
  for (const Rim& rim : rims) {
    double& confidence = observations[rim.observation].confidence;
    const double by_image = log_odds(confidence);
    const double odds =
        by_image + trust * (kSharper * by_image + kPerRim * (rim.closed - none.mean - kEven * apart));
    confidence = std::clamp(1 / (1 + std::exp(-odds)), 1e-6, 1.0);
  }
}

}  // namespace waymark::pipeline
