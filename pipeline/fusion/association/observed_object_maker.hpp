// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
#include "core/observation.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/association/merging.hpp"
namespace waymark::pipeline {

/// Converts observations to the attributes by which they are associated.
class ObservedObjectMaker {
 public:
  /// The rules must outlive it.
  ObservedObjectMaker(const TypeRegistry& types, const MergeRules& rules);

  /// Returns all but the source, which the caller numbers.
  ObservedObject operator()(const Observation& observation) const;

 private:
  const TypeRegistry* types_;
  const MergeRules* rules_;
  std::vector<std::optional<BodyIndex>> sizes_;  ///< by type
};

}  // namespace waymark::pipeline
