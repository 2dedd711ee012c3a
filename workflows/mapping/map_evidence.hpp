// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <vector>
#include "pipeline/fusion/valuation/landmark_fusion.hpp"
#include "workflows/mapping/loaded_map.hpp"
namespace waymark::workflows {

/// What makes an observation the same in two maps: type, source, pixel and position.
using ObservationKey = std::tuple<TypeId, std::string, double, double, double, double, double>;
ObservationKey key_of(const Observation& observation);

/// Accepted observations of a map by the uid of their landmark. The map must outlive it, unchanged.
class EvidenceByUid {
 public:
  explicit EvidenceByUid(const LoadedMap& map);
  const std::vector<const Observation*>& of(const std::string& uid) const;

 private:
  std::unordered_map<std::string, std::vector<const Observation*>> rows_;
};

/// Images of two maps. An image is in both if it has the same name. The maps must outlive it, unchanged.
class ImagesOfTwo {
 public:
  ImagesOfTwo(const LoadedMap& a, const LoadedMap& b);
  /// Compares the observations of a landmark in both maps.
  pipeline::CommonEvidence compare(const Landmark& a, const std::vector<const Observation*>& of_a,
                                   const Landmark& b, const std::vector<const Observation*>& of_b) const;

 private:
  std::set<std::string> names_a_, names_b_;
  std::vector<const geodb::ImageRecord*> shared_;
  std::unordered_map<std::string, double> gsd_;  ///< metres
};

}  // namespace waymark::workflows
