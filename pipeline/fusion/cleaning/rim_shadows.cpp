// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/association/map_plane.hpp"
#include "pipeline/fusion/association/neighbour_pairs.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"
#include "pipeline/fusion/cleaning/rim_axes.hpp"

namespace waymark::pipeline {
namespace {

struct Rim {
  Eigen::Vector2d at;                            // CRS units
  double major = 0, minor = 0, orientation = 0;  // semi-axes, metres; radians clockwise from north
};

std::optional<Rim> rim_of(const Observation& o, const LandmarkType& type) {
  const auto axes = rim_axes(o, type);
  if (!axes) return std::nullopt;
  return Rim{o.position.xyz.head<2>(), axes->major / 2, axes->minor / 2, axes->orientation};
}

// Returns the radius of the ellipse in a direction.
double radius_towards(const Rim& rim, const Eigen::Vector2d& east_north) {
  const Eigen::Vector2d major(std::sin(rim.orientation), std::cos(rim.orientation));
  const Eigen::Vector2d unit = east_north.normalized();
  const double along = unit.dot(major) / rim.major;
  const double across = (unit.x() * major.y() - unit.y() * major.x()) / rim.minor;
  return 1 / std::hypot(along, across);
}

}  // namespace

void reject_rim_shadows(std::span<Observation> observations, std::span<const Observation> craters,
                        const TypeRegistry& types, const std::map<std::string, Sun>& sun_of_image,
                        const Crs& crs, const RimShadowRules& rules) {
  const MapPlane plane(crs);
  std::vector<Rim> rims;
  std::vector<Observation*> rocks;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> reach;
  for (Observation& o : observations)
    if (o.rejected.empty() && types[o.type].evidence == EvidenceModel::shadow_caster &&
        sun_of_image.contains(o.source)) {
      rocks.push_back(&o);
      points.push_back(plane.to_cartesian(o.position.xyz.head<2>()));
      reach.push_back(0);
    }
  for (const Observation& o : craters) {
    if (!o.rejected.empty() || types[o.type].evidence != EvidenceModel::bowl) continue;
    if (o.confidence < rules.min_confidence) continue;
    const auto rim = rim_of(o, types[o.type]);
    if (!rim) continue;
    rims.push_back(*rim);
    points.push_back(plane.to_cartesian(rim->at));
    reach.push_back(rules.outer * std::max(rim->major, rim->minor));
  }
  const auto first_rim = static_cast<std::uint32_t>(rocks.size());
  const auto on_lit_rim = [&](std::uint32_t r, std::uint32_t c) {
    if (r >= first_rim || c < first_rim) return false;
    const Observation& rock = *rocks[r];
    const Rim& rim = rims[c - first_rim];
    const Eigen::Vector2d from_middle = plane.offset(rim.at, rock.position.xyz.head<2>());
    const double distance = from_middle.norm();
    if (!(distance > 0)) return false;
    const double fraction = distance / radius_towards(rim, from_middle);
    if (!(fraction >= rules.inner && fraction <= rules.outer)) return false;
    const auto body = body_radius(body_index(types[rock.type]), rock.features);
    if (body && body->metres < rules.min_fraction * std::sqrt(rim.major * rim.minor)) return false;
    const Eigen::Vector2d sun = sun_direction(sun_of_image.at(rock.source)).unit.head<2>().normalized();
    return from_middle.dot(sun) >= distance * std::cos(rules.half_angle);
  };
  for (const IndexPair& pair : find_neighbour_pairs(points, reach, on_lit_rim))
    rocks[pair.first]->rejected = "shadow of a crater's rim";
}

}  // namespace waymark::pipeline
