// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::pipeline {

/// Predictors of the stem diameter.
enum class AllometryForm {
  height,        ///< D = a (H - 1.3)^b
  height_crown,  ///< D = a (H CD)^b exp(sigma^2 / 2), Jucker et al. 2017
};
/// Returns the name of a form in tables.
std::string to_string(AllometryForm form);

/// Row of an allometry table: D in centimetres from H and crown diameter CD in metres.
struct Allometry {
  std::string species = "all";  ///< "all": any other species
  AllometryForm form = AllometryForm::height;
  double a = 0, b = 0;
  double sigma = 0;                 ///< residual standard deviation of ln D of a single tree
  std::int64_t trees = 0;           ///< number of trees in the fit; 0: unknown
  double rmse = kUnknown;           ///< cm, on the fitted trees
  double held_out_rmse = kUnknown;  ///< cm, cross-validated on trees (plots) left out of the fit
  double held_out_bias = kUnknown;  ///< cm, predicted minus measured, cross-validated
  std::string source = {};          ///< origin of the coefficients

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

/// DBH and its standard deviation.
struct StemDiameter {
  double metres = 0, sd = 0;
};

/// Returns the DBH of one tree, metres. `height_sd` and `crown_sd` (metres) are added to the residual of
/// the table. `std::nullopt` for trees below 1.3 m, or if the form needs a crown and `crown` is not > 0.
std::optional<StemDiameter> stem_diameter(const Allometry& allometry, double height, double height_sd,
                                          double crown, double crown_sd);

/// Returns the row of a species (case-insensitive), else the row "all", else null.
const Allometry* allometry_of(std::span<const Allometry> table, std::string_view species);

/// Returns the default table: Jucker et al. (2017), Global Change Biology 23, 177-190, all biomes, D =
/// 0.557 (H CD)^0.809, residual variance of ln D 0.056. One tree in three errs by more than a quarter: fit
/// a local table where diameters matter.
const std::vector<Allometry>& built_in_allometry();

/// Reads CSV with the columns species, form (height or height_crown), a, b, sigma. The columns trees,
/// rmse_cm, held_out_rmse_cm, held_out_bias_cm and source are optional. Throws Error{input} naming the
/// line.
std::vector<Allometry> parse_allometry(std::string_view csv, std::string_view file);
/// Returns what parse_allometry() reads.
std::string allometry_as_csv(std::span<const Allometry> table);

}  // namespace waymark::pipeline
