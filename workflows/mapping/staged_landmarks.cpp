// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/staged_landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "core/error.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/hilbert_ranges.hpp"
#include "landmarks/semantic_map.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"

namespace waymark::workflows {
namespace {

using LandmarkCodec = pipeline::Codec<std::vector<Landmark>>;

constexpr std::size_t kBatch = 1000;                // landmarks that are stored together
constexpr std::size_t kPiece = 32;                  // landmarks of a part that are stored together
constexpr std::size_t kPart = 10'000;               // landmarks of a part, unless there are many
constexpr std::size_t kMaxParts = 256;              // which bounds the open pieces
constexpr std::size_t kInMemory = 4 * 1024 * 1024;  // bytes that need no file

/// FNV-1a.
std::uint64_t hash_of(TypeId type, std::string_view uid) {
  std::uint64_t hash = 14695981039346656037u ^ type;
  for (const char c : uid) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash == 0 ? 1 : hash;
}

/// Orders landmarks of a type and position.
bool before(const Landmark& a, const Landmark& b) {
  if (a.position.xyz.z() != b.position.xyz.z()) return a.position.xyz.z() < b.position.xyz.z();
  for (std::size_t i = 0; i < std::min(a.features.size(), b.features.size()); ++i)
    if (const double x = a.features[i].value, y = b.features[i].value; x < y || y < x) return x > y;
  return a.uid < b.uid;
}

/// Returns the values that occur more than once.
std::unordered_set<std::uint64_t> repeated(std::vector<std::uint64_t> values) {
  std::ranges::sort(values);
  std::unordered_set<std::uint64_t> found;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] == values[i - 1]) found.insert(values[i]);
  return found;
}

}  // namespace

StagedLandmarks::StagedLandmarks(TypeRegistry types, const std::filesystem::path& folder)
    : types_(std::move(types)), scratch_(folder, kInMemory) {}

void StagedLandmarks::add(Landmark&& landmark) {
  const auto row = static_cast<std::uint32_t>(keys_.size());
  keys_.push_back({landmark.position.xyz.x(), landmark.position.xyz.y(), row, landmark.type});
  if (!landmark.uid.empty()) {
    given_.resize(keys_.size());
    given_.back() = hash_of(landmark.type, landmark.uid);
  }
  batch_.push_back(std::move(landmark));
  if (batch_.size() == kBatch) store_batch();
}

void StagedLandmarks::store_batch() {
  batches_.push_back(scratch_.put(LandmarkCodec::encode(batch_)));
  batch_.clear();
}

void StagedLandmarks::visit(const std::function<void(Landmark&&, std::uint32_t)>& take) const {
  std::uint32_t row = 0;
  for (const Reader& read : batches_)
    for (Landmark& landmark : LandmarkCodec::decode(read())) take(std::move(landmark), row++);
}

/// Only landmarks at equal positions are read.
void StagedLandmarks::sort_keys() {
  std::ranges::sort(keys_, {}, [](const Key& k) { return std::tuple(k.type, k.x, k.y, k.row); });
  const auto equal = [](const Key& a, const Key& b) { return a.type == b.type && a.x == b.x && a.y == b.y; };
  std::unordered_map<std::uint32_t, Landmark> tied;
  for (std::size_t i = 1; i < keys_.size(); ++i)
    if (equal(keys_[i - 1], keys_[i])) tied[keys_[i - 1].row], tied[keys_[i].row];
  if (tied.empty()) return;
  visit([&](Landmark&& landmark, std::uint32_t row) {
    if (const auto found = tied.find(row); found != tied.end()) found->second = std::move(landmark);
  });
  for (auto begin = keys_.begin(); begin != keys_.end();) {
    const auto end = std::find_if(begin, keys_.end(), [&](const Key& key) { return !equal(*begin, key); });
    if (end - begin > 1)
      std::stable_sort(begin, end,
                       [&](const Key& a, const Key& b) { return before(tied.at(a.row), tied.at(b.row)); });
    begin = end;
  }
}

