// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/join_maps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>

#include "landmarks/uid_index.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "workflows/mapping/joined_layers.hpp"
#include "workflows/mapping/map_changes.hpp"
#include "workflows/mapping/map_evidence.hpp"
#include "workflows/mapping/merged_types.hpp"
#include "workflows/mapping/unused_name.hpp"

namespace waymark::workflows {
namespace {

using Partners = std::vector<std::optional<std::size_t>>;  // per landmark of b: that of a

/// Renames images of `b` whose name has another image of `a`.
void rename_images(const LoadedMap& a, LoadedMap& b) {
  std::map<std::string, const geodb::ImageRecord*> known;
  for (const geodb::ImageRecord& image : a.images) known.emplace(image.name, &image);
  std::set<std::string> own;
  for (const geodb::ImageRecord& image : b.images) own.insert(image.name);
  std::map<std::string, std::string> renamed;
  for (geodb::ImageRecord& image : b.images) {
    const auto same = known.find(image.name);
    if (same == known.end() || *same->second == image) continue;
    const std::string name = unused_name(image.name, "-", [&](const std::string& candidate) {
      const auto other = known.find(candidate);
      geodb::ImageRecord as_named = image;
      as_named.name = candidate;
      return other == known.end() ? own.contains(candidate) : *other->second != as_named;
    });
    renamed[image.name] = name;
    image.name = name;
    own.insert(name);
  }
  for (Observation& seen : b.evidence)
    if (const auto to = renamed.find(seen.source); to != renamed.end()) seen.source = to->second;
}

/// Pairs landmarks of one uid that share an observation, or their position.
void pair_by_uid(const LoadedMap& a, const EvidenceByUid& of_a, const LoadedMap& b, const EvidenceByUid& of_b,
                 const ImagesOfTwo& images, Partners& partners) {
  const UidIndex index(a.landmarks);
  for (std::size_t j = 0; j < b.landmarks.size(); ++j) {
    const Landmark& other = b.landmarks[j];
    const auto i = index.find(other.uid);
    if (!i || a.landmarks[*i].type != other.type) continue;
    const Landmark& own = a.landmarks[*i];
    if (b.types[other.type].identifies_itself || own.position.xyz == other.position.xyz ||
        images.compare(own, of_a.of(own.uid), other, of_b.of(other.uid)).observations > 0)
      partners[j] = *i;
  }
}

/// Pairs the other landmarks by the association of the pipeline.
void pair_by_place(const LoadedMap& a, const LoadedMap& b, Partners& partners) {
  std::vector<bool> paired(a.landmarks.size());
  for (const auto& i : partners)
    if (i) paired[*i] = true;
  std::vector<Observation> seen;
  std::vector<std::size_t> landmark;
  const auto add = [&](const LoadedMap& map, const char* source, const auto& is_paired) {
    for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
      if (is_paired(i) || map.types[map.landmarks[i].type].identifies_itself) continue;
      seen.push_back(pipeline::as_observation(map.landmarks[i], source));
      landmark.push_back(i);
    }
  };
  add(a, "a", [&](std::size_t i) { return bool(paired[i]); });
  const std::size_t from_a = seen.size();
  add(b, "b", [&](std::size_t j) { return partners[j].has_value(); });
  const std::vector<std::uint32_t> first = pipeline::associate(seen, a.types, a.crs);
  for (std::size_t s = from_a; s < seen.size(); ++s)
    if (first[s] < from_a) partners[landmark[s]] = landmark[first[s]];
}

/// Returns whether two landmarks of one uid have the same values, wherever they come from.
bool same_values(const Landmark& a, const Landmark& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  if (a.uid != b.uid || a.position.xyz != b.position.xyz || a.confidence != b.confidence) return false;
  for (int k = 0; k < 9; ++k)
    if (!same(a.covariance(k), b.covariance(k))) return false;
  for (std::size_t f = 0; f < a.features.size(); ++f)
    if (!same(a.features[f].value, b.features[f].value) || a.features[f].variance != b.features[f].variance)
      return false;
  return true;
}

Landmark joined(const Landmark& own, const Landmark& other, const pipeline::CommonEvidence& common,
                std::size_t own_rows, std::size_t other_rows, bool other_is_newer, const LoadedMap& map,
                JoinRecord& record) {
  const auto shared = static_cast<std::size_t>(common.observations);
  const bool has_all = shared == other_rows, is_part = shared == own_rows;
  if (!has_all && !is_part && !same_values(own, other)) {
    ++record.fused;
    Landmark fused = pipeline::fuse_landmarks(own, other, common, map.types, map.crs);
    fused.observations = std::max(fused.observations, static_cast<int>(own_rows + other_rows - shared));
    return fused;
  }
  ++record.identical;
  if (has_all && is_part && !same_values(own, other)) return other_is_newer ? other : own;
  return !has_all && is_part ? other : own;
}

/// Rejects the observations of a landmark that stood elsewhere when they were made.
void reject_moved(LoadedMap& map, const std::string& uid) {
  for (Observation& seen : map.evidence)
    if (seen.rejected.empty() && seen.landmark_uid == uid) {
      seen.rejected = "landmark moved since";
      seen.landmark_uid.clear();
    }
}

/// Where the landmarks of a map are in the merged one, by uid.
using Places = std::unordered_map<std::string, std::size_t>;

Places places_of(const LoadedMap& map) {
  Places places;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) places.emplace(map.landmarks[i].uid, i);
  return places;
}

std::string uid_in(const std::vector<Landmark>& landmarks, const Places& places, const std::string& uid) {
  const auto place = places.find(uid);
  return place == places.end() ? std::string() : landmarks[place->second].uid;
}

