// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/map_evidence.hpp"

#include <algorithm>
#include <limits>

#include "pipeline/fusion/projection/footprint.hpp"

namespace waymark::workflows {
namespace {

std::set<std::string> sources_of(const std::vector<const Observation*>& evidence) {
  std::set<std::string> sources;
  for (const Observation* seen : evidence) sources.insert(seen->source);
  return sources;
}

bool covers(const geodb::ImageRecord& image, const Landmark& landmark) {
  const Eigen::Vector2d at = landmark.position.xyz.head<2>();
  return std::ranges::any_of(image.footprint, [&](const auto& ring) { return pipeline::inside(ring, at); });
}

}  // namespace

ObservationKey key_of(const Observation& o) {
  constexpr double none = std::numeric_limits<double>::lowest();
  const Eigen::Vector2d pixel = o.pixel.value_or(Eigen::Vector2d(none, none));
  const Eigen::Vector3d& at = o.position.xyz;
  return {o.type, o.source, pixel.x(), pixel.y(), at.x(), at.y(), at.z()};
}

EvidenceByUid::EvidenceByUid(const LoadedMap& map) {
  for (const Observation& seen : map.evidence)
    if (seen.rejected.empty()) rows_[seen.landmark_uid].push_back(&seen);
}

const std::vector<const Observation*>& EvidenceByUid::of(const std::string& uid) const {
  static const std::vector<const Observation*> none;
  const auto found = rows_.find(uid);
  return found == rows_.end() ? none : found->second;
}

ImagesOfTwo::ImagesOfTwo(const LoadedMap& a, const LoadedMap& b) {
  for (const geodb::ImageRecord& image : a.images) names_a_.insert(image.name);
  for (const geodb::ImageRecord& image : b.images) names_b_.insert(image.name);
  for (const geodb::ImageRecord& image : a.images)
    if (names_b_.contains(image.name)) shared_.push_back(&image);
  for (const auto* images : {&a.images, &b.images})
    for (const geodb::ImageRecord& image : *images)
      if (image.gsd) gsd_[image.name] = image.gsd->value;
}

pipeline::CommonEvidence ImagesOfTwo::compare(const Landmark& a, const std::vector<const Observation*>& of_a,
                                              const Landmark& b,
                                              const std::vector<const Observation*>& of_b) const {
  pipeline::CommonEvidence common;
  std::set<ObservationKey> keys;
  for (const Observation* seen : of_a) keys.insert(key_of(*seen));
  for (const Observation* seen : of_b) common.observations += keys.contains(key_of(*seen));
  const std::set<std::string> in_a = sources_of(of_a), in_b = sources_of(of_b);
  for (const std::string& source : in_a) {
    common.sources += in_b.contains(source);
    common.found_by_a += names_b_.contains(source) && !in_b.contains(source);
  }
  for (const std::string& source : in_b)
    common.found_by_b += names_a_.contains(source) && !in_a.contains(source);
  for (const geodb::ImageRecord* image : shared_)
    common.missed += !in_a.contains(image->name) && !in_b.contains(image->name) &&
                     (covers(*image, a) || covers(*image, b));
  for (const auto* sources : {&in_a, &in_b})
    for (const std::string& source : *sources)
      if (const auto gsd = gsd_.find(source); gsd != gsd_.end())
        common.finest_gsd = std::min(common.finest_gsd, gsd->second);
  return common;
}

}  // namespace waymark::workflows