/// Returns the hashes of all uids by row, and fills suffixes_.
std::vector<std::uint64_t> StagedLandmarks::assign_final_uids(const Crs& crs) {
  const auto own_uid = [&](const Key& key) {
    return make_uid(types_[key.type], crs, Point<MapCrs>{{key.x, key.y, 0}});
  };
  std::vector<std::uint64_t> hashes(keys_.size());
  for (const Key& key : keys_) hashes[key.row] = hash_of(0, own_uid(key));
  const auto shared = repeated(hashes);
  std::unordered_map<std::uint64_t, int> taken;
  for (const Key& key : keys_) {
    if (!shared.contains(hashes[key.row])) continue;
    if (const int count = ++taken[hashes[key.row]]; count > 1) suffixes_[key.row] = count;
  }
  for (const Key& key : keys_) {
    std::uint64_t& hash = hashes[key.row];
    if (key.row < given_.size() && given_[key.row] != 0) {
      hash = given_[key.row];
      continue;
    }
    const auto suffix = suffixes_.find(key.row);
    hash = hash_of(key.type,
                   own_uid(key) + (suffix == suffixes_.end() ? "" : '-' + std::to_string(suffix->second)));
  }
  given_ = {};
  return hashes;
}

std::string StagedLandmarks::final_uid(Landmark& landmark, std::uint32_t row, const Crs& crs) const {
  if (!landmark.uid.empty()) return std::move(landmark.uid);
  const auto suffix = suffixes_.find(row);
  return make_uid(types_[landmark.type], crs, landmark.position) +
         (suffix == suffixes_.end() ? "" : '-' + std::to_string(suffix->second));
}

void StagedLandmarks::refuse_duplicates(const std::vector<std::uint64_t>& uids, const Crs& crs,
                                        const std::string& source) const {
  const auto shared = repeated(uids);
  if (shared.empty()) return;
  std::set<std::pair<TypeId, std::string>> seen;
  visit([&](Landmark&& landmark, std::uint32_t row) {
    if (!shared.contains(uids[row])) return;
    const auto [at, unique] = seen.emplace(landmark.type, final_uid(landmark, row, crs));
    if (!unique)
      throw Error(ErrorCode::input, fmt::format("two rows have the uid '{}'", at->second), source,
                  "correct the column, or leave it out: --columns uid=");
  });
}

/// Divides the landmarks of each type along a Hilbert curve, as write_map() does, so that a range of the
/// curve has few parts. Consumes the keys.
std::vector<std::uint32_t> StagedLandmarks::part_of_rows() {
  std::vector<geodb::Envelope> extents(types_.size());
  for (const Key& key : keys_) extents[key.type].add(key.x, key.y);
  for (Key& key : keys_) key.x = geodb::hilbert_position({key.x, key.y}, extents[key.type]);
  std::ranges::sort(keys_, {}, [](const Key& k) { return std::tuple(k.type, k.x, k.row); });
  const std::size_t size = std::max(kPart, keys_.size() / kMaxParts + 1);
  std::vector<std::uint32_t> part(keys_.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) part[keys_[i].row] = static_cast<std::uint32_t>(i / size);
  parts_.resize(keys_.empty() ? 0 : (keys_.size() - 1) / size + 1);
  keys_ = {};
  return part;
}

void StagedLandmarks::store_parts(const Crs& crs) {
  const std::vector<std::uint32_t> part = part_of_rows();
  std::vector<std::vector<Landmark>> open(parts_.size());
  const auto store = [&](std::size_t number) {
    if (!open[number].empty()) parts_[number].push_back(scratch_.put(LandmarkCodec::encode(open[number])));
    open[number].clear();
  };
  visit([&](Landmark&& landmark, std::uint32_t row) {
    landmark.uid = final_uid(landmark, row, crs);
    open[part[row]].push_back(std::move(landmark));
    if (open[part[row]].size() == kPiece) store(part[row]);
  });
  for (std::size_t number = 0; number < open.size(); ++number) store(number);
  batches_ = {};
  suffixes_ = {};
}

geodb::LandmarkParts StagedLandmarks::finish(const Crs& crs, const std::string& source) {
  store_batch();
  sort_keys();
  refuse_duplicates(assign_final_uids(crs), crs, source);
  store_parts(crs);
  geodb::LandmarkParts parts{.count = parts_.size()};
  parts.landmarks = [this](std::size_t number) {
    auto landmarks = std::make_shared<std::vector<Landmark>>();
    for (const Reader& read : parts_[number])
      for (Landmark& landmark : LandmarkCodec::decode(read())) landmarks->push_back(std::move(landmark));
    return std::shared_ptr<const std::vector<Landmark>>(std::move(landmarks));
  };
  parts.evidence = [](std::size_t) { return std::make_shared<const std::vector<Observation>>(); };
  return parts;
}

}  // namespace waymark::workflows
