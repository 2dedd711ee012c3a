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
namespace waymark::testbed {

/// Detected or true object. Lengths in one unit (metres or pixels).
struct EvaluatedObject {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double diameter = std::numeric_limits<double>::quiet_NaN();  ///< NaN: unknown
  std::map<std::string, double> features;                      ///< compared by name if both have it
  std::map<std::string, double> deviations = {};               ///< of features of detections, 1 sigma
  std::optional<Eigen::Matrix2d> covariance;                   ///< of `at`, for detections
  std::optional<double> confidence, quality;                   ///< of detections
  bool ignored = false;  ///< true object that does not count; its matches are not false either
};

/// One-to-one matching of detections and true objects.
struct MatchRules {
  enum class By {
    /// Largest true object first: its nearest free detection within max(distance_fraction x diameter,
    /// min_distance), of
    /// similar size (`size_ratio`) if both sizes are known.
    distance,
    /// Most confident detection first: the free true object whose circle overlaps most, if intersection
    /// over union reaches `min_overlap`.
    overlap,
  };
  By by = By::distance;
  double distance_fraction = 0.75,
         min_distance =
             0;  ///< matching radius: fraction of the diameter, and minimum in the unit of positions
  double size_ratio = 2.5;  ///< 0: sizes are ignored
  double min_overlap = 0.5;
  std::map<std::string, Scale> scales = {};  ///< of features, for their errors; default ratio
  double min_diameter = 0;  ///< smaller true objects and smaller unmatched detections are ignored
};

/// Errors of a feature over the matched pairs.
struct ErrorSummary {
  int count = 0;
  double bias = 0;      ///< median of detected - true; errors of an axis are at most pi/2
  double absolute = 0;  ///< median of |detected - true|
  double relative_bias = 0, relative_sd = 0;  ///< of detected / true - 1: median; 1.4826 x median
                                              ///< deviation; NaN for features without a true zero
  int with_deviation = 0;  ///< pairs whose detection states the standard deviation of the feature
  double inside_90 = std::numeric_limits<double>::quiet_NaN();  ///< fraction of their errors within 1.645 sd
};

/// Counts of a range of diameters.
struct ScoreCounts {
  double from = 0, to = std::numeric_limits<double>::infinity();  ///< diameters
  int truth = 0, found = 0,
      matched = 0;  ///< found: matches by true diameter, false ones by their own

  double precision() const;  ///< NaN without detections
  double recall() const;     ///< NaN without truth
  double f1() const;
};

/// Bin of a reliability diagram: claimed confidence (or quality) and fraction correct.
struct CalibrationBin {
  double from = 0, to = 1, mean = 0;
  int found = 0, right = 0;
};

/// Result of an evaluation.
struct Score {
  ScoreCounts all;
  std::vector<ScoreCounts> by_size;
  double average_precision =
      std::numeric_limits<double>::quiet_NaN();  ///< over confidence; NaN: no confidences
  double position_median = 0, position_p90 = 0, position_rmse = 0;
  double relative_position_median = std::numeric_limits<double>::quiet_NaN();
  int with_covariance = 0;
  double inside_90 = 0;    ///< fraction of errors inside the 90 % ellipse of the reported covariance
  double nees = 0;         ///< mean squared Mahalanobis distance; 2 for consistent covariances
  double nees_median = 0;  ///< 1.39 for consistent covariances; a few wrong pairs hardly change it
  int duplicates =
      0;  ///< false detections within the matching radius of an already matched object of similar size
  std::map<std::string, ErrorSummary> features;  ///< "diameter": the feature, else that of the circle
  std::vector<CalibrationBin> by_confidence, by_quality;
  double confidence_error = 0, quality_error = 0;  ///< expected calibration error of the bins
  std::vector<int> match;  ///< per detection: index of its true object, -1 false, -2 ignored
};

/// Evaluates detections against truth. `size_edges` ascending: bins between them and beyond the last. O(n m
/// / cells).
Score score(std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
            const MatchRules& rules, std::span<const double> size_edges = {});

}  // namespace waymark::testbed
