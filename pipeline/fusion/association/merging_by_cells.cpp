// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/merging_by_cells.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "core/bytes.hpp"
#include "pipeline/fusion/association/bucket_file.hpp"
#include "pipeline/fusion/association/cell_tree.hpp"
#include "pipeline/fusion/association/clustering.hpp"
#include "pipeline/fusion/association/observation_bytes.hpp"
#include "pipeline/fusion/association/observed_object_maker.hpp"
#include "pipeline/fusion/association/repeated_uids.hpp"
#include "pipeline/fusion/association/seams.hpp"

namespace waymark::pipeline {
namespace {

using Index = std::uint32_t;

constexpr std::size_t kSample = std::size_t{1} << 17;  // positions by which cells are chosen
constexpr std::size_t kMaxCells = 1024;                // more would need more buffers
constexpr std::size_t kInMemory = std::size_t{1} << 20;

/// Every `stride`-th position of a stream, at most kSample of them.
class PositionSample {
 public:
  void add(const Eigen::Vector3d& point) {
    if (count_++ % stride_ != 0) return;
    points_.push_back(point);
    if (points_.size() < kSample) return;
    for (std::size_t i = 0; 2 * i < points_.size(); ++i) points_[i] = points_[2 * i];
    points_.resize(points_.size() / 2);
    stride_ *= 2;
  }
  CellTree divide(std::size_t max_in_cell) && {
    const std::size_t in_cell = std::max(max_in_cell, count_ / kMaxCells);
    return CellTree(std::move(points_), std::max<std::size_t>(in_cell / stride_, 1));
  }

 private:
  std::vector<Eigen::Vector3d> points_;
  std::size_t count_ = 0, stride_ = 1;
};

CellTree divide(const ObservationStream& observations, const MapPlane& plane, std::size_t max_in_cell) {
  PositionSample sample;
  observations.visit([&](const std::vector<Observation>& batch) {
    for (const Observation& o : batch) sample.add(plane.to_cartesian(o.position.xyz.head<2>()));
  });
  return std::move(sample).divide(max_in_cell);
}

/// Object of a cell, or of its halo.
struct PlacedObject {
  ObservedObject object;
  CellObject where;
};

void object_layout(auto& io, auto& entry) {
  auto& s = entry.object;
  for (auto& v : s.at) io(v);
  for (auto& v : s.covariance.reshaped()) io(v);
  io(s.log_size), io(s.log_size_variance), io(s.direction), io(s.direction_variance);
  io(s.type), io(s.source), io(entry.where.cell), io(entry.where.index);
}

std::string encode_object(const PlacedObject& entry) {
  ByteWriter out;
  object_layout(out, entry);
  return out.take();
}

std::vector<PlacedObject> decode_objects(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<PlacedObject> entries;
  while (!in.at_end()) object_layout(in, entries.emplace_back());
  return entries;
}

/// Observations and their objects on disk, by cell.
class CellStore {
 public:
  CellStore(const CellTree& tree, const std::filesystem::path& scratch)
      : observations_(file(scratch), tree.count()),
        objects_(file(scratch), tree.count()),
        halo_(file(scratch), tree.count()),
        count_(tree.count()) {}

  void distribute(const ObservationStream& stream, CellTree& tree, const ObservedObjectMaker& make,
                  const MapPlane& plane, const AssociationRules& rules) {
    std::unordered_map<std::string, Index> sources;
    std::vector<double> reach(tree.count());
    stream.consume([&](std::vector<Observation>&& batch) {
      for (const Observation& o : batch) {
        const Index cell = tree.find(plane.to_cartesian(o.position.xyz.head<2>()));
        const Index index = count_[cell]++;
        observations_.add(cell, encode_observation(o));
        if (!o.rejected.empty()) continue;
        PlacedObject entry{make(o), {cell, index}};
        entry.object.source = sources.try_emplace(o.source, static_cast<Index>(sources.size())).first->second;
        reach[cell] = std::max(reach[cell], pair_reach(entry.object, plane, rules));
        objects_.add(cell, encode_object(entry));
      }
    });
    tree.set_reach(reach);
  }

  /// Gives each object to all other cells whose objects it may be a pair with.
  void exchange(const CellTree& tree, const MapPlane& plane, const AssociationRules& rules) {
    for (Index cell = 0; cell < tree.count(); ++cell)
      for (const PlacedObject& entry : decode_objects(objects_.read(cell))) {
        const auto give = [&](Index other) {
          if (other != cell) halo_.add(other, encode_object(entry));
        };
        tree.visit_near(plane.to_cartesian(entry.object.at), pair_reach(entry.object, plane, rules), give);
      }
  }

  std::vector<PlacedObject> objects_and_halo(Index cell) const {
    return decode_objects(objects_.read(cell) + halo_.read(cell));
  }
  std::vector<Observation> observations(Index cell) const {
    return decode_observations(observations_.read(cell));
  }

