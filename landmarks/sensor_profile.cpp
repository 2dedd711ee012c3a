// SPDX-License-Identifier: Apache-2.0
#include "landmarks/sensor_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/error.hpp"
#include "core/landmark.hpp"
#include "landmarks/assessed_quality.hpp"

namespace waymark::inline landmarks {
namespace {

std::optional<double> weighted_quality(const Landmark& landmark, const std::vector<double>& weights) {
  if (!is_quality_assessed(landmark.quality, weights)) return std::nullopt;
  std::vector<std::optional<double>> feature_confidences = landmark.quality.feature_confidences;
  feature_confidences.resize(weights.size());  // landmarks without valuation have no feature confidences
  return landmark_quality(multiplicity_confidence(landmark.quality.seen, landmark.quality.visible),
                          feature_confidences, weights);
}

}  // namespace

double detection_probability(const SensorCoverage& coverage, double range, double diameter) {
  if (!coverage.detection_odds || !(diameter > 0)) return coverage.detection;
  const DetectionOdds& odds = *coverage.detection_odds;
  return 1 / (1 + std::exp(-(odds.intercept + odds.per_metre * range +
                             odds.per_log_diameter * std::log(diameter))));
}

std::vector<double> weights_for(const SensorProfile& profile, const LandmarkType& type) {
  const bool listed =
      std::ranges::find(profile.weights, type.name, &FeatureWeight::type) != profile.weights.end();
  std::vector<double> weights(type.features.size(), listed ? 0.0 : 1.0);
  for (const FeatureWeight& weight : profile.weights)
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weight.type == type.name && weight.feature == type.features[i].name) weights[i] = weight.weight;
  return weights;
}

std::optional<double> quality_for(const SensorProfile& profile, const LandmarkType& type,
                                  const Landmark& landmark) {
  return weighted_quality(landmark, weights_for(profile, type));
}

std::optional<double> quality_of(const LandmarkType& type, const Landmark& landmark) {
  return weighted_quality(landmark, std::vector<double>(type.features.size(), 1.0));
}

void SensorRegistry::add(SensorProfile profile) {
  if (profile.name.empty() || find(profile.name))
    throw std::logic_error(fmt::format("the name of a sensor is empty or taken: '{}'", profile.name));
  for (const FeatureWeight& weight : profile.weights)
    if (!(weight.weight >= 0))
      throw std::logic_error(fmt::format("{}: the weight of {}.{} is {}", profile.name, weight.type,
                                         weight.feature, weight.weight));
  profiles_.push_back(std::move(profile));
}

const SensorProfile* SensorRegistry::find(std::string_view name) const {
  const auto found = std::ranges::find(profiles_, name, &SensorProfile::name);
  return found == profiles_.end() ? nullptr : &*found;
}

const SensorProfile& SensorRegistry::at(std::string_view name) const {
  if (const SensorProfile* profile = find(name)) return *profile;
  const std::string nearest = nearest_name(name, names());
  throw Error(ErrorCode::usage, fmt::format("there is no sensor '{}'", name), "",
              nearest.empty() ? "`waymark sensors` lists them" : fmt::format("did you mean '{}'?", nearest));
}

std::vector<std::string> SensorRegistry::names() const {
  std::vector<std::string> all;
  for (const SensorProfile& profile : profiles_) all.push_back(profile.name);
  return all;
}

}  // namespace waymark::inline landmarks
