// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/landmark_valuation.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "landmarks/uid_index.hpp"
#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/projection/footprint.hpp"
#include "pipeline/fusion/valuation/common_errors.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kGsdTolerance = 1.1;

struct Box {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
};

struct Images {
  std::span<const ImageView> all;
  std::vector<Box> boxes;  // bounding boxes of footprints, CRS units
  std::map<std::string_view, std::size_t> by_name;

  explicit Images(std::span<const ImageView> images) : all(images), boxes(images.size()) {
    for (std::size_t i = 0; i < images.size(); ++i) {
      by_name.emplace(images[i].name, i);
      for (const auto& ring : images[i].footprint)
        for (const auto& corner : ring)
          boxes[i].low = boxes[i].low.cwiseMin(corner), boxes[i].high = boxes[i].high.cwiseMax(corner);
    }
  }
  bool may_show(std::size_t i, const Eigen::Vector2d& at, double reach) const {
    if (all[i].footprint.empty()) return false;
    return (at.array() >= boxes[i].low.array() - reach).all() &&
           (at.array() <= boxes[i].high.array() + reach).all();
  }
};

// Evidence by landmark, in the order of evidence.
class EvidenceIndex {
 public:
  EvidenceIndex(std::span<const Landmark> landmarks, std::span<const Observation> evidence)
      : starts_(landmarks.size() + 2), items_(evidence.size()) {
    const UidIndex index(landmarks);
    std::vector<std::uint32_t> landmark_of(evidence.size(), kNone);
    for (std::size_t i = 0; i < evidence.size(); ++i) {
      if (!evidence[i].rejected.empty() || evidence[i].landmark_uid.empty()) continue;
      landmark_of[i] = index.find(evidence[i].landmark_uid).value_or(kNone);
      if (landmark_of[i] != kNone) ++starts_[landmark_of[i] + 2];
    }
    for (std::size_t l = 2; l < starts_.size(); ++l) starts_[l] += starts_[l - 1];
    for (std::uint32_t i = 0; i < evidence.size(); ++i)
      if (landmark_of[i] != kNone) items_[starts_[landmark_of[i] + 1]++] = i;
  }
  std::span<const std::uint32_t> operator[](std::size_t landmark) const {
    return std::span(items_).subspan(starts_[landmark], starts_[landmark + 1] - starts_[landmark]);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<std::uint32_t> starts_, items_;
};

struct ImageCounts {
  int seen = 0, visible = 0;
};

// Metres; infinity where no image knows its ground sample distance.
double finest_gsd(std::span<const ImageView> images, const std::set<std::size_t>& detected) {
  double finest = std::numeric_limits<double>::infinity();
  for (const std::size_t i : detected)
    if (images[i].gsd < finest) finest = images[i].gsd;
  return finest;
}

// Tangent of the lowest sun under which it was detected; 0 if none is known.
double tan_sun_elevation(std::span<const ImageView> images, const std::set<std::size_t>& detected) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::size_t i : detected)
    if (images[i].sun) lowest = std::min(lowest, std::tan(to_radians(images[i].sun->elevation).value));
  return std::isfinite(lowest) ? lowest : 0;
}

ImageCounts count_by_paper(const Images& images, const std::set<std::size_t>& detected,
                           const Eigen::Vector2d& at) {
  double largest = 0;
  for (const std::size_t i : detected) largest = std::max(largest, images.all[i].area);
  ImageCounts counts{static_cast<int>(detected.size()), 0};
  for (std::size_t i = 0; i < images.all.size(); ++i) {
    const auto& rings = images.all[i].footprint;
    const bool covers =
        detected.contains(i) ||
        (images.all[i].area <= largest &&
         std::any_of(rings.begin(), rings.end(), [&](const auto& ring) { return inside(ring, at); }));
    counts.visible += covers;
  }
  return counts;
}

ImageCounts count_by_visibility(const Images& images, const std::set<std::size_t>& detected,
                                const VisibilityTarget& thing, const Terrain* terrain, double metres_per_unit,
                                const ValuationRules& rules) {
  // In images that detected it the outline may touch the border: only the resolution matters.
  double coarsest = 0;
  for (const std::size_t i : detected) {
    const auto gsd = visible_gsd(images.all[i], nullptr, {thing.at, 0}, {.margin = -1e9});
    coarsest = std::max(coarsest, gsd.value_or(images.all[i].gsd));
  }
  ImageCounts counts{static_cast<int>(detected.size()), 0};
  const Eigen::Vector2d at = thing.at.head<2>() / metres_per_unit;
  for (std::size_t i = 0; i < images.all.size(); ++i) {
    if (detected.contains(i)) {
      ++counts.visible;
      continue;
    }
    if (!images.may_show(i, at, thing.radius / metres_per_unit)) continue;
    const auto gsd = visible_gsd(images.all[i], terrain, thing, rules.coverage);
    counts.visible += gsd && *gsd <= kGsdTolerance * coarsest;
  }
  return counts;
}

}  // namespace