 private:
  static std::shared_ptr<ScratchFile> file(const std::filesystem::path& scratch) {
    return std::make_shared<ScratchFile>(scratch, kInMemory);
  }
  BucketFile observations_, objects_, halo_;
  std::vector<Index> count_;
};

/// Joins the groups of connected objects of a cell that reach into others.
void join_groups(Index cell, std::span<const PlacedObject> entries, const MapPlane& plane,
                 const AssociationRules& rules, Seams& seams) {
  std::vector<ObservedObject> objects;
  objects.reserve(entries.size());
  for (const PlacedObject& entry : entries) objects.push_back(entry.object);
  std::vector<Index> group(entries.size());
  std::iota(group.begin(), group.end(), Index{0});
  const auto root = [&](Index i) {
    while (group[i] != i) i = group[i] = group[group[i]];
    return i;
  };
  for (const auto& pairs : {candidate_pairs(objects, plane, rules), duplicate_pairs(objects, plane, rules)})
    for (const IndexPair& pair : pairs) {
      const Index a = root(pair.first), b = root(pair.second);
      group[std::max(a, b)] = std::min(a, b);
    }
  // Groups of own and foreign objects. Groups of foreign ones only are those of another cell.
  std::vector<char> has_own(entries.size()), has_foreign(entries.size());
  for (Index i = 0; i < entries.size(); ++i)
    (entries[i].where.cell == cell ? has_own : has_foreign)[root(i)] = 1;
  std::unordered_map<Index, std::vector<CellObject>> open;
  for (Index i = 0; i < entries.size(); ++i)
    if (const Index g = root(i); has_own[g] && has_foreign[g]) open[g].push_back(entries[i].where);
  for (const auto& [_, members] : open) seams.join(members);
}

using Rejections = std::map<std::string, std::int64_t>;

void count_rejections(Rejections& of_reason, std::int64_t& accepted, std::span<const Observation> all,
                      std::int64_t sign) {
  for (const Observation& o : all)
    if (o.rejected.empty())
      ++accepted;
    else
      of_reason[o.rejected] += sign;
}

/// Parts of a result under construction, of which the last cell comes first.
class PartsOfCells {
 public:
  PartsOfCells(const TypeRegistry& types, const Crs& crs, const std::filesystem::path& scratch)
      : landmarks_(std::make_shared<ScratchFile>(scratch, kInMemory)),
        evidence_(std::make_shared<ScratchFile>(scratch, kInMemory)),
        uids_(types, crs, std::make_shared<ScratchFile>(scratch, kInMemory)) {}

  void add(const MergedObservations& part) {
    uids_.add(count_++, part.landmarks);
    landmarks_.add(part.landmarks);
    evidence_.add(part.evidence);
  }
  void finish(MergedParts& result) {
    uids_.number(landmarks_, evidence_);
    result.landmarks = landmarks_.parts();
    result.evidence = evidence_.parts();
  }

 private:
  PartsWriter<std::vector<Landmark>> landmarks_;
  PartsWriter<std::vector<Observation>> evidence_;
  RepeatedUids uids_;
  Index count_ = 0;
};

}  // namespace

MergedParts merge_by_cells(const ObservationStream& stream, const TypeRegistry& types, const Crs& crs,
                           const MergeRules& rules, const CellRules& limits) {
  const MapPlane plane(crs);
  const ObservedObjectMaker make(types, rules);
  CellTree tree = divide(stream, plane, limits.max_in_cell);
  CellStore cells(tree, limits.scratch);
  cells.distribute(stream, tree, make, plane, rules.association);
  cells.exchange(tree, plane, rules.association);

  Seams seams;
  for (Index cell = 0; cell < tree.count(); ++cell)
    join_groups(cell, cells.objects_and_halo(cell), plane, rules.association, seams);
  const auto joined = seams.finish(tree.count());

  MergedParts result;
  PartsOfCells parts(types, crs, limits.scratch);
  BucketFile moved(std::make_shared<ScratchFile>(limits.scratch, kInMemory), tree.count());
  // A group is merged in its first cell, so the last cell has received all that it needs.
  for (Index cell = tree.count(); cell-- > 0;) {
    std::vector<Observation> own = cells.observations(cell);
    std::vector<char> leaves(own.size());
    for (const auto& [index, home] : joined[cell])
      if (home != cell) moved.add(home, encode_observation(own[index])), leaves[index] = 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < own.size(); ++i)
      if (!leaves[i]) {
        if (kept != i) own[kept] = std::move(own[i]);
        ++kept;
      }
    own.resize(kept);
    for (Observation& o : decode_observations(moved.read(cell))) own.push_back(std::move(o));
    moved.forget(cell);
    count_rejections(result.rejected, result.in, own, -1);
    const MergedObservations made = merge_observations(std::move(own), types, crs, rules);
    count_rejections(result.rejected, result.out, made.evidence, 1);
    parts.add(made);
    if (limits.progress) limits.progress(1 - static_cast<double>(cell) / tree.count());
  }
  parts.finish(result);
  return result;
}

}  // namespace waymark::pipeline
