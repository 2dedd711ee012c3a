// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/staged_landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "core/error.hpp"
#include "geodb/hilbert_ranges.hpp"
#include "landmarks/semantic_map.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"

namespace waymark::workflows {
namespace {

using LandmarkCodec = pipeline::Codec<std::vector<Landmark>>;

constexpr std::size_t kBatch = 1000;                       // landmarks that are stored together
constexpr std::size_t kPiece = 32;                         // landmarks of a part that are stored together
constexpr std::size_t kPart = 10'000;                      // landmarks of a part, unless there are many
constexpr std::size_t kMaxParts = 256;                     // about; it bounds the open pieces
constexpr std::size_t kInMemory = 1024 * 1024;             // bytes that need no file
constexpr std::size_t kBuckets = 256;                      // by the first byte of a hash
constexpr std::size_t kBuffered = 1024 * 1024;             // bytes of all buckets
constexpr std::uint32_t kBins = 65536, kBinWidth = 65536;  // of a Hilbert curve

/// FNV-1a.
std::uint64_t hash_of(TypeId type, std::string_view uid) {
  std::uint64_t hash = 14695981039346656037u ^ type;
  for (const char c : uid) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash == 0 ? 1 : hash;
}

/// Orders landmarks of a type and position. Unknown values come last.
bool before(const Landmark& a, const Landmark& b) {
  const auto known = [](double value) {
    return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
  };
  if (a.position.xyz.z() != b.position.xyz.z()) return a.position.xyz.z() < b.position.xyz.z();
  for (std::size_t i = 0; i < std::min(a.features.size(), b.features.size()); ++i)
    if (const double x = known(a.features[i].value), y = known(b.features[i].value); x != y) return x > y;
  return a.uid < b.uid;
}

/// Orders the keys of a bucket by type, position and row.
void sort_keys(auto& keys) {
  std::ranges::sort(keys, {}, [](const auto& k) { return std::tuple(k.type, k.x, k.y, k.row); });
}

/// Calls `take` with the begin and end of each run of several sorted keys at one position.
void visit_tied(auto& keys, const auto& take) {
  const auto equal = [](const auto& a, const auto& b) {
    return a.type == b.type && a.x == b.x && a.y == b.y;
  };
  for (auto begin = keys.begin(); begin != keys.end();) {
    const auto end = std::find_if(begin, keys.end(), [&](const auto& key) { return !equal(*begin, key); });
    if (end - begin > 1) take(begin, end);
    begin = end;
  }
}

/// Adds the values of a bucket that occur more than once.
void add_repeated(std::vector<std::uint64_t> values, std::unordered_set<std::uint64_t>& found) {
  std::ranges::sort(values);
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] == values[i - 1]) found.insert(values[i]);
}

}  // namespace

StagedLandmarks::StagedLandmarks(TypeRegistry types, const std::filesystem::path& folder)
    : types_(std::move(types)),
      scratch_(std::make_shared<pipeline::ScratchFile>(folder, kInMemory)),
      curves_(types_.size()) {}

void StagedLandmarks::add(Landmark&& landmark) {
  if (++count_ > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::input, "more than 4,294,967,295 landmarks", "", "import the table in parts");
  curves_.at(landmark.type).extent.add(landmark.position.xyz.x(), landmark.position.xyz.y());
  batch_.push_back(std::move(landmark));
  if (batch_.size() == kBatch) store_batch();
}

void StagedLandmarks::store_batch() {
  batches_.push_back(scratch_->put(LandmarkCodec::encode(batch_)));
  batch_.clear();
}

void StagedLandmarks::visit(const std::function<void(Landmark&&, std::uint32_t)>& take) const {
  std::uint32_t row = 0;
  for (const Reader& read : batches_)
    for (Landmark& landmark : LandmarkCodec::decode(read())) take(std::move(landmark), row++);
}

/// Returns the keys of all landmarks in buckets, so that those of one uid are together, and fills the counts
/// of the curves.
pipeline::BucketFile StagedLandmarks::make_keys(const Crs& crs) {
  pipeline::BucketFile keys(scratch_, kBuckets, kBuffered);
  visit([&](Landmark&& landmark, std::uint32_t row) {
    const Eigen::Vector3d& at = landmark.position.xyz;
    Key key{at.x(), at.y(), 0, 0, row, landmark.type};
    key.uid = hash_of(0, make_uid(types_[landmark.type], crs, Point<MapCrs>{{at.x(), at.y(), 0}}));
    if (!landmark.uid.empty()) key.given = hash_of(landmark.type, landmark.uid);
    pipeline::add_value(keys, key.uid >> 56, key);
    Curve& curve = curves_[landmark.type];
    curve.counts.resize(kBins);
    ++curve.counts[geodb::hilbert_position(at.head<2>(), curve.extent) / kBinWidth];
  });
  return keys;
}

/// Returns the landmarks at positions that several share.
StagedLandmarks::OfRow StagedLandmarks::read_tied(const pipeline::BucketFile& all) const {
  OfRow tied;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    auto keys = pipeline::read_values<Key>(all, bucket);
    sort_keys(keys);
    visit_tied(keys, [&](auto begin, auto end) {
      for (; begin != end; ++begin) tied[begin->row];
    });
  }
  if (!tied.empty())
    visit([&](Landmark&& landmark, std::uint32_t row) {
      if (const auto found = tied.find(row); found != tied.end()) found->second = std::move(landmark);
    });
  return tied;
}

