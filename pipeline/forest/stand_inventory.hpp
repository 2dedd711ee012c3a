// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>
#include "pipeline/forest/stand_polygon.hpp"
#include "pipeline/forest/stand_volume.hpp"
namespace waymark::pipeline {

/// Tree of an inventory. Metres; an unknown value is NaN, an unknown deviation 0.
struct StandTree {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double position_sd = 0;  ///< of each coordinate
  double height = kUnknown, height_sd = 0;
  double diameter = kUnknown, diameter_sd = 0;
  double diameter_bias = 0;                   ///< sd of the error common to all diameters of the stand
  double volume = kUnknown, mass = kUnknown;  ///< m3, kg
  double confidence = 1;                      ///< probability of being a tree
};

/// Estimate with its standard error; both NaN if the trees do not determine it.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double se = std::numeric_limits<double>::quiet_NaN();
};

/// Stems of a range of diameters.
struct DiameterClass {
  double from = 0, to = 0;  ///< metres, [from, to)
  Estimate stems;           ///< per hectare
};

/// Figures of a stand.
struct StandAttributes {
  double hectares = 0;
  int trees = 0;                     ///< number in the stand
  int without_diameter = 0;          ///< of these: count in stems and heights, not in basal area and volume
  Estimate stems;                    ///< per hectare
  Estimate basal_area;               ///< m2 per hectare
  Estimate volume;                   ///< m3 per hectare
  Estimate mass;                     ///< t per hectare
  Estimate lorey_height;             ///< m, mean height weighted by basal area
  Estimate dominant_height;          ///< m, mean height of the 100 largest diameters per hectare
  Estimate mean_height;              ///< m
  Estimate quadratic_mean_diameter;  ///< m
  Estimate mean_diameter;            ///< m
  std::vector<DiameterClass> classes;
};

/// Options of an inventory.
struct InventoryOptions {
  double class_width = 0.05;              ///< metres; classes begin at multiples of it
  double class_end = 0;                   ///< metres: classes extend to here even if empty
  std::vector<RecallRow> recall = {};     ///< empty: no correction for undetected trees
  bool recall_errors_correlated = false;  ///< errors of all rows are fully correlated
  double form_factor_error = 0;           ///< relative sd of volume, common to all trees of the stand
};

/// Computes the stand attributes. O(trees + trees in the stand's box x corners).
/// - A tree belongs to the stand that contains its stem, half-open on edges (inside()): each tree of a
///   partitioned area counts once.
/// - Dominant height takes 100 trees times the hectares, of the last one a fraction; all trees if the stand
///   has fewer.
/// - Standard errors are first-order (delta method) for this stand, not for a population. Independent per
///   tree: height, diameter, `confidence`, and position, with the probability Phi(distance to the edge /
///   position_sd) of being inside. Common to the stand: diameter_bias, form factor, recall.
/// - With `recall` every tree has the weight confidence / recall(height) (Horvitz & Thompson 1952), which
///   corrects for undetected trees. Means (Lorey, quadratic) then move towards the heights that are hard to
///   detect.
StandAttributes inventory(std::span<const StandTree> trees, const StandPolygon& stand,
                          const InventoryOptions& options = {});

/// Returns the indices of the trees that inventory() counts in the stand, ascending.
std::vector<std::size_t> trees_in_stand(std::span<const StandTree> trees, const StandPolygon& stand);

}  // namespace waymark::pipeline
