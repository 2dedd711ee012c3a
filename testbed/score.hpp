// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "core/feature.hpp"
namespace waymark {

/// A thing found, or a true one. Lengths in one unit (metres, or pixels).
struct ScoredThing {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double diameter = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
  std::map<std::string, double> features;                      ///< compared by name where both have one
  std::optional<Eigen::Matrix2d> covariance;                   ///< of `at`, where found
  std::optional<double> confidence, quality;                   ///< of what was found
  bool ignored = false;  ///< a true thing nobody is blamed for missing; what matches it is not false either
};

/// How found things and true ones are paired, one to one.
struct MatchRules {
  enum class By {
    /// Largest true thing first, its nearest free find within max(share x diameter, least); of like size
    /// (`size_ratio`) where both sizes are known.
    distance,
    /// Most confident find first, the free true thing whose circle overlaps most, if intersection over union
    /// reaches `least_overlap`.
    overlap,
  };
  By by = By::distance;
  double share = 0.75, least = 0;  ///< the least in the unit of the places
  double size_ratio = 2.5;         ///< 0: sizes do not matter
  double least_overlap = 0.5;
  std::map<std::string, Scale> scales = {};  ///< of features, for their errors; ratio where not named
  double min_diameter = 0;  ///< smaller true things are ignored, smaller finds without a match too
};

/// Errors of a number over the matched pairs.
struct ErrorSummary {
  int count = 0;
  double bias = 0;                            ///< median of found - true; an axis errs by pi/2 at most
  double absolute = 0;                        ///< median of |found - true|
  double relative_bias = 0, relative_sd = 0;  ///< of found / true - 1: median; 1.4826 x median
                                              ///< deviation; NaN where no zero is true
};

struct ScoreCounts {
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< diameters
  int truth = 0, found = 0,
      matched = 0;  ///< found: matched, by their true diameter, and false ones by their own

  double precision() const;  ///< NaN without finds
  double recall() const;     ///< NaN without truth
  double f1() const;
};

/// Finds by what they claim: how many of a confidence (or quality) are right.
struct CalibrationBin {
  double from = 0, to = 1, mean = 0;
  int found = 0, right = 0;
};

struct Score {
  ScoreCounts all;
  std::vector<ScoreCounts> by_size;
  double average_precision = std::numeric_limits<double>::quiet_NaN();  ///< over confidence; NaN: none told
  double position_median = 0, position_p90 = 0, position_rmse = 0;
  double position_median_of_diameter = std::numeric_limits<double>::quiet_NaN();
  int with_covariance = 0;
  double inside_90 = 0;  ///< share of errors inside the 90 % ellipse of the covariance told
  double nees = 0;       ///< mean squared Mahalanobis distance; 2 where covariances are honest
  int doubled =
      0;  ///< false finds inside the match radius of a true thing of like size that another has taken
  std::map<std::string, ErrorSummary> features;  ///< "diameter" too
  std::vector<CalibrationBin> by_confidence, by_quality;
  double confidence_error = 0, quality_error = 0;  ///< expected calibration error of the bins
  std::vector<int> match;  ///< per find: index of its true thing, -1 false, -2 ignored
};

/// Compares. `size_edges` ascending: bins between them and beyond the last. O(n m / cells).
Score score(std::span<const ScoredThing> found, std::span<const ScoredThing> truth, const MatchRules& rules,
            std::span<const double> size_edges = {});

}  // namespace waymark
