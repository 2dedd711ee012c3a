// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <span>
#include <string>
#include <vector>
namespace waymark::inline core {

/// Scale of measurement of a feature. The paper's formulas give wrong values if it is ignored.
enum class Scale {
  ratio,      ///< has a true zero: radius, height
  interval,   ///< zero is a convention: elevation above a datum
  axis,       ///< undirected axis, period pi, radians: the long axis of an ellipse
  direction,  ///< directed, period 2 pi, radians: the normal of a wall
};

/// Declaration of one feature of a landmark type. Values outside [min_value, max_value] are implausible.
struct FeatureSpec {
  std::string name;  ///< column name in the map: lower case, underscores
  std::string unit;  ///< "m", "rad", "" for pure numbers
  Scale scale = Scale::ratio;
  double min_value = -std::numeric_limits<double>::infinity();
  double max_value = std::numeric_limits<double>::infinity();
  std::string summary;  ///< one line for the user
  /// Interval, axis and direction: spread at which a value carries no information (see core/quality.hpp).
  double reference = 0;
};

/// Merged feature. An unknown value is NaN with observations = 0.
struct FeatureValue {
  double value = std::numeric_limits<double>::quiet_NaN();
  double variance = 0;  ///< of the observations, not of their mean; 0 for a single observation
  int observations = 0;

  bool known() const { return observations > 0; }
};

/// One value per FeatureSpec of the type, in the order of the specs.
using FeatureSet = std::vector<FeatureValue>;

/// One observation of a feature.
struct WeightedValue {
  double value = 0;
  double weight = 1;  ///< detection quality q(d), > 0
};

/// Merges the observations of one feature of one landmark (Rossmann et al., eq. 3).
/// - The variance is the weighted spread about the merged value, unbiased for equal weights.
/// - The variance of a single observation is 0 and carries no information about confidence.
/// - Departure from the paper: axes are averaged as doubled angles, so 1 and 179 degrees give 0 and not 90.
/// - Directions are averaged as unit vectors.
/// - The merged axis lies in (-pi/2, pi/2], the direction in (-pi, pi]. If the vectors cancel, it is the
///   first value.
FeatureValue merge(std::span<const WeightedValue> seen, Scale scale);

/// Returns the angle after which values of a scale repeat, radians; 0 for a scale that is no angle.
double period(Scale scale);

/// Returns whether values of a scale are angles, which turn with the frame that they are given in.
inline bool is_angle(Scale scale) {
  return scale == Scale::axis || scale == Scale::direction;
}

/// Returns a - b; for an axis or a direction the smallest signed angle between both, radians.
double difference(double a, double b, Scale scale);

}  // namespace waymark::inline core
