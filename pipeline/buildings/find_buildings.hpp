// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>
#include "pipeline/buildings/regular_outline.hpp"
namespace waymark::pipeline {

/// Form of a roof by its planes.
enum class RoofKind {
  flat,     ///< four fifths of the area below 8 degrees
  shed,     ///< one sloping plane
  gabled,   ///< two planes that slope away from each other
  hipped,   ///< planes that slope to three or four sides
  complex,  ///< any other
};

/// Returns "flat", "shed", "gabled", "hipped" or "complex".
std::string to_string(RoofKind kind);

/// Building detected from above. Positions are metres in the axes of the survey: x east and y north of the
/// centre of its cell (0, 0).
struct DetectedBuilding {
  RegularOutline outline;
  double area = 0;    ///< of the outline without courtyards, m2
  double height = 0;  ///< ground to the highest point of the planes, m
  double height_sd = 0;
  std::vector<double> wall_heights;  ///< of the walls of outline.outer, ground to roof, m; NaN if unknown
  double ground = 0;                 ///< mean elevation along the outline; NaN if unknown
  RoofKind roof = RoofKind::complex;
  double slope = 0;        ///< of the planes, mean by area, radians
  double density = 0;      ///< last returns on the roof per m2
  double penetration = 0;  ///< fraction of pulses that split on the roof or pass it; NaN if unknown
  double confidence = 1;
  Window box;  ///< cells of the survey
  std::int64_t first_column = 0,
               first_row = 0;  ///< its first cell by row, of the survey: the tile that owns it
};

struct FoundBuildings {
  std::vector<DetectedBuilding> buildings;       ///< by first cell
  std::map<std::string, std::int64_t> rejected;  ///< reason -> groups of roofs and outlines
};

/// Detects the buildings that have cells among `owned`, with cells of the survey, whole.
/// - Roofs are connected planes of last returns (roof_regions.hpp), with edges fitted to walls
///   (regular_outline.hpp).
/// - Rejects roofs smaller than min_area, wider than max_extent, and cut by the edge of the survey.
/// - Rejects what pulses pass or split on, and planes among returns on no plane: trees.
/// - The result for a building depends neither on `owned` nor on the order of the returns.
/// - Counts as rejected only what has its first cell in `owned`.
/// About 2 us per cell, and 1 us per return.
FoundBuildings find_buildings(const CanopySource& canopy, const Window& owned, const RoofRules& rules);

/// Returns the cells of the survey around `owned` that find_buildings() reads.
std::int64_t building_halo(const CanopySource& canopy, const RoofRules& rules);

/// Returns whether a position lies in the outline of a building or within `margin` metres of it.
bool is_on(const DetectedBuilding& building, const Eigen::Vector2d& at, double margin);

}  // namespace waymark::pipeline
