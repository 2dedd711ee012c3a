// SPDX-License-Identifier: Apache-2.0
#include "testbed/score.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>

#include "testbed/score_match.hpp"

namespace waymark::testbed {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormal90 = 1.6448536;       // deviations that hold 90 % of errors, both sides
constexpr double kChiSquare90 = 4.605170186;  // of 2 degrees of freedom: -2 ln 0.1

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return kNan;
  std::sort(values.begin(), values.end());
  const double rank = fraction * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return std::lerp(values[below], values[above], rank - static_cast<double>(below));
}

ErrorSummary summary(const std::vector<double>& found, const std::vector<double>& truth, Scale scale) {
  std::vector<double> error, magnitude, relative, deviation;
  for (std::size_t i = 0; i < found.size(); ++i) {
    error.push_back(difference(found[i], truth[i], scale));
    magnitude.push_back(std::abs(error.back()));
    if (scale == Scale::ratio && truth[i] != 0) relative.push_back(found[i] / truth[i] - 1);
  }
  ErrorSummary s;
  s.count = static_cast<int>(found.size());
  s.bias = quantile(error, 0.5), s.absolute = quantile(magnitude, 0.5);
  s.relative_bias = quantile(relative, 0.5);
  for (const double r : relative) deviation.push_back(std::abs(r - s.relative_bias));
  s.relative_sd = 1.4826 * quantile(deviation, 0.5);
  return s;
}

using Claim = std::function<std::optional<double>(const EvaluatedObject&)>;

// Ten bins of claimed values, and the expected calibration error.
std::pair<std::vector<CalibrationBin>, double> calibration(std::span<const EvaluatedObject> found,
                                                           const std::vector<int>& match,
                                                           const Claim& claim) {
  std::vector<CalibrationBin> bins(10);
  int total = 0;
  for (std::size_t b = 0; b < bins.size(); ++b)
    bins[b].from = static_cast<double>(b) / 10, bins[b].to = static_cast<double>(b + 1) / 10;
  for (std::size_t f = 0; f < found.size(); ++f) {
    const auto value = claim(found[f]);
    if (!value || match[f] == -2) continue;
    auto& bin = bins[std::min<std::size_t>(9, static_cast<std::size_t>(std::clamp(*value, 0.0, 1.0) * 10))];
    ++bin.found, ++total;
    bin.mean += *value;
    bin.right += match[f] >= 0;
  }
  double error = 0;
  for (CalibrationBin& bin : bins) {
    if (bin.found == 0) continue;
    bin.mean /= bin.found;
    error += std::abs(bin.mean * bin.found - bin.right) / std::max(total, 1);
  }
  std::erase_if(bins, [](const CalibrationBin& bin) { return bin.found == 0; });
  return {bins, error};
}

// Area under the precision-recall curve, with precision interpolated as the maximum at this recall or above.
double average_precision(std::span<const EvaluatedObject> found, const std::vector<int>& match, int truth) {
  std::vector<std::pair<double, bool>> ranked;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (!found[f].confidence) return kNan;
    if (match[f] != -2) ranked.emplace_back(*found[f].confidence, match[f] >= 0);
  }
  if (truth == 0) return kNan;
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> precision;
  int right = 0, seen = 0;
  for (const auto& [_, is_right] : ranked) {
    ++seen;
    if (is_right) precision.push_back(static_cast<double>(++right) / seen);
  }
  double area = 0, best = 0;
  for (auto p = precision.rbegin(); p != precision.rend(); ++p) area += best = std::max(best, *p);
  return area / truth;
}

void count(Score& s, std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
           std::span<const double> edges) {
  for (std::size_t i = 0; i < edges.size(); ++i)
    s.by_size.push_back(
        {edges[i], i + 1 < edges.size() ? edges[i + 1] : std::numeric_limits<double>::infinity()});
  const auto each = [&](double diameter, const auto& change) {
    change(s.all);
    for (ScoreCounts& bin : s.by_size)
      if (diameter >= bin.from && diameter < bin.to) change(bin);
  };
  for (const EvaluatedObject& t : truth)
    if (!t.ignored) each(t.diameter, [](ScoreCounts& c) { ++c.truth; });
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (s.match[f] == -2) continue;
    if (s.match[f] >= 0)
      each(truth[at(s.match[f])].diameter, [](ScoreCounts& c) { ++c.found, ++c.matched; });
    else
      each(found[f].diameter, [](ScoreCounts& c) { ++c.found; });
  }
}

