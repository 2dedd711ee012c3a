// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/loaded_map.hpp"

#include <unordered_map>

#include "geodb/map_store.hpp"
#include "geodb/shape_layer.hpp"
#include "geodb/validate_map.hpp"
#include "pipeline/fusion/valuation/landmark_fusion.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

constexpr const char* kStandIn = "map ";  // begins the source of a landmark that is its own observation

/// Returns the types of a map with the rules of existence of this program, which maps do not store.
TypeRegistry types_with_rules(const TypeRegistry& stored) {
  TypeRegistry types;
  for (LandmarkType type : stored) {
    if (const LandmarkType* known = all_types().find(type.name)) type.existence = known->existence;
    types.add(std::move(type));
  }
  return types;
}

std::unordered_map<std::string, int> count_evidence(const std::vector<Observation>& evidence) {
  std::unordered_map<std::string, int> counts;
  for (const Observation& seen : evidence)
    if (seen.rejected.empty()) ++counts[seen.landmark_uid];
  return counts;
}

}  // namespace

LoadedMap load_map(const std::filesystem::path& path) {
  geodb::check_before_copy(path);
  const geodb::MapStore store = geodb::MapStore::open(path);
  LoadedMap map;
  map.types = types_with_rules(store.types());
  map.crs = store.crs();
  for (const LandmarkType& type : store.types())
    store.visit(type.name, [&](Landmark&& landmark) { map.landmarks.push_back(std::move(landmark)); });
  map.evidence = store.observations();
  map.images = store.images();
  for (const std::string& name : geodb::shape_layers(path))
    map.layers.push_back(geodb::read_shape_layer(path, name));
  map.runs = store.runs();
  map.has_elevations = store.has_dem_coverage();
  const auto counts = count_evidence(map.evidence);
  for (const Landmark& landmark : map.landmarks)
    if (!counts.contains(landmark.uid))
      map.evidence.push_back(pipeline::as_observation(landmark, kStandIn + path.filename().string()));
  return map;
}

bool is_stand_in(const Observation& observation) {
  return !observation.pixel && observation.source.starts_with(kStandIn);
}

void drop_stand_ins(LoadedMap& map) {
  const auto counts = count_evidence(map.evidence);
  std::erase_if(map.evidence, [&](const Observation& seen) {
    return seen.rejected.empty() && is_stand_in(seen) && counts.at(seen.landmark_uid) == 1;
  });
}

}  // namespace waymark::workflows
