// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/repeated_uids.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/bytes.hpp"
#include "core/observation_order.hpp"
#include "landmarks/semantic_map.hpp"

namespace waymark::pipeline {
namespace {

constexpr std::size_t kBuckets = 256;
constexpr std::size_t kBuffered = std::size_t{8} << 20;

struct UidKey {
  std::uint64_t hash = 0;
  std::uint32_t part = 0, unused = 0;
};

/// Landmark whose uid others share.
struct Sharing {
  std::uint32_t part = 0;
  Landmark landmark;
  Observation first;  ///< of its evidence
};

bool stands_before(const Sharing& a, const Sharing& b) {
  const auto key = [](const Landmark& l) {
    return std::tuple(l.type, l.position.xyz.x(), l.position.xyz.y(), l.position.xyz.z());
  };
  if (key(a.landmark) != key(b.landmark)) return key(a.landmark) < key(b.landmark);
  return comes_before(a.first, b.first);
}

}  // namespace

RepeatedUids::RepeatedUids(const TypeRegistry& types, const Crs& crs, std::shared_ptr<ScratchFile> file)
    : types_(&types), crs_(crs), keys_(std::move(file), kBuckets, kBuffered) {}

std::uint64_t RepeatedUids::hash(const Landmark& landmark) const {
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const char c : make_uid((*types_)[landmark.type], crs_, landmark.position))
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash;
}

void RepeatedUids::add(std::uint32_t part, std::span<const Landmark> landmarks) {
  for (const Landmark& landmark : landmarks) {
    const UidKey key{hash(landmark), part, 0};
    add_value(keys_, key.hash >> 56, key);
  }
}

RepeatedUids::Found RepeatedUids::find() const {
  Found found;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    auto keys = read_values<UidKey>(keys_, bucket);
    std::ranges::sort(keys, {}, [](const UidKey& key) { return std::pair(key.hash, key.part); });
    for (std::size_t i = 1; i < keys.size(); ++i)
      if (keys[i].hash == keys[i - 1].hash && keys[i].part != keys[i - 1].part)
        found.hashes.insert(keys[i].hash);
    for (const UidKey& key : keys)
      if (found.hashes.contains(key.hash)) found.parts.insert(key.part);
  }
  return found;
}

void RepeatedUids::number(PartsWriter<std::vector<Landmark>>& landmarks,
                          PartsWriter<std::vector<Observation>>& evidence) const {
  const Found found = find();
  if (found.hashes.empty()) return;
  std::map<std::string, std::vector<Sharing>> of_uid;
  for (const std::uint32_t part : found.parts) {
    const std::vector<Observation> observations = evidence.parts().read(part);
    std::unordered_map<std::string_view, const Observation*> first;
    for (const Observation& o : observations)
      if (o.rejected.empty()) first.emplace(o.landmark_uid, &o);
    for (Landmark& landmark : landmarks.parts().read(part))
      if (found.hashes.contains(hash(landmark))) {
        const Observation& own = *first.at(landmark.uid);
        of_uid[make_uid((*types_)[landmark.type], crs_, landmark.position)].push_back(
            {part, std::move(landmark), own});
      }
  }
  std::map<std::uint32_t, std::unordered_map<std::string, std::string>> renamed;  // by part: old -> new
  for (auto& [uid, sharing] : of_uid) {
    std::ranges::sort(sharing, stands_before);
    for (std::size_t i = 0; i < sharing.size(); ++i)
      renamed[sharing[i].part][sharing[i].landmark.uid] = i == 0 ? uid : uid + '-' + std::to_string(i + 1);
  }
  for (const auto& [part, names] : renamed) {
    std::vector<Landmark> own = landmarks.parts().read(part);
    std::vector<Observation> seen = evidence.parts().read(part);
    const auto rename = [&new_names = names](std::string& uid) {
      if (const auto name = new_names.find(uid); name != new_names.end()) uid = name->second;
    };
    for (Landmark& landmark : own) rename(landmark.uid);
    for (Observation& o : seen) rename(o.landmark_uid);
    landmarks.replace(part, own);
    evidence.replace(part, seen);
  }
}

}  // namespace waymark::pipeline
