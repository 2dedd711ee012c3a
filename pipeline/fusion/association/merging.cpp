// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/merging.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/reorder.hpp"
#include "landmarks/semantic_map.hpp"
#include "pipeline/fusion/association/clustering.hpp"
#include "pipeline/fusion/association/observed_object_maker.hpp"

namespace waymark::pipeline {
namespace {

using Index = std::uint32_t;

struct ObservedObjects {
  std::vector<ObservedObject> all;
  std::vector<Index> observation;  // of each
};

ObservedObjects observed_objects(std::span<const Observation> observations, const TypeRegistry& types,
                                 const MergeRules& rules) {
  const ObservedObjectMaker make(types, rules);
  std::map<std::string_view, Index> sources;  // by name, so numbers do not depend on the order
  for (const Observation& o : observations) sources.emplace(o.source, 0);
  Index next = 0;
  for (auto& [_, number] : sources) number = next++;

  ObservedObjects found;
  found.all.reserve(observations.size());
  found.observation.reserve(observations.size());
  for (Index i = 0; i < observations.size(); ++i) {
    const Observation& o = observations[i];
    if (!o.rejected.empty()) continue;
    ObservedObject s = make(o);
    s.source = sources.at(o.source);
    found.all.push_back(s);
    found.observation.push_back(i);
  }
  return found;
}

// Rejects the less confident of two observations of one source at the same position.
void reject_duplicates(ObservedObjects& seen, std::vector<Observation>& observations, const MapPlane& plane,
                       const AssociationRules& rules) {
  const auto pairs = duplicate_pairs(seen.all, plane, rules);
  if (pairs.empty()) return;
  // Most confident first: a rejected observation rejects no other.
  std::vector<std::vector<Index>> others(seen.all.size());
  std::vector<Index> order;
  for (const IndexPair& pair : pairs) {
    others[pair.first].push_back(pair.second), others[pair.second].push_back(pair.first);
    order.push_back(pair.first), order.push_back(pair.second);
  }
  const auto confidence = [&](Index i) { return observations[seen.observation[i]].confidence; };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) {
    return confidence(a) != confidence(b) ? confidence(a) > confidence(b) : a < b;
  });
  order.erase(std::unique(order.begin(), order.end()), order.end());
  std::vector<bool> out(seen.all.size(), false);
  for (const Index i : order)
    if (!out[i])
      for (const Index other : others[i]) out[other] = true;
  std::size_t kept = 0;
  for (Index i = 0; i < seen.all.size(); ++i) {
    if (out[i]) {
      observations[seen.observation[i]].rejected = "seen twice in one image";
      continue;
    }
    seen.all[kept] = seen.all[i];
    seen.observation[kept++] = seen.observation[i];
  }
  seen.all.resize(kept);
  seen.observation.resize(kept);
}

// Weights positions by inverse covariances; heights are included if all are known.
void merge_positions(Landmark& landmark, std::span<const Index> members, const ObservedObjects& seen,
                     std::span<const Observation> observations, const MapPlane& plane,
                     const MergeRules& rules) {
  const auto covariance_of = [&](Index m) {
    Eigen::Matrix3d c = observations[seen.observation[m]].covariance;
    c.topLeftCorner<2, 2>() = seen.all[m].covariance;
    if (!c.allFinite()) {  // unknown height: not used
      c.row(2).setZero(), c.col(2).setZero();
      c(2, 2) = 1;
    }
    c(2, 2) += rules.min_sd * rules.min_sd;
    return c;
  };
  const bool height_known = std::all_of(members.begin(), members.end(), [&](Index m) {
    return observations[seen.observation[m]].covariance.allFinite();
  });
  const Point<MapCrs>& origin = observations[seen.observation[members[0]]].position;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = covariance_of(members[0]), sharpest = covariance;
  for (const Index m : members.subspan(1)) {
    const Point<MapCrs>& p = observations[seen.observation[m]].position;
    Eigen::Vector3d apart;
    apart << plane.offset(origin.xyz.head<2>(), p.xyz.head<2>()), p.xyz.z() - origin.xyz.z();
    const Eigen::Matrix3d own = covariance_of(m);
    const Eigen::Matrix3d gain = covariance * (covariance + own).inverse();
    mean += gain * (apart - mean);
    covariance -= (gain * covariance).eval();
    covariance = (covariance + covariance.transpose()).eval() / 2;
    if (own.topLeftCorner<2, 2>().determinant() < sharpest.topLeftCorner<2, 2>().determinant())
      sharpest = own;
  }
  landmark.position.xyz << plane.translate(origin.xyz.head<2>(), mean.head<2>()), origin.xyz.z() + mean.z();
  landmark.covariance = (1 - rules.common_fraction) * covariance + rules.common_fraction * sharpest;
  if (!height_known) {
    landmark.covariance.row(2).setConstant(std::nan(""));
    landmark.covariance.col(2).setConstant(std::nan(""));
  }
}

