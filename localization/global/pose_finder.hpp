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

}  // namespace waymark
