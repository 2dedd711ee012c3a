// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>
namespace waymark {

/// What of a laser's returns is ground. Metres and radians.
struct GroundRules {
  double square =
      20;  ///< side of the squares whose lowest return begins the ground: wider than crowns and houses
  double cell = 0.5;      ///< of the lowest returns in a cell of this side only the lowest may be ground
  double distance = 1;    ///< largest distance of a return from the plane of its triangle
  double angle = 0.16;    ///< largest angle between that plane and the ways to the triangle's corners
  double steepest = 0.6;  ///< slope at which the lowest return of a square cannot stand above those around
  double below = 3;       ///< a return so far below all others within four metres is an error
};

/// The returns that are ground, by progressive densification of a triangulation (Axelsson 2000): the lowest
/// return of each square begins; then returns join that lie near the plane of their triangle and are seen
/// from its corners at small angles, until none joins any more. Squares and cells lie at whole multiples of
/// their sides, so neighbouring pieces of a survey agree but for a margin of about two squares. Order of
/// the returns does not matter. Empty for fewer than four squares with returns.
/// Departures: only the lowest return of each cell is asked; steep edges are not mirrored, so terraces and
/// cliffs above `distance` are rounded. About 5 us per cell.
std::vector<Eigen::Vector3d> ground_returns(std::span<const Eigen::Vector3d> returns,
                                            const GroundRules& rules = {});

}  // namespace waymark