FeatureSet merge_features(std::span<const Index> members, const ObservedObjects& seen,
                          std::span<const Observation> observations, const LandmarkType& type,
                          const MergeRules& rules) {
  FeatureSet merged(type.features.size());
  for (std::size_t f = 0; f < merged.size(); ++f) {
    std::vector<WeightedValue> values;
    std::vector<double> variances;
    for (const Index m : members) {
      const Observation& o = observations[seen.observation[m]];
      if (f >= o.features.size() || !o.features[f].known() || std::isnan(o.features[f].value)) continue;
      values.push_back({o.features[f].value, std::max(o.confidence, 1e-6)});
      variances.push_back(o.features[f].variance);
    }
    const bool given = std::all_of(variances.begin(), variances.end(), [](double v) { return v > 0; });
    if (rules.weights == FeatureWeights::precision && given)
      for (std::size_t i = 0; i < values.size(); ++i) values[i].weight /= variances[i];
    if (!values.empty()) merged[f] = merge(values, type.features[f].scale);
    if (values.size() == 1 && given) merged[f].variance = variances[0];  // as the observation states it
  }
  return merged;
}

Landmark merge_members(std::span<const Index> members, const ObservedObjects& seen,
                       std::span<const Observation> observations, const TypeRegistry& types,
                       const MapPlane& plane, const MergeRules& rules) {
  Landmark landmark;
  landmark.type = seen.all[members[0]].type;
  const LandmarkType& type = types[landmark.type];
  merge_positions(landmark, members, seen, observations, plane, rules);
  landmark.features = merge_features(members, seen, observations, type, rules);
  landmark.attributes.resize(type.attributes.size());
  landmark.quality.seen = static_cast<int>(members.size());
  landmark.quality.feature_confidences.resize(type.features.size());
  landmark.observations = static_cast<int>(members.size());
  return landmark;
}

std::vector<Observation> sort_by_content(std::vector<Observation> observations) {
  if (std::is_sorted(observations.begin(), observations.end(), comes_before)) return observations;
  std::vector<Index> order(observations.size());
  std::iota(order.begin(), order.end(), Index{0});
  tbb::parallel_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return comes_before(observations[a], observations[b]); });
  reorder(observations, std::move(order));
  return observations;
}

bool landmark_before(const Landmark& a, const Landmark& b) {
  const auto& p = a.position.xyz;
  const auto& q = b.position.xyz;
  return std::tie(a.type, p.x(), p.y(), p.z()) < std::tie(b.type, q.x(), q.y(), q.z());
}

}  // namespace

std::vector<std::uint32_t> associate(std::span<const Observation> observations, const TypeRegistry& types,
                                     const Crs& crs, const AssociationRules& rules) {
  MergeRules merging;
  merging.association = rules;
  const ObservedObjects seen = observed_objects(observations, types, merging);
  const std::vector<Index> first = cluster(seen.all, MapPlane(crs), rules);
  std::vector<Index> of(observations.size());
  std::iota(of.begin(), of.end(), Index{0});
  for (std::size_t i = 0; i < first.size(); ++i) of[seen.observation[i]] = seen.observation[first[i]];
  return of;
}

Landmark merge_as_one(std::span<const Observation> members, const TypeRegistry& types, const Crs& crs,
                      const MergeRules& rules) {
  const ObservedObjects seen = observed_objects(members, types, rules);
  std::vector<Index> all(seen.all.size());
  std::iota(all.begin(), all.end(), Index{0});
  return merge_members(all, seen, members, types, MapPlane(crs), rules);
}

MergedObservations merge_observations(std::vector<Observation> observations, const TypeRegistry& types,
                                      const Crs& crs, const MergeRules& rules) {
  observations = sort_by_content(std::move(observations));
  const MapPlane plane(crs);
  ObservedObjects seen = observed_objects(observations, types, rules);
  reject_duplicates(seen, observations, plane, rules.association);
  const std::vector<Index> thing = cluster(seen.all, plane, rules.association);

  // Members grouped by landmark, ascending.
  std::vector<Index> members(thing.size());
  std::iota(members.begin(), members.end(), Index{0});
  std::stable_sort(members.begin(), members.end(), [&](Index a, Index b) { return thing[a] < thing[b]; });
  std::vector<Index> starts;
  for (Index i = 0; i < members.size(); ++i)
    if (i == 0 || thing[members[i]] != thing[members[i - 1]]) starts.push_back(i);
  const std::size_t count = starts.size();
  starts.push_back(static_cast<Index>(members.size()));

  std::vector<Landmark> made(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const auto own = std::span<const Index>(members).subspan(starts[i], starts[i + 1] - starts[i]);
    made[i] = merge_members(own, seen, observations, types, plane, rules);
  });

  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return landmark_before(made[a], made[b]); });
  MergedObservations merged;
  reorder(made, order);
  merged.landmarks = std::move(made);
  assign_uids(types, crs, merged.landmarks);
  for (Index rank = 0; rank < count; ++rank)
    for (Index i = starts[order[rank]]; i < starts[order[rank] + 1]; ++i)
      observations[seen.observation[members[i]]].landmark_uid = merged.landmarks[rank].uid;
  merged.evidence = std::move(observations);
  return merged;
}

}  // namespace waymark::pipeline
