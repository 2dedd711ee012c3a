// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include "localization/global/horizon_ring.hpp"
namespace waymark {

inline constexpr int kHorizonSectors = 180;

/// The horizon of whoever stands within half a step of a place.
struct HorizonPlace {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double step = 0;
  double relief = 0;  ///< m: standard deviation of the ground within half a step
  std::vector<HorizonEdge> ring;
};

/// The places of those that lie on known ground, in their order; the same for any number of threads.
std::vector<HorizonPlace> look_round(const TerrainGrid& ground, std::span<const Eigen::Vector2d> at,
                                     double step, const SkylineOptions& options);

/// A place and a heading, and how well they explain the tops: log of how much more likely they are than at
/// a place of which nothing is known.
struct HorizonGuess {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw = 0, score = 0;
};

/// The `most` best headings at each place, no two beside each other. A top fits where the horizon of its
/// sector, or of one beside it, is as high as it was seen: within its noise and what half a step changes (the
/// eye's height by the relief, all directions by parallax, both over the distance of the horizon there). A
/// top that fits nowhere costs no more than `kMissed`. In the order of `places`; the same for any number of
/// threads.
std::vector<HorizonGuess> best_headings(std::span<const HorizonPlace> places,
                                        std::span<const HorizonTop> tops, std::size_t most,
                                        const SkylineOptions& options);

}  // namespace waymark
