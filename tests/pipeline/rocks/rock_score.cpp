// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/rocks/rock_score.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
namespace waymark::test {
namespace {

int bin_of(double diameter) {
  return diameter < 2 ? -1 : diameter < 3 ? 0 : diameter < 5 ? 1 : diameter < 8 ? 2 : 3;
}

}  // namespace

void RockScore::add(const RockImage& image, const std::vector<Detection>& found, double sun_angle) {
  const RockMatch match = match_rocks(image, found, sun_angle);
  for (std::size_t i = 0; i < image.rocks.size(); ++i) {
    const auto& rock = image.rocks[i];
    const int bin = bin_of(rock.diameter);
    if (!match.rock_counts[i]) continue;
    true_sizes_.push_back(rock.diameter);
    if (bin < 0) continue;
    ++rocks_[bin];
    if (match.detection_of[i] < 0) continue;
    ++hit_[bin];
    const Detection& d = found[static_cast<std::size_t>(match.detection_of[i])];
    const Eigen::Vector2d error{d.outline.x - rock.x, d.outline.y - rock.y};
    const Eigen::Vector2d away{-std::cos(sun_angle), -std::sin(sun_angle)};
    width_[bin].push_back(d.outline.diameter() / rock.diameter - 1);
    reach_[bin].push_back(d.shadow_reach->value / rock.reach - 1);
    offset_[bin].push_back(error.norm());
    along_errors[bin].push_back(error.dot(away));
    across_errors[bin].push_back(error.y() * away.x() - error.x() * away.y());
    ++matched_;
    inside_ += error.dot(d.covariance.inverse() * error) < 4.605;  // chi^2 of 2 degrees of freedom, 90 %
    diameter_inside_ += std::abs(d.outline.diameter() - rock.diameter) < 1.645 * d.diameter_sd;
    reach_inside_ += std::abs(d.shadow_reach->value - rock.reach) < 1.645 * d.shadow_reach->sd;
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    if (!match.detection_counts[j]) continue;
    const bool right = match.rock_of[j] >= 0;
    judged_.emplace_back(found[j].confidence, right);
    found_sizes_.push_back(found[j].outline.diameter());
    if (found[j].outline.diameter() < 2 && !right) continue;
    ++(right ? right_ : wrong_);
  }
}

RockScore::Spread RockScore::spread(const std::vector<double>& values) {
  if (values.empty()) return {};
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, std::sqrt(squares / static_cast<double>(values.size()))};
}

double RockScore::median_offset(int bin) const {
  auto values = offset_[bin];
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double RockScore::calibration_error() const {
  double sum[10] = {}, right[10] = {}, count[10] = {};
  for (const auto& [confidence, ok] : judged_) {
    const int bin = std::min(9, static_cast<int>(confidence * 10));
    sum[bin] += confidence;
    right[bin] += ok;
    ++count[bin];
  }
  double error = 0;
  for (int bin = 0; bin < 10; ++bin) error += std::abs(sum[bin] - right[bin]);
  return judged_.empty() ? 0 : error / static_cast<double>(judged_.size());
}

double RockScore::size_frequency_error() const {
  double worst = 0;
  for (double d = 3; d < 8; d *= 1.1) {
    const auto above = [&](const std::vector<double>& sizes) {
      return static_cast<double>(std::count_if(sizes.begin(), sizes.end(), [&](double s) { return s >= d; }));
    };
    const double truth = above(true_sizes_);
    if (truth >= 50) worst = std::max(worst, std::abs(above(found_sizes_) - truth) / truth);
  }
  return worst;
}

std::string RockScore::text() const {
  std::string out;
  char line[256];
  for (int bin = 0; bin < kBins; ++bin) {
    static constexpr const char* kName[] = {"2-3", "3-5", "5-8", ">8 "};
    const Spread w = width(bin), h = reach(bin);
    std::snprintf(line, sizeof line,
                  "  %s px: %4d rocks, recall %.3f, width %+6.1f%% sd %4.1f%%, height %+6.1f%% sd %4.1f%%, "
                  "off %.2f px (along %+.2f sd %.2f, across sd %.2f)\n",
                  kName[bin], rocks_[bin], recall(bin), 100 * w.bias, 100 * w.sd, 100 * h.bias, 100 * h.sd,
                  median_offset(bin), spread(along_errors[bin]).bias, spread(along_errors[bin]).sd,
                  spread(across_errors[bin]).sd);
    out += line;
  }
  std::snprintf(line, sizeof line,
                "  precision %.3f (%d wrong), 90%% cover %.2f, D cover %.2f, reach cover %.2f, ECE %.3f, "
                "size-frequency %.3f\n",
                precision(), wrong_, ellipse_cover(), diameter_cover(), reach_cover(), calibration_error(),
                size_frequency_error());
  return out + line;
}

}  // namespace waymark::test
