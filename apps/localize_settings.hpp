// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/filters/hypotheses.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/filters/particle_filter.hpp"
#include "localization/play_log.hpp"
namespace waymark {

/// All that --set of `waymark localize` changes.
struct LocalizeSettings {
  IdentificationOptions identification;
  KalmanOptions kalman;
  HypothesesOptions hypotheses;
  ParticleOptions particles;
  PlayOptions play;
  ScanLandmarks scans;
  SightOptions sight;
  double start_sd = 0.1, start_yaw_sd = 0.05;  ///< m, rad: how well --start is known

  void describe(OptionVisitor& option);
};

/// What shows a visitor all options that --set may change: those above and the method's own.
using DescribeOptions = std::function<void(OptionVisitor&)>;

/// Sets OPTION=VALUE. Throws Error{usage}: no such option (with the nearest name), a value out of range.
void set_option(const DescribeOptions& describe, const std::string& setting);

/// Each option with its value and what it does, a line each.
std::string options_as_text(const DescribeOptions& describe);

}  // namespace waymark