/// Fills the suffixes, and refuses two landmarks of a type with the same uid.
void StagedLandmarks::number_uids(const Crs& crs, const std::string& source) {
  const pipeline::BucketFile all = make_keys(crs);
  const OfRow tied = read_tied(all);
  pipeline::BucketFile uids(scratch_, kBuckets, kBuffered);
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    auto keys = pipeline::read_values<Key>(all, bucket);
    sort_keys(keys);
    visit_tied(keys, [&](auto begin, auto end) {
      std::stable_sort(begin, end,
                       [&](const Key& a, const Key& b) { return before(tied.at(a.row), tied.at(b.row)); });
    });
    std::unordered_map<std::uint64_t, int> taken;
    for (const Key& key : keys) {
      const int count = ++taken[key.uid];
      if (count > 1) suffixes_[key.row] = count;
      const std::uint64_t uid =
          key.given != 0 ? key.given
                         : hash_of(key.type, made_uid(key.type, {{key.x, key.y, 0}}, key.row, crs));
      pipeline::add_value(uids, uid >> 56, uid);
    }
  }
  std::unordered_set<std::uint64_t> repeated;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket)
    add_repeated(pipeline::read_values<std::uint64_t>(uids, bucket), repeated);
  if (repeated.empty()) return;
  std::set<std::pair<TypeId, std::string>> seen;
  visit([&](Landmark&& landmark, std::uint32_t row) {
    const std::string uid = final_uid(landmark, row, crs);
    if (!repeated.contains(hash_of(landmark.type, uid))) return;
    if (!seen.emplace(landmark.type, uid).second)
      throw Error(ErrorCode::input, fmt::format("two rows have the uid '{}'", uid), source,
                  "correct the column, or leave it out: --columns uid=");
  });
}

std::string StagedLandmarks::made_uid(TypeId type, const Point<MapCrs>& position, std::uint32_t row,
                                      const Crs& crs) const {
  const auto suffix = suffixes_.find(row);
  return make_uid(types_[type], crs, position) +
         (suffix == suffixes_.end() ? "" : '-' + std::to_string(suffix->second));
}

std::string StagedLandmarks::final_uid(const Landmark& landmark, std::uint32_t row, const Crs& crs) const {
  return landmark.uid.empty() ? made_uid(landmark.type, landmark.position, row, crs) : landmark.uid;
}

/// Divides the landmarks of each type along a Hilbert curve, as write_map() does, so that a range of the
/// curve has few parts.
void StagedLandmarks::divide_curves() {
  const std::size_t size = part_size();
  std::size_t population = 0, number = 0;
  for (Curve& curve : curves_) {
    curve.first_parts.resize(curve.counts.size());
    for (std::size_t bin = 0; bin < curve.counts.size(); ++bin) {
      const std::size_t count = curve.counts[bin];
      if (population > 0 && population + count > size) population = 0, ++number;
      curve.first_parts[bin] = static_cast<std::uint32_t>(number);
      population += count;
      while (population > size) population -= size, ++number;  // one bin in several parts
    }
    std::ranges::fill(curve.counts, 0u);  // from now on, of the landmarks that next_part() has had
  }
  parts_.resize(number + (population > 0 ? 1 : 0));
}

std::size_t StagedLandmarks::part_size() const {
  return std::max(kPart, count_ / kMaxParts + 1);
}

std::size_t StagedLandmarks::next_part(const Landmark& landmark) {
  Curve& curve = curves_[landmark.type];
  const auto bin = geodb::hilbert_position(landmark.position.xyz.head<2>(), curve.extent) / kBinWidth;
  return curve.first_parts[bin] + curve.counts[bin]++ / part_size();
}

void StagedLandmarks::store_parts(const Crs& crs) {
  divide_curves();
  std::vector<std::vector<Landmark>> open(parts_.size());
  const auto store = [&](std::size_t number) {
    if (!open[number].empty()) parts_[number].push_back(scratch_->put(LandmarkCodec::encode(open[number])));
    open[number].clear();
  };
  visit([&](Landmark&& landmark, std::uint32_t row) {
    landmark.uid = final_uid(landmark, row, crs);
    const std::size_t number = next_part(landmark);
    open[number].push_back(std::move(landmark));
    if (open[number].size() == kPiece) store(number);
  });
  for (std::size_t number = 0; number < open.size(); ++number) store(number);
  batches_ = {}, suffixes_ = {}, curves_ = {};
}

geodb::LandmarkParts StagedLandmarks::finish(const Crs& crs, const std::string& source) {
  store_batch();
  number_uids(crs, source);
  store_parts(crs);
  geodb::LandmarkParts parts{.count = parts_.size()};
  parts.landmarks = [this](std::size_t number) {
    auto landmarks = std::make_shared<std::vector<Landmark>>();
    for (const Reader& read : parts_[number])
      for (Landmark& landmark : LandmarkCodec::decode(read())) landmarks->push_back(std::move(landmark));
    return std::shared_ptr<const std::vector<Landmark>>(std::move(landmarks));
  };
  return parts;
}

}  // namespace waymark::workflows
