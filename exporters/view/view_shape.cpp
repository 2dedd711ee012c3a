// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_shape.hpp"

#include "exporters/report/landmark_section.hpp"

namespace waymark::exporters {

std::string view_shape(const LandmarkType& type) {
  if (type.evidence == EvidenceModel::canopy) return "crown";
  switch (type.drawn_as) {
    case Solid::sphere:
      return "sphere";
    case Solid::cylinder:
      return "cylinder";
    case Solid::cone:
      return "cone";
    case Solid::bowl:
      return "bowl";
    case Solid::point:
      return "point";
  }
  return "point";
}

std::optional<std::size_t> height_of_shape(const LandmarkType& type) {
  return find_feature(type, type.drawn_as == Solid::bowl ? "depth" : "height");
}

}  // namespace waymark::exporters
