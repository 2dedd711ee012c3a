// SPDX-License-Identifier: Apache-2.0
#include "localization/drive_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark::localization {
namespace {

double quantile(const std::vector<double>& sorted, double p) {
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 == sorted.size()) return sorted[i];
  return sorted[i] + (at - static_cast<double>(i)) * (sorted[i + 1] - sorted[i]);
}

/// Returns the largest k for which fewer than k of n values lie below the median with probability 0.025.
std::size_t rank_of_low_bound(std::size_t n) {
  double term = std::pow(0.5, static_cast<double>(n)), below = term;
  std::size_t k = 0;
  while (below <= 0.025 && k < n) {
    ++k;
    term *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    below += term;
  }
  return k;
}

}  // namespace

SpreadOverDrives spread_over_drives(std::vector<double> values) {
  std::ranges::sort(values);
  SpreadOverDrives spread{.median = quantile(values, 0.5),
                          .min = values.front(),
                          .max = values.back(),
                          .low = values.front(),
                          .high = values.back()};
  if (const std::size_t k = rank_of_low_bound(values.size()); k > 0)
    spread.low = values[k - 1], spread.high = values[values.size() - k];
  return spread;
}

std::vector<TrackErrorAt> track_errors(const Track& track, std::span<const StampedPose> truth,
                                       double max_gap) {
  std::vector<TrackErrorAt> errors;
  std::optional<double> begin;
  for (const TrackRow& row : track.rows) {
    const auto pose = pose_at(truth, row.t, max_gap);
    if (!pose) continue;
    if (!begin) begin = row.t;
    errors.push_back({row.t - *begin, (row.at.pose.at() - pose->at()).norm(),
                      std::sqrt(row.at.covariance(0, 0) + row.at.covariance(1, 1))});
  }
  return errors;
}

std::vector<ErrorBand> error_bands(std::span<const std::vector<TrackErrorAt>> drives, std::size_t bins) {
  double end = 0;
  for (const auto& drive : drives)
    if (!drive.empty()) end = std::max(end, drive.back().t);
  const double width = std::max(end, 1e-9) / static_cast<double>(bins);
  std::vector<std::vector<double>> errors(bins), sds(bins);
  for (const auto& drive : drives) {
    std::vector<double> error(bins), sd(bins), rows(bins);
    for (const TrackErrorAt& row : drive) {
      const std::size_t bin = std::min(bins - 1, static_cast<std::size_t>(row.t / width));
      error[bin] += row.error, sd[bin] += row.sd, ++rows[bin];
    }
    for (std::size_t i = 0; i < bins; ++i)
      if (rows[i] > 0) errors[i].push_back(error[i] / rows[i]), sds[i].push_back(sd[i] / rows[i]);
  }
  std::vector<ErrorBand> bands;
  for (std::size_t i = 0; i < bins; ++i) {
    if (errors[i].empty()) continue;
    std::ranges::sort(errors[i]);
    std::ranges::sort(sds[i]);
    bands.push_back({.t = (static_cast<double>(i) + 0.5) * width,
                     .drives = errors[i].size(),
                     .p5 = quantile(errors[i], 0.05),
                     .p25 = quantile(errors[i], 0.25),
                     .median = quantile(errors[i], 0.5),
                     .p75 = quantile(errors[i], 0.75),
                     .p95 = quantile(errors[i], 0.95),
                     .claimed = quantile(sds[i], 0.5)});
  }
  return bands;
}

}  // namespace waymark::localization
