// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/cleaning/rejections.hpp"
#include "pipeline/fusion/cleaning/shaded_by_relief.hpp"

namespace waymark::pipeline {
namespace {

// Light of a sun above the horizon and not in the zenith.
std::optional<Eigen::Vector3d> towards(const Sun& sun) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  if (!(light.z() > 0) || !(light.head<2>().norm() > 1e-6)) return std::nullopt;
  return light;
}

std::optional<double> known_height(const Observation& o, const LandmarkType& type) {
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (type.features[i].name == "height" && o.features[i].known()) return o.features[i].value;
  return std::nullopt;
}

struct Caster {
  Observation* observation;
  SupposedRock rock;
  double reach = 0;  // metres, half the length of the shadow
};

std::vector<Caster> casters_of(std::span<Observation> observations, const TypeRegistry& types,
                               const Eigen::Vector3d& light, double metres_per_unit) {
  std::vector<Caster> casters;
  for (Observation& o : observations) {
    const LandmarkType& type = types[o.type];
    if (!o.rejected.empty() || type.evidence != EvidenceModel::shadow_caster) continue;
    const auto body = body_radius(body_index(type), o.features);
    if (!body) continue;
    const auto height = known_height(o, type);
    const double reach = height ? *height / (light.z() / light.head<2>().norm()) / 2 : body->metres;
    casters.push_back(
        {&o,
         {o.position.xyz.head<2>() * metres_per_unit, body->metres, height.value_or(body->metres)},
         reach});
  }
  return casters;
}

// Traces one ray from beyond the object itself, which a fine terrain may contain.
bool far_terrain_shades(const Caster& caster, const Terrain& terrain, const Eigen::Vector3d& light,
                        double min_distance_cells) {
  const double level = light.head<2>().norm(), radius = caster.rock.radius;
  const Eigen::Vector2d away = -light.head<2>() / level;
  const Eigen::Vector2d dark = caster.rock.foot + away * (radius / 2 + caster.reach);
  const auto height = terrain.height(dark.x(), dark.y());
  if (!height) return false;
  const double clear = std::max(min_distance_cells * std::max(terrain.step_x(), terrain.step_y()),
                                2 * (caster.reach + radius)) /
                       level;
  const Eigen::Vector3d start = Eigen::Vector3d(dark.x(), dark.y(), *height) + clear * light;
  const auto below = terrain.height(start.x(), start.y());
  const bool in_ground = below && *below > start.z();
  return in_ground || terrain.in_shadow({start}, {light});
}

}  // namespace

void reject_terrain_shadows(std::span<Observation> observations, const TypeRegistry& types,
                            const ImageView& image, const Terrain& terrain, double metres_per_unit,
                            const TerrainShadowRules& rules) {
  if (!image.sun) return;
  Sun higher = *image.sun;
  higher.elevation = higher.elevation + higher.sd;
  const auto light = towards(higher);
  if (!light) return;
  const std::vector<Caster> casters = casters_of(observations, types, *light, metres_per_unit);
  std::vector<SupposedRock> rocks;
  for (const Caster& caster : casters) rocks.push_back(caster.rock);
  const std::vector<char> explained = explained_by_relief(terrain, rocks, *light, rules.relief);
  for (std::size_t i = 0; i < casters.size(); ++i) {
    if (far_terrain_shades(casters[i], terrain, *light, rules.min_distance_cells))
      casters[i].observation->rejected = "in the terrain's shadow";
    else if (explained[i])
      casters[i].observation->rejected = "dark by the terrain's relief";
  }
}

}  // namespace waymark::pipeline
