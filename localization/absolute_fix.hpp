// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "localization/pose2.hpp"
namespace waymark {

/// A position measured from outside, e.g. by satellites.
struct GnssFix {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double sd = 1;  ///< m, of each coordinate
};

/// A heading measured from outside: compass, sun, stars.
struct HeadingFix {
  double yaw = 0, sd = 0.1;  ///< rad
};

/// What a filter makes of a fix.
struct FixUpdate {
  PoseEstimate estimate;   ///< Joseph form
  double squares = 0;      ///< v' S^-1 v before the update
  double log_density = 0;  ///< ln N(v; 0, S)
};
FixUpdate updated(const PoseEstimate& estimate, const GnssFix& fix);
FixUpdate updated(const PoseEstimate& estimate, const HeadingFix& fix);

/// Whether fixes are believed: a single wild one is left out, but what all of them say in turn is right.
class FixGate {
 public:
  /// `squares` of a fix of `rows` numbers. After `patience` rejections in a row the next is let in.
  bool pass(double squares, int rows);
  /// The last fix was let in although it contradicts: the filter should forget what it believed.
  bool overruled() const { return overruled_; }

 private:
  static constexpr int kPatience = 10;
  int rejected_ = 0;
  bool overruled_ = false;
};

}  // namespace waymark
