// SPDX-License-Identifier: Apache-2.0
#include "testbed/landing/crater_profile.hpp"

#include <algorithm>
#include <cmath>

#include "landmarks/crater_degradation.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPerDiameter = 96;  // samples of the stored profiles
constexpr double kSpacing = DiffusingCrater::kSpacing;
constexpr double kFar = 7;  // radii, where the solver ends
constexpr double kOldest = 0.6;

double sampled(const std::vector<double>& values, double at) {
  const double place = std::clamp(at / kSpacing, 0.0, double(values.size()) - 1.001);
  const auto i = static_cast<std::size_t>(place);
  return values[i] + (place - double(i)) * (values[i + 1] - values[i]);
}

}  // namespace

CraterProfiles::CraterProfiles() {
  DiffusingCrater crater(kFar);
  for (double age = 0; age < kOldest; age = age == 0 ? 5e-4 : age * 1.15) {
    crater.advance_to(age);
    const std::vector<double>& z = crater.heights();
    const auto crest = std::max_element(z.begin() + 25, z.end());
    const double rim = double(crest - z.begin()) * kSpacing;  // radii
    std::vector<float> heights;
    for (int i = 0; i <= kReach * kPerDiameter; ++i) {
      const double r = i / kPerDiameter;
      const double taper = std::clamp((kReach - r) / (0.4 * kReach), 0.0, 1.0);
      // Lengths and heights are rescaled from fresh to degraded diameters.
      heights.push_back(static_cast<float>(sampled(z, 2 * r * rim) / rim * taper * taper * (3 - 2 * taper)));
    }
    ages_.push_back(crater.time());
    depths_.push_back((*crest - z.front()) / rim);
    heights_.push_back(std::move(heights));
  }
}

const CraterProfiles& CraterProfiles::instance() {
  static const CraterProfiles profiles;
  return profiles;
}

double CraterProfiles::age(double depth) const {
  for (std::size_t i = 1; i < ages_.size(); ++i)
    if (depths_[i] < depth)
      return ages_[i] + (ages_[i - 1] - ages_[i]) *
                            std::clamp((depth - depths_[i]) / (depths_[i - 1] - depths_[i]), 0.0, 1.0);
  return ages_.back();
}

double CraterProfiles::row_of(double age) const {
  const auto after = std::upper_bound(ages_.begin(), ages_.end(), age);
  if (after == ages_.begin()) return 0;
  if (after == ages_.end()) return double(ages_.size()) - 1;
  const auto i = static_cast<std::size_t>(after - ages_.begin());
  return double(i) - 1 + (age - ages_[i - 1]) / (ages_[i] - ages_[i - 1]);
}

double CraterProfiles::depth(double age) const {
  const double row = row_of(age);
  const auto i = std::min(static_cast<std::size_t>(row), ages_.size() - 2);
  return std::lerp(depths_[i], depths_[i + 1], row - double(i));
}

double CraterProfiles::height(double age, double r) const {
  if (!(r < kReach)) return 0;
  const double row = row_of(age), column = r * kPerDiameter;
  const auto i = std::min(static_cast<std::size_t>(row), ages_.size() - 2);
  const auto j = std::min(static_cast<std::size_t>(column), heights_[0].size() - 2);
  const double p = row - double(i), q = column - double(j);
  return std::lerp(std::lerp(heights_[i][j], heights_[i][j + 1], q),
                   std::lerp(heights_[i + 1][j], heights_[i + 1][j + 1], q), p);
}

}  // namespace waymark::testbed
