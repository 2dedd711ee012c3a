// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <span>
#include <string>
#include <vector>
namespace waymark {

/// What arithmetic a feature allows. The paper's formulas fail in silence where this is ignored.
enum class Scale {
  ratio,     ///< has a true zero: radius, height
  interval,  ///< zero is a convention: elevation above a datum
  axis,      ///< direction without a head, period pi, radians: the long axis of an ellipse
};

/// Declares one feature of a landmark type. Values outside [lowest, highest] are implausible.
struct FeatureSpec {
  std::string name;  ///< column name in the map: lower case, underscores
  std::string unit;  ///< "m", "rad", "" for pure numbers
  Scale scale = Scale::ratio;
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  std::string summary;  ///< one line for people
  double reference =
      0;  ///< interval and axis: the spread at which a value says nothing (see core/quality.hpp)
};

/// A merged feature. An absent value is NaN with observations = 0.
struct FeatureValue {
  double value = std::numeric_limits<double>::quiet_NaN();
  double variance = 0;  ///< of the observations, not of their mean; 0 where one observation gives no spread
  int observations = 0;

  bool known() const { return observations > 0; }
};

/// One value per FeatureSpec of the type, in the order of the specs.
using FeatureSet = std::vector<FeatureValue>;

struct WeightedValue {
  double value = 0;
  double weight = 1;  ///< detection quality q(d), > 0
};

/// Merges the observations of one feature of one landmark (Rossmann et al., eq. 3).
/// The variance is the weighted spread about the merged value, unbiased for equal weights; it is 0 for a
/// single observation, which therefore says nothing about confidence.
/// Departure from the paper: an `axis` is averaged as a doubled angle, so 1 and 179 degrees give 0 and not
/// 90; the result lies in (-pi/2, pi/2]. An axis whose doubled angles cancel has no mean: the first value is
/// kept.
FeatureValue merge(std::span<const WeightedValue> seen, Scale scale);

/// a - b as the scale understands it: the shortest way round for an axis.
double difference(double a, double b, Scale scale);

}  // namespace waymark
