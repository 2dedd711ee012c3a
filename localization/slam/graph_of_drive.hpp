// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/slam/ekf_slam.hpp"
#include "localization/slam/graph.hpp"
namespace waymark {

/// A graph from a drive: SLAM decides which landmark was seen, every step and sighting becomes an edge. One
/// pose for the start and one for each set of sightings.
class GraphOfDrive final : public Localizer {
 public:
  GraphOfDrive(const PoseEstimate& start, EkfSlam& slam);
  void move(const BodyMotion& motion) override;
  std::vector<Match> see(const SightingSet& seen) override;
  PoseEstimate estimate() const override { return slam_.estimate(); }
  Trust trust() const override { return slam_.trust(); }

  /// The graph, with the map's landmarks and the start as priors and SLAM's result as first guess. Landmarks
  /// that probably do not exist (log odds below 0) are left out. `landmarks`: SLAM's, in the order of the
  /// graph's.
  PoseGraph graph(std::vector<SlamLandmark>& landmarks) const;

 private:
  EkfSlam& slam_;
  PoseEstimate start_;
  BodyMotion pending_;
  PoseGraph graph_;  ///< landmarks by the indices of SLAM
};

}  // namespace waymark
