// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "localization/identification/landmark_grid.hpp"
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Learns over a drive how many of the doubtful landmarks of a map exist, against what their confidences
/// say. Where the map has four false landmarks of confidence 0.2 for each true one, 1; where it has nine,
/// near 1/2; where all are false, near 0.
///
/// Doubtful landmarks in view are expected with their confidence times the rate of detection. One counts as
/// seen if a sighting that shows no other landmark is within the gate; what falls there by chance is
/// subtracted. A pose that is too uncertain to distinguish the two teaches nothing.
class DoubtCalibration {
 public:
  /// What the sensor can see.
  struct View {
    double range = 0, bearing = 0;  ///< m; rad to each side
    double detection = 1;           ///< fraction of the landmarks in view that is seen
    double clutter = 0;             ///< density of sightings without landmark, per metre and radian
  };

  /// Adds a set. `shown`: keys of the landmarks that the sightings show, 0 for none, one per sighting. Cost:
  /// doubtful landmarks in view times sightings.
  void add(const SightingSet& seen, std::span<const LandmarkKey> shown, const PoseEstimate& robot,
           const LandmarkGrid& map, const View& view);
  /// Returns for each type the factor of the probability that a doubtful landmark exists, (0, 1]. Types
  /// beyond the end have 1.
  const std::vector<double>& factors() const { return factors_; }

 private:
  struct Sums {
    double expected = 0, seen = 0;
  };
  std::vector<Sums> sums_;  // by type
  std::vector<double> factors_;
};

}  // namespace waymark::localization