double existence_probability(std::span<const double> confidences, int missed, const ExistenceRules& rules) {
  if (confidences.empty()) return 0;
  double best = -1e30, sum = 0;
  for (const double c : confidences) {
    const double bounded = std::clamp(c, 1e-3, 1 - 1e-3);
    const double odds = std::log(bounded / (1 - bounded));
    best = std::max(best, odds);
    sum += odds;
  }
  const double logit = best + rules.further_detection * (sum - best) -
                       rules.missed_image * std::max(missed, 0) - rules.prior_penalty;
  return 1 / (1 + std::exp(-logit));
}

void value_landmarks(std::span<Landmark> landmarks, std::span<const Observation> evidence,
                     std::span<const ImageView> images, const Terrain* terrain, const TypeRegistry& types,
                     double metres_per_unit, const ValuationRules& rules) {
  const Images known(images);
  const EvidenceIndex seen(landmarks, evidence);

  tbb::parallel_for(std::size_t{0}, landmarks.size(), [&](std::size_t l) {
    Landmark& landmark = landmarks[l];
    const LandmarkType& type = types[landmark.type];
    std::set<std::size_t> detected;
    std::set<std::string_view> surveys;
    std::vector<double> confidences;
    for (const std::uint32_t i : seen[l]) {
      const Observation* const o = &evidence[i];
      const auto image = known.by_name.find(o->source);
      if (image != known.by_name.end())
        detected.insert(image->second);
      else
        surveys.insert(o->source);
      confidences.push_back(o->confidence);
    }
    ImageCounts counts;
    const Eigen::Vector3d& at = landmark.position.xyz;
    if (!detected.empty() && rules.cover == CoverRule::paper)
      counts = count_by_paper(known, detected, at.head<2>());
    if (!detected.empty() && rules.cover == CoverRule::sound) {
      const auto body = body_radius(body_index(type), landmark.features);
      const VisibilityTarget thing{{at.x() * metres_per_unit, at.y() * metres_per_unit, at.z()},
                                   body ? body->metres : 0};
      counts = count_by_visibility(known, detected, thing, terrain, metres_per_unit, rules);
    }
    if (!detected.empty())
      landmark.covariance.topLeftCorner<2, 2>() += known.all[*detected.begin()].common_covariance;
    landmark.quality.seen = counts.seen + static_cast<int>(surveys.size());
    landmark.quality.visible = counts.visible + static_cast<int>(surveys.size());
    landmark.quality.feature_confidences.assign(type.features.size(), std::nullopt);
    for (std::size_t f = 0; f < type.features.size() && f < landmark.features.size(); ++f)
      landmark.quality.feature_confidences[f] = spread_confidence(
          landmark.features[f], type.features[f].scale, type.features[f].reference, rules.spread);
    if (!detected.empty() && rules.spread == SpreadRule::sound) {
      add_common_errors(landmark, type, finest_gsd(images, detected));
      if (std::isnan(landmark.covariance(2, 2)))  // the ground's height is unknown, so its slope is
        add_slope_error(landmark, type, tan_sun_elevation(images, detected));
    }
    landmark.confidence = existence_probability(confidences, landmark.quality.visible - landmark.quality.seen,
                                                rules.existence.value_or(type.existence));
  });
}

std::int64_t remove_improbable(std::vector<Landmark>& landmarks, std::vector<Observation>& evidence,
                               const TypeRegistry& types) {
  std::set<std::string> none;
  for (const Landmark& landmark : landmarks)
    if (landmark.confidence < types[landmark.type].existence.min_probability) none.insert(landmark.uid);
  std::erase_if(landmarks, [&](const Landmark& landmark) { return none.contains(landmark.uid); });
  for (Observation& o : evidence)
    if (!o.landmark_uid.empty() && none.contains(o.landmark_uid))
      o.rejected = "landmark improbable", o.landmark_uid.clear();
  return static_cast<std::int64_t>(none.size());
}

}  // namespace waymark::pipeline
