// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <vector>
#include "geo/dem_source.hpp"
#include "landmarks/rock_abundance.hpp"
#include "planning/object_hazard.hpp"
#include "planning/relief_hazard.hpp"
namespace waymark::planning {

/// Class of a cell.
enum class HazardClass { safe = 0, uncertain = 1, hazard = 2, unknown = 3 };

/// Rocks that the map cannot show.
struct UndetectedRocks {
  bool known = false;     ///< false: no estimate, nothing is added
  RockCover cover = {};   ///< of the site
  double min_height = 0;  ///< metres, of the smallest rock that stops the vehicle
  Uncertain height_per_diameter{kRockHeightPerDiameter, kRockHeightPerDiameterSd};  ///< of the rocks
  double detected_diameter = 0;  ///< metres, rocks at least this wide are in the map where it was surveyed
  std::vector<std::vector<Eigen::Vector2d>> surveyed =
      {};  ///< rings, even-odd rule, DEM axes; empty: everywhere
};

/// Returns the expected number of hazardous undetected rocks per square metre.
Uncertain undetected_density(const UndetectedRocks& rocks, bool surveyed);
/// Returns the probability that there is one on an area of square metres.
Uncertain undetected_probability(const UndetectedRocks& rocks, bool surveyed, double area);

/// Input of a hazard map: the same for all tiles.
struct HazardRequest {
  Vehicle vehicle;
  HeightErrors errors = {};
  UndetectedRocks undetected = {};
  double min_uncertain = 0.05;  ///< probability from which a cell is uncertain
  double min_hazard = 0.5;      ///< probability from which a cell is a hazard
};

/// Bands of a hazard map in the order of the file.
enum class HazardBand {
  slope,
  slope_sd,
  roughness,
  roughness_sd,
  step,
  step_sd,
  object,
  undetected,
  undetected_sd,
  probability,
  hazard_class
};
inline constexpr std::size_t kHazardBands = 11;

/// Name of a band and its unit.
struct BandName {
  const char *name, *unit;
};
/// Returns the names and units in the order of the bands.
std::array<BandName, kHazardBands> hazard_band_names();

/// Bands of a window, NaN if unknown; the class is always known.
using HazardTile = std::array<Grid<float>, kHazardBands>;

/// Cells of each class.
using ClassCounts = std::array<std::int64_t, 4>;

/// Computes hazard maps by windows. The value of a cell does not depend on the window. Thread-safe.
class HazardMap {
 public:
  /// Objects are in the axes of the DEM. Throws Error{input} for a base that is too many cells wide.
  HazardMap(const DemSource& dem, HazardRequest request, std::vector<HazardObject> objects);

  HazardTile compute(const Window& window) const;
  const BaseFootprint& footprint() const { return base_; }
  /// Returns the radius in metres over which relief is judged: that of the base, at least a cell and a half.
  double fitted_radius() const;

 private:
  const DemSource& dem_;
  HazardRequest request_;
  std::vector<HazardObject> objects_;  // by x
  std::vector<double> xs_;
  double max_reach_ = 0;
  BaseFootprint base_;
  FitErrors errors_;
  std::array<Uncertain, 2> undetected_;  // outside the survey, inside
};

}  // namespace waymark::planning
