// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
namespace waymark {

/// What a stem diameter is computed from.
enum class AllometryForm {
  height,        ///< D = a (H - 1.3)^b
  height_crown,  ///< D = a (H CD)^b exp(sigma^2 / 2), Jucker et al. 2017
};
std::string to_string(AllometryForm form);

/// One row of an allometry table: D in centimetres from H and crown diameter CD in metres.
struct Allometry {
  std::string species = "all";  ///< "all": of any other species
  AllometryForm form = AllometryForm::height;
  double a = 0, b = 0;
  double sigma = 0;                 ///< standard deviation of a single tree's ln D about the curve
  std::int64_t trees = 0;           ///< it was fitted to; 0: not told
  double rmse = kUnknown;           ///< cm, of the trees it was fitted to
  double held_out_rmse = kUnknown;  ///< cm, of trees (plots) it was not fitted to
  double held_out_bias = kUnknown;  ///< cm, predicted less measured, of the same
  std::string source = {};          ///< where the coefficients come from

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
};

struct StemDiameter {
  double metres = 0, sd = 0;
};

/// DBH of one tree, metres. `height_sd` and `crown_sd` (metres) widen the table's own spread. Nothing below
/// 1.3 m, or where the form needs a crown and there is none (`crown` not > 0).
std::optional<StemDiameter> stem_diameter(const Allometry& allometry, double height, double height_sd,
                                          double crown, double crown_sd);

/// The row of a species, by name without regard to case; else the row "all"; null where there is neither.
const Allometry* allometry_of(std::span<const Allometry> table, std::string_view species);

/// The table used where none is given: Jucker et al. (2017), Global Change Biology 23, 177-190, eq. for all
/// biomes, D = 0.557 (H CD)^0.809, its residual variance of ln D 0.056. One tree in three errs by more than a
/// quarter: fit a table of your own where diameters matter.
const std::vector<Allometry>& built_in_allometry();

/// CSV with the columns species, form (height or height_crown), a, b, sigma; trees, rmse_cm,
/// held_out_rmse_cm, held_out_bias_cm and source may be missing. Throws Error{input} naming the line.
std::vector<Allometry> parse_allometry(std::string_view csv, std::string_view file);
std::string allometry_as_csv(std::span<const Allometry> table);

}  // namespace waymark
