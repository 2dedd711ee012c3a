// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/mountain_tops.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "landmarks/uid.hpp"
#include "pipeline/terrain/visibility.hpp"

namespace waymark {
namespace {

AttributeValue known_or_null(double value) {
  return std::isnan(value) ? AttributeValue{} : AttributeValue{value};
}

// Variance of the summit's true place, uniform over its cell: side^2 / 12.
Eigen::Matrix3d cell_covariance(const Georeference& where, double latitude, double height_sd) {
  double width = where.dx * where.crs.metres_per_unit(), length = where.dy * where.crs.metres_per_unit();
  if (where.crs.kind() == CrsKind::geographic) {
    const double per_degree = where.crs.body().mean_radius() * kRadiansPerDegree;
    width = where.dx * per_degree * std::cos(latitude * kRadiansPerDegree);
    length = where.dy * per_degree;
  }
  return Eigen::Vector3d(width * width / 12, length * length / 12, height_sd * height_sd).asDiagonal();
}

class TopMaker {
 public:
  TopMaker(const DemSource& dem, const TypeRegistry& types, const MountainTopOptions& options)
      : dem_(dem),
        where_(dem.geometry().where),
        options_(options),
        id_(types.id("mountain_top")),
        type_(types[id_]) {}

  Landmark operator()(const Summit& summit, const Isolation& isolation) const {
    Landmark top;
    top.type = id_;
    top.position = {{x(summit.cell), y(summit.cell), summit.height}};
    top.covariance = cell_covariance(where_, y(summit.cell), dem_.height_sd());
    top.features.resize(type_.features.size());
    feature(top, "elevation", summit.height);
    feature(top, "prominence", summit.prominence);
    feature(top, "isolation", isolation.metres.value_or(Summit::kUnknown));
    top.attributes.resize(type_.attributes.size());
    attribute(top, "prominence_low", known_or_null(summit.prominence_low));
    if (isolation.metres_low) attribute(top, "isolation_low", *isolation.metres_low);
    if (summit.saddle >= 0) {
      attribute(top, "saddle_elevation", summit.saddle_height);
      attribute(top, "saddle_x", x(summit.saddle));
      attribute(top, "saddle_y", y(summit.saddle));
    }
    if (isolation.metres) {
      attribute(top, "higher_x", where_.x(isolation.higher.column));
      attribute(top, "higher_y", where_.y(isolation.higher.row));
    }
    attribute(top, "visibility", visibility(summit, isolation));
    top.quality = {.seen = 1, .visible = 1, .of_feature = {}};
    top.quality.of_feature.resize(type_.features.size());
    top.confidence = confidence(summit);
    return top;
  }

  void set_parent(Landmark& top, const std::string& uid) const { attribute(top, "parent_uid", uid); }

 private:
  double x(std::int64_t cell) const {
    const std::int64_t column = cell % dem_.geometry().columns;
    return where_.x(static_cast<double>(column));
  }
  double y(std::int64_t cell) const {
    const std::int64_t row = cell / dem_.geometry().columns;
    return where_.y(static_cast<double>(row));
  }

  void feature(Landmark& top, std::string_view name, double value) const {
    if (!std::isnan(value)) top.features[feature_index(type_, name)] = {value, 0, 1};
  }
  void attribute(Landmark& top, std::string_view name, AttributeValue value) const {
    top.attributes[attribute_index(type_, name)] = std::move(value);
  }

  AttributeValue visibility(const Summit& summit, const Isolation& isolation) const {
    const double radius = where_.crs.body().mean_radius();
    if (std::isnan(summit.prominence) || !(radius > 0)) return {};
    const double apart = isolation.metres.value_or(options_.visible_range.value);
    return expected_visibility({summit.prominence}, {apart}, {radius}, options_.visible_range);
  }

  static double confidence(const Summit& summit) {
    if (std::isnan(summit.prominence_low)) return 1;  // nothing is hidden, and nothing is higher
    if (std::isnan(summit.prominence)) return 0.5;
    return std::clamp(summit.prominence_low / summit.prominence, 0.0, 1.0);
  }

  const DemSource& dem_;
  const Georeference& where_;
  const MountainTopOptions& options_;
  TypeId id_;
  const LandmarkType& type_;
};

}  // namespace

std::vector<Landmark> mountain_tops(std::span<const Summit> summits, std::span<const Isolation> isolations,
                                    const DemSource& dem, const TypeRegistry& types,
                                    const MountainTopOptions& options) {
  assert(summits.size() == isolations.size());
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < summits.size(); ++i)
    if (!isolations[i].metres || *isolations[i].metres >= options.min_isolation.value) kept.push_back(i);
  std::ranges::sort(kept, {}, [&](std::size_t i) { return summits[i].cell; });

  const TopMaker make(dem, types, options);
  std::vector<Landmark> tops;
  for (const std::size_t i : kept) tops.push_back(make(summits[i], isolations[i]));
  assign_uids(types, dem.geometry().where.crs, tops);

  std::unordered_map<std::int64_t, std::size_t> top_at;
  for (std::size_t t = 0; t < kept.size(); ++t) top_at[summits[kept[t]].cell] = t;
  std::unordered_map<std::int64_t, std::int64_t> parent_of;
  for (const Summit& summit : summits) parent_of[summit.cell] = summit.parent;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    std::int64_t parent = summits[kept[t]].parent;
    while (parent >= 0 && !top_at.contains(parent)) {
      const auto next = parent_of.find(parent);
      parent = next == parent_of.end() ? -1 : next->second;
    }
    if (parent >= 0) make.set_parent(tops[t], tops[top_at[parent]].uid);
  }
  return tops;
}

}  // namespace waymark
