// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>
#include "pipeline/forest/stand_polygon.hpp"
#include "pipeline/forest/stand_volume.hpp"
namespace waymark {

/// A tree as an inventory counts it. Metres; an unknown value is NaN, an unknown deviation 0.
struct StandTree {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double place_sd = 0;  ///< of each coordinate
  double height = kUnknown, height_sd = 0;
  double diameter = kUnknown, diameter_sd = 0;
  double diameter_bias = 0;                   ///< sd of the error all diameters of the stand share
  double volume = kUnknown, mass = kUnknown;  ///< m3, kg
  double confidence = 1;                      ///< probability that it is a tree
};

/// A figure with its standard error; NaN, NaN where the trees do not tell it.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double se = std::numeric_limits<double>::quiet_NaN();
};

struct DiameterClass {
  double from = 0, to = 0;  ///< metres, [from, to)
  Estimate stems;           ///< per hectare
};

struct StandFigures {
  double hectares = 0;
  int trees = 0;                     ///< counted in the stand
  int without_diameter = 0;          ///< of these: in stems and heights, not in basal area and volume
  Estimate stems;                    ///< per hectare
  Estimate basal_area;               ///< m2 per hectare
  Estimate volume;                   ///< m3 per hectare
  Estimate mass;                     ///< t per hectare
  Estimate lorey_height;             ///< m, mean height weighted by basal area
  Estimate dominant_height;          ///< m, mean height of the 100 thickest per hectare
  Estimate mean_height;              ///< m
  Estimate quadratic_mean_diameter;  ///< m
  Estimate mean_diameter;            ///< m
  std::vector<DiameterClass> classes;
};

struct InventoryOptions {
  double class_width = 0.05;           ///< metres; classes begin at multiples of it
  double class_end = 0;                ///< metres: classes up to here even where no tree is that thick
  std::vector<RecallRow> recall = {};  ///< empty: what was found is what is there
  bool recall_errs_alike = false;  ///< rows too high or too low all together, as in a forest unlike others
  double form_factor_error = 0;    ///< relative sd of the volume all trees of the stand share
};

/// The figures of one stand.
///
/// A tree is counted where its stem stands, half-open on edges (inside()): every tree of a plane divided into
/// stands is counted once, and none is cut in two. Dominant height takes 100 trees times the hectares, of the
/// last one a fraction; where a stand has fewer trees, all of them.
///
/// Standard errors are first-order (delta method) and speak of this stand, not of a population it would be a
/// sample of. Each tree errs by itself in height and diameter; is one with probability `confidence`; stands
/// in the stand with probability Phi(distance to the edge / place_sd), which also lets trees just outside
/// matter. Shared by all trees of the stand: diameter_bias, the form factor, and the recall.
///
/// Trees nobody found are not in the figures unless `recall` tells how many they are: then every tree counts
/// confidence / recall(height) times, as Horvitz and Thompson (1952) weight a sample. Means (Lorey,
/// quadratic) then move towards the heights that are hard to find.
///
/// O(trees + trees in the stand's box x corners).
StandFigures inventory(std::span<const StandTree> trees, const StandPolygon& stand,
                       const InventoryOptions& options = {});

/// Trees that inventory() counts in the stand: indices, rising.
std::vector<std::size_t> trees_in(std::span<const StandTree> trees, const StandPolygon& stand);

}  // namespace waymark
