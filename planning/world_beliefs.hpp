// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>
#include "planning/odometry_belief.hpp"
#include "planning/rivals.hpp"
#include "planning/route_search.hpp"
namespace waymark::planning {

/// Beliefs of one drive in random worlds. What a landmark does repeats: one that is absent is missed at each
/// sighting, one that is low or behind a bump at most of them. So each world draws once per landmark whether
/// it exists, by its confidence, and how well it is seen: its detections have the sensor's probability on
/// average, and an intra-class correlation of 0.4.
/// - Without identities, a landmark counts with exp(-n), n the expected number of its rivals (Rivals): the
///   probability that a sighting is taken for no other, if wrong ones are independent.
class WorldBeliefs {
 public:
  WorldBeliefs(const Symmetric3& start, const Odometry& odometry, const localization::LandmarkGrid& map,
               std::int64_t worlds, std::int64_t seed);

  void drive(const DriveStep& step);
  /// Adds what is seen on `length` metres at a pose. `map` is that of the constructor.
  void see(const localization::Pose2& pose, double length, const localization::LandmarkGrid& map,
           const LandmarkSensing& sensing);
  /// Returns the covariance of the error over all worlds.
  Symmetric3 mean() const;
  /// Returns the sd of the position in each world.
  std::vector<double> position_sds() const;

 private:
  struct Draw {
    bool exists;
    double visible;  // in [0, 1): seen well where the probability of detection is larger
  };
  std::vector<DriveBelief> beliefs_;
  std::shared_ptr<const Rivals> rivals_;
  std::shared_ptr<const std::vector<std::vector<Draw>>> draws_;  // per world and landmark; copies share them
};

/// Returns the largest information per metre that any world can draw in each cell, as max_rate() has it: all
/// landmarks exist and are seen well.
std::vector<double> max_rate_in_any_world(const RouteCells& cells, const std::vector<char>& passable,
                                          const localization::LandmarkGrid& map,
                                          const LandmarkSensing& sensing, const Advanced& advanced = {});

/// Follows a route, whose covariances become those over all worlds. Returns the largest sd in each world.
std::vector<double> follow_route(WorldBeliefs& beliefs, const RouteProblem& problem,
                                 const localization::LandmarkGrid& map, const LandmarkSensing& sensing,
                                 Route& route);

}  // namespace waymark::planning
