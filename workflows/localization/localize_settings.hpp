// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "core/options/option_table.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/multi_hypothesis_filter.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/replay_log.hpp"
namespace waymark::workflows {

/// Settings that all methods share (--set of `waymark localize`).
struct LocalizeSettings {
  localization::IdentificationOptions identification;
  localization::KalmanOptions kalman;
  localization::MultiHypothesisOptions hypotheses;
  localization::ParticleOptions particles;
  localization::ReplayOptions play;
  localization::ScanDetectionOptions scans;
  localization::LineOfSightOptions sight;
  double start_sd = 0.1, start_yaw_sd = 0.05;  ///< m, rad: standard deviations of the start

  void describe(OptionVisitor& option);
  /// Throws Error{usage} if `distance=paper` cannot apply to all data association of the method.
  void check_distance(const std::string& method) const;
};

/// Sets OPTION=VALUE of the settings above or the method's own. Returns a warning if the option is given by
/// its former name. Throws Error{usage} for an unknown option (with the nearest name) or a value out of
/// range.
[[nodiscard]] std::vector<std::string> set_option(const DescribeOptions& describe,
                                                  const std::string& setting);

}  // namespace waymark::workflows