void make_uids_unique(std::vector<Landmark>& landmarks) {
  std::unordered_set<std::string> all, taken;
  for (const Landmark& landmark : landmarks) all.insert(landmark.uid);
  for (Landmark& landmark : landmarks) {
    if (taken.contains(landmark.uid))
      landmark.uid =
          unused_name(landmark.uid, "-", [&](const std::string& uid) { return all.contains(uid); });
    taken.insert(landmark.uid);
    all.insert(landmark.uid);
  }
}

/// Returns the observations of both maps, each once; accepted, if one of the maps accepts it.
std::vector<Observation> join_evidence(LoadedMap& a, const Places& places_a, LoadedMap& b,
                                       const Places& places_b, const std::vector<Landmark>& landmarks) {
  std::set<ObservationKey> accepted, known;
  for (const LoadedMap* map : {&a, &b})
    for (const Observation& seen : map->evidence)
      if (seen.rejected.empty()) accepted.insert(key_of(seen));
  std::vector<Observation> all;
  const auto add = [&](LoadedMap& map, const Places& places) {
    for (Observation& seen : map.evidence) {
      if (!seen.rejected.empty() && accepted.contains(key_of(seen))) continue;
      if (!known.insert(key_of(seen)).second) continue;
      seen.landmark_uid = uid_in(landmarks, places, seen.landmark_uid);
      all.push_back(std::move(seen));
    }
  };
  add(a, places_a);
  add(b, places_b);
  return all;
}

void set_uids(geodb::ShapeLayer& layer, const std::vector<Landmark>& landmarks, const Places& places) {
  const auto uid = std::ranges::find(layer.columns, "uid", &AttributeSpec::name);
  if (uid == layer.columns.end()) return;
  const auto column = static_cast<std::size_t>(uid - layer.columns.begin());
  for (geodb::Shape& row : layer.rows)
    if (auto* text = std::get_if<std::string>(&row.values[column]))
      if (places.contains(*text)) *text = uid_in(landmarks, places, *text);
}

std::vector<geodb::RunRecord> join_runs(std::vector<geodb::RunRecord> a,
                                        const std::vector<geodb::RunRecord>& b) {
  for (const geodb::RunRecord& run : b)
    if (std::ranges::find(a, run) == a.end()) a.push_back(run);
  std::ranges::stable_sort(a, {}, &geodb::RunRecord::started_utc);
  return a;
}

}  // namespace

LoadedMap join_maps(LoadedMap a, LoadedMap b, bool b_is_later, JoinRecord& record) {
  const TypeRegistry types = merge_types(a.types, b.types);
  adopt_types(a, types);
  adopt_types(b, types);
  rename_images(a, b);
  const Places places_a = places_of(a);
  Places places_b = places_of(b);
  std::vector<Landmark> landmarks = a.landmarks;
  std::unordered_set<std::string> same;          // landmarks of b whose values a has, too
  std::set<std::pair<bool, std::string>> stale;  // of b or a: landmarks that moved since
  {
    const EvidenceByUid of_a(a), of_b(b);
    const ImagesOfTwo images(a, b);
    Partners partners(b.landmarks.size());
    pair_by_uid(a, of_a, b, of_b, images, partners);
    pair_by_place(a, b, partners);
    const bool b_is_newer = b.runs.size() > a.runs.size();
    record.partners = partners;
    record.places.clear();
    for (std::size_t j = 0; j < b.landmarks.size(); ++j) {
      const Landmark& other = b.landmarks[j];
      std::size_t& place = places_b.at(other.uid);
      if (!partners[j]) {
        place = landmarks.size();
        landmarks.push_back(other);
        continue;
      }
      place = *partners[j];
      const Landmark& own = a.landmarks[place];
      const auto &seen_a = of_a.of(own.uid), &seen_b = of_b.of(other.uid);
      const pipeline::CommonEvidence common = images.compare(own, seen_a, other, seen_b);
      if (a.types[own.type].identifies_itself && common.observations == 0 &&
          !same_place(own, other, a.types, a.crs)) {
        ++record.moved;
        if (b_is_later) landmarks[place] = other;
        stale.insert({!b_is_later, own.uid});
        continue;
      }
      landmarks[place] = joined(own, other, common, seen_a.size(), seen_b.size(), b_is_newer, a, record);
      if (same_values(own, other)) same.insert(other.uid);
    }
  }
  for (const auto& [of_b, uid] : stale) reject_moved(of_b ? b : a, uid);
  std::erase_if(b.evidence, [&](const Observation& seen) {
    return is_stand_in(seen) && same.contains(seen.landmark_uid);
  });
  make_uids_unique(landmarks);

  std::vector<Observation> evidence = join_evidence(a, places_a, b, places_b, landmarks);
  for (geodb::ShapeLayer& layer : a.layers) set_uids(layer, landmarks, places_a);
  for (geodb::ShapeLayer& layer : b.layers) {
    set_uids(layer, landmarks, places_b);
    add_layer(a.layers, std::move(layer));
  }
  std::set<std::string> names;
  for (const geodb::ImageRecord& image : a.images) names.insert(image.name);
  for (geodb::ImageRecord& image : b.images)
    if (!names.contains(image.name)) a.images.push_back(std::move(image));
  for (const Landmark& other : b.landmarks) record.places.push_back(places_b.at(other.uid));
  a.landmarks = std::move(landmarks);
  a.evidence = std::move(evidence);
  a.runs = join_runs(std::move(a.runs), b.runs);
  a.has_elevations = a.has_elevations || b.has_elevations;
  return a;
}

}  // namespace waymark::workflows
