// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <vector>
#include "localization/sighting.hpp"
namespace waymark {

/// Where a robot may be that sees this, in the map's frame.
struct FoundPoses {
  std::optional<PoseEstimate> sure;    ///< the one place it can be
  std::vector<PoseEstimate> possible;  ///< best first, the sure one too
  std::string_view reason = {};        ///< why none is sure
};

/// Answers "where am I?" without knowing anything but the map.
using PoseFinder = std::function<FoundPoses(const SightingSet&)>;

/// Whether a pose that was found is not the other one: more than a metre off, and more than both covariances
/// explain. That of the found one counts four times, as the finder does not know how odometry blurred what
/// is remembered.
bool are_apart(const PoseEstimate& found, const PoseEstimate& other);

}  // namespace waymark
