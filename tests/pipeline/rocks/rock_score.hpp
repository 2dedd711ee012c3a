// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "workflows/training/rock_training_data.hpp"
namespace waymark::test {
using namespace workflows;

/// Sums over scenes. Bins by true diameter: 2-3, 3-5, 5-8, above 8 px.
class RockScore {
 public:
  static constexpr int kBins = 4;
  void add(const RockImage& image, const std::vector<Detection>& found, double sun_angle);

  double recall(int bin) const { return ratio(hit_[bin], rocks_[bin]); }
  int rocks(int bin) const { return rocks_[bin]; }
  /// Of detections of 2 px and more; those that match a smaller rock count as right.
  double precision() const { return ratio(right_, right_ + wrong_); }
  struct Spread {
    double bias = 0, sd = 0;
  };
  Spread width(int bin) const { return spread(width_[bin]); }  ///< of D / true D - 1
  Spread reach(int bin) const { return spread(reach_[bin]); }
  double median_offset(int bin) const;  ///< px
  double ellipse_cover() const {
    return ratio(inside_, matched_);
  }  ///< fraction of errors in the 90 % ellipse
  double diameter_cover() const { return ratio(diameter_inside_, matched_); }  ///< within 1.645 sd
  double reach_cover() const { return ratio(reach_inside_, matched_); }
  double calibration_error() const;  ///< expected, ten bins of confidence
  /// Greatest difference of the cumulative numbers above D >= 3 px, as a share of the true number.
  double size_frequency_error() const;
  std::string text() const;

  std::vector<double> along_errors[kBins], across_errors[kBins];  ///< away from the sun and across it, px

 private:
  static double ratio(int a, int b) { return b > 0 ? static_cast<double>(a) / b : 0; }
  static Spread spread(const std::vector<double>& values);

  int rocks_[kBins] = {}, hit_[kBins] = {}, right_ = 0, wrong_ = 0, matched_ = 0, inside_ = 0;
  int diameter_inside_ = 0, reach_inside_ = 0;
  std::vector<double> width_[kBins], reach_[kBins], offset_[kBins];
  std::vector<std::pair<double, bool>> judged_;
  std::vector<double> true_sizes_, found_sizes_;
};

}  // namespace waymark::test
