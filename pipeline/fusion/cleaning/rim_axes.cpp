// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/cleaning/rim_axes.hpp"

#include "pipeline/fusion/association/body_radius.hpp"

namespace waymark::pipeline {

std::optional<RimAxes> rim_axes(const Observation& bowl, const LandmarkType& type) {
  const auto body = body_radius(body_index(type), bowl.features);
  if (!body) return std::nullopt;
  RimAxes rim{2 * body->metres, 2 * body->metres};
  for (std::size_t i = 0; i < type.features.size() && i < bowl.features.size(); ++i) {
    const FeatureValue& f = bowl.features[i];
    if (!f.known()) continue;
    if (type.features[i].name == "major_axis") rim.major = f.value;
    if (type.features[i].name == "minor_axis") rim.minor = f.value;
    if (type.features[i].name == "orientation") rim.orientation = f.value;
  }
  return rim;
}

}  // namespace waymark::pipeline
