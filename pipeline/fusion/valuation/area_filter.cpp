// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/valuation/area_filter.hpp"

#include <set>
#include <string>

namespace waymark::pipeline {

std::int64_t remove_outside(std::vector<Landmark>& landmarks, std::vector<Observation>& evidence,
                            const std::function<bool(double x, double y)>& in_area) {
  std::set<std::string> outside;
  for (const Landmark& landmark : landmarks)
    if (!in_area(landmark.position.xyz.x(), landmark.position.xyz.y())) outside.insert(landmark.uid);
  if (outside.empty()) return 0;
  std::erase_if(landmarks, [&](const Landmark& landmark) { return outside.contains(landmark.uid); });
  for (Observation& o : evidence)
    if (outside.contains(o.landmark_uid)) o.rejected = kOutsideArea, o.landmark_uid.clear();
  return static_cast<std::int64_t>(outside.size());
}

}  // namespace waymark::pipeline
