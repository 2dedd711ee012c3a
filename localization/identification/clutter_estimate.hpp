// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "localization/sighting.hpp"
namespace waymark::localization {

/// Estimates the density of sightings that show no landmark of the map: false detections, and objects that
/// the map lacks. It is the mean number of sightings per set over the sensor's view, times the fraction that
/// is not of the map. The view is the rectangle in range and bearing on which a uniform density has the
/// same second moments. Forgets within some 50 sets.
class ClutterEstimate {
 public:
  /// Adds the sightings of a set, before they are matched.
  void add_sightings(const SightingSet& seen);
  /// Adds a set's expected number of sightings that are not of the map, of `count` matched ones.
  void add_unmapped(double unmapped, double count);
  /// Returns the density per metre of range and radian of bearing. Half of the sightings count as unmapped
  /// until matches are known. Bearings without range are taken as spread over `bearing_reach` metres.
  double density(double bearing_reach) const;

 private:
  double sets_ = 0, sightings_ = 0;                              // discounted numbers
  double ranged_ = 0, squared_range_ = 0, squared_bearing_ = 0;  // sums
  double unmapped_ = 0, matched_ = 0;
};

}  // namespace waymark::localization
