// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/graph.hpp"
namespace waymark::localization {

/// Builds a pose graph from a drive. SLAM associates the sightings; every step and sighting becomes an
/// edge. One pose for the start and one for each set of sightings.
class PoseGraphBuilder final : public Localizer {
 public:
  PoseGraphBuilder(const PoseEstimate& start, EkfSlam& slam);
  void predict(const BodyMotion& motion) override;
  std::vector<Match> update(const SightingSet& seen) override;
  PoseEstimate estimate() const override { return slam_.estimate(); }
  LocalizationStatus status() const override { return slam_.status(); }

  /// Returns the graph, with the map's landmarks and the start as priors and SLAM's result as initial
  /// guess. Omits landmarks with log odds below 0. `landmarks`: those of SLAM, in the order of the graph,
  /// lines with their two numbers (state_as_position()).
  PoseGraph graph(std::vector<SlamLandmark>& landmarks) const;

 private:
  EkfSlam& slam_;
  PoseEstimate start_;
  BodyMotion pending_;
  PoseGraph graph_;                  ///< landmarks by the indices of SLAM
  std::vector<LineExtent> extents_;  ///< of the sightings of lines, in their order
};

}  // namespace waymark::localization
