// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/craters/score_circles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace waymark::test {
using namespace pipeline;
namespace {

// Quality of the match, higher is better; `std::nullopt` for different craters.
std::optional<double> fit(const CraterCandidate& a, const CraterCandidate& b, Match match) {
  if (match == Match::overlap) {
    const double common = overlap(a, b);
    return common >= 0.5 ? std::optional(common) : std::nullopt;
  }
  const double r = std::min(a.diameter, b.diameter) / 2;
  const double far = std::pow(std::hypot(a.x - b.x, a.y - b.y) / r, 2),
               differ = std::abs(a.diameter - b.diameter) / 2 / r;
  return far < 1.8 && differ < 1 ? std::optional(-far - differ) : std::nullopt;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::string CircleScore::text() const {
  return fmt::format(
      "F1 {:.3f} (P {:.3f}, R {:.3f}; {} + {} - {}), centre {:.3f} D, |dD| {:.3f}, bias {:+.3f}", f1,
      precision, recall, hits, false_alarms, misses, centre, size, bias);
}

CircleScore score_circles(std::vector<CraterCandidate> found, const std::vector<CraterCandidate>& truth,
                          double smallest, double largest, Match match) {
  sort_by_score(found);
  const auto counts = [&](const CraterCandidate& c) {
    return c.diameter >= smallest && c.diameter < largest;
  };
  std::vector<bool> taken(truth.size(), false);
  CircleScore score;
  std::vector<double> centres, sizes, biases;
  for (const CraterCandidate& c : found) {
    std::optional<double> best;
    std::size_t at = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (taken[i]) continue;
      const auto here = fit(c, truth[i], match);
      if (here && (!best || *here > *best)) best = here, at = i;
    }
    if (!best) {
      score.false_alarms += counts(c) ? 1 : 0;
      continue;
    }
    taken[at] = true;
    if (!counts(truth[at])) continue;
    ++score.hits;
    const double ratio = c.diameter / truth[at].diameter - 1;
    centres.push_back(std::hypot(c.x - truth[at].x, c.y - truth[at].y) / truth[at].diameter);
    sizes.push_back(std::abs(ratio));
    biases.push_back(ratio);
  }
  const auto all = static_cast<int>(std::count_if(truth.begin(), truth.end(), counts));
  score.misses = all - score.hits;
  score.precision = score.hits / std::max(1.0, double(score.hits + score.false_alarms));
  score.recall = score.hits / std::max(1.0, double(all));
  score.f1 = 2 * score.hits / std::max(1.0, double(2 * score.hits + score.false_alarms + score.misses));
  score.centre = median(centres), score.size = median(sizes), score.bias = median(biases);
  return score;
}

double calibration_error(std::vector<CraterCandidate> found, const std::vector<CraterCandidate>& truth,
                         double smallest) {
  sort_by_score(found);
  std::vector<bool> taken(truth.size());
  std::array<double, 10> excess{};  // sum of the scores - number of true ones, by tenth
  int count = 0;
  for (const CraterCandidate& c : found) {
    double best = 0.5;
    std::size_t at = truth.size();
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (const double o = overlap(c, truth[i]); !taken[i] && o >= best) best = o, at = i;
    const bool real = at < truth.size();
    if (real) taken[at] = true;
    if ((real ? truth[at].diameter : c.diameter) < smallest) continue;
    excess[static_cast<std::size_t>(std::min(9.0, 10 * c.score))] += c.score - real;
    ++count;
  }
  double sum = 0;
  for (const double e : excess) sum += std::abs(e);
  return count > 0 ? sum / count : 0;
}

}  // namespace waymark::test