void measure_positions(Score& s, std::span<const EvaluatedObject> found,
                       std::span<const EvaluatedObject> truth) {
  std::vector<double> errors, shares, distances;
  double squares = 0;
  int inside = 0;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (s.match[f] < 0) continue;
    const EvaluatedObject& t = truth[at(s.match[f])];
    const Eigen::Vector2d error = found[f].at - t.at;
    errors.push_back(error.norm());
    squares += error.squaredNorm();
    if (t.diameter > 0) shares.push_back(error.norm() / t.diameter);
    if (!found[f].covariance || !(found[f].covariance->determinant() > 0)) continue;
    const double distance = error.dot(found[f].covariance->inverse() * error);
    ++s.with_covariance;
    distances.push_back(distance);
    inside += distance <= kChiSquare90;
  }
  s.position_median = quantile(errors, 0.5), s.position_p90 = quantile(errors, 0.9);
  s.position_rmse = errors.empty() ? kNan : std::sqrt(squares / static_cast<double>(errors.size()));
  s.relative_position_median = quantile(shares, 0.5);
  s.inside_90 = s.with_covariance ? static_cast<double>(inside) / s.with_covariance : kNan;
  s.nees =
      s.with_covariance ? std::accumulate(distances.begin(), distances.end(), 0.0) / s.with_covariance : kNan;
  s.nees_median = quantile(distances, 0.5);
}

void measure_features(Score& s, std::span<const EvaluatedObject> found,
                      std::span<const EvaluatedObject> truth, const std::map<std::string, Scale>& scales) {
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> values;
  std::map<std::string, std::vector<double>> normalized;  // errors in deviations
  const auto scale_of = [&](const std::string& name) {
    const auto scale = scales.find(name);
    return scale == scales.end() ? Scale::ratio : scale->second;
  };
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (s.match[f] < 0) continue;
    const EvaluatedObject& t = truth[at(s.match[f])];
    const auto add = [&](const std::string& name, double a, double b) {
      if (std::isfinite(a) && std::isfinite(b))
        values[name].first.push_back(a), values[name].second.push_back(b);
    };
    if (!found[f].features.contains("diameter") || !t.features.contains("diameter"))
      add("diameter", found[f].diameter, t.diameter);
    for (const auto& [name, value] : found[f].features)
      if (const auto other = t.features.find(name); other != t.features.end()) {
        add(name, value, other->second);
        const auto sd = found[f].deviations.find(name);
        if (sd != found[f].deviations.end() && std::isfinite(other->second))
          normalized[name].push_back(difference(value, other->second, scale_of(name)) / sd->second);
      }
  }
  for (const auto& [name, pair] : values) {
    ErrorSummary& e = s.features[name] = summary(pair.first, pair.second, scale_of(name));
    const std::vector<double>& errors = normalized[name];
    if (errors.empty()) continue;
    e.with_deviation = static_cast<int>(errors.size());
    const auto inside =
        std::ranges::count_if(errors, [](double error) { return std::abs(error) <= kNormal90; });
    e.inside_90 = static_cast<double>(inside) / static_cast<double>(errors.size());
  }
}

}  // namespace

double ScoreCounts::precision() const {
  return found ? static_cast<double>(matched) / found : kNan;
}
double ScoreCounts::recall() const {
  return truth ? static_cast<double>(matched) / truth : kNan;
}
double ScoreCounts::f1() const {
  return truth + found ? 2.0 * matched / (truth + found) : kNan;
}

Score score(std::span<const EvaluatedObject> found, std::span<const EvaluatedObject> truth,
            const MatchRules& rules, std::span<const double> size_edges) {
  std::vector<EvaluatedObject> things(truth.begin(), truth.end());
  for (EvaluatedObject& t : things) t.ignored = t.ignored || t.diameter < rules.min_diameter;
  const ObjectMatching pairing = match_objects(found, things, rules);
  Score s;
  s.match = pairing.truth_index;
  for (std::size_t f = 0; f < found.size(); ++f) {
    if (s.match[f] >= 0 && things[at(s.match[f])].ignored) s.match[f] = -2;
    if (s.match[f] != -1) continue;
    if (found[f].diameter < rules.min_diameter)
      s.match[f] = -2;
    else
      s.duplicates += pairing.near[f];
  }
  count(s, found, things, size_edges);
  s.average_precision = average_precision(found, s.match, s.all.truth);
  measure_positions(s, found, things);
  measure_features(s, found, things, rules.scales);
  std::tie(s.by_confidence, s.confidence_error) =
      calibration(found, s.match, [](const EvaluatedObject& f) { return f.confidence; });
  std::tie(s.by_quality, s.quality_error) =
      calibration(found, s.match, [](const EvaluatedObject& f) { return f.quality; });
  return s;
}

}  // namespace waymark::testbed
