// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"

namespace waymark::pipeline {

void reject_terrain_shadows(std::span<Observation> observations, const TypeRegistry& types,
                            const ImageView& image, const Terrain& terrain, double metres_per_unit,
                            const TerrainShadowRules& rules) {
  if (!image.sun) return;
  Sun higher = *image.sun;
  higher.elevation = higher.elevation + higher.sd;
  const Eigen::Vector3d light = sun_direction(higher).unit;
  const double level = light.head<2>().norm();
  if (!(light.z() > 0) || !(level > 1e-6)) return;
  const Eigen::Vector2d away = -light.head<2>() / level;
  for (Observation& o : observations) {
    const LandmarkType& type = types[o.type];
    if (!o.rejected.empty() || type.evidence != EvidenceModel::shadow_caster) continue;
    const auto body = body_radius(body_index(type), o.features);
    if (!body) continue;
    double reach = body->metres;  // half of a shadow of unknown length
    for (std::size_t i = 0; i < type.features.size(); ++i)
      if (type.features[i].name == "height" && o.features[i].known())
        reach = o.features[i].value / (light.z() / level) / 2;
    const Eigen::Vector2d foot = o.position.xyz.head<2>() * metres_per_unit;
    const Eigen::Vector2d dark = foot + away * (body->metres / 2 + reach);
    const auto height = terrain.height(dark.x(), dark.y());
    if (!height) continue;
    // Starts beyond the object itself, which a fine terrain may contain.
    const double clear = std::max(rules.min_distance_cells * std::max(terrain.step_x(), terrain.step_y()),
                                  2 * (reach + body->metres)) /
                         level;
    const Eigen::Vector3d start = Eigen::Vector3d(dark.x(), dark.y(), *height) + clear * light;
    const auto below = terrain.height(start.x(), start.y());
    const bool in_ground = below && *below > start.z();
    if (in_ground || terrain.in_shadow({start}, {light})) o.rejected = "in the terrain's shadow";
  }
}

}  // namespace waymark::pipeline
