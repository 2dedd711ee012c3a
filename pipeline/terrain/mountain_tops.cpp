// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/mountain_tops.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <unordered_map>

#include "landmarks/semantic_map.hpp"

namespace waymark::pipeline {
namespace {

AttributeValue known_or_null(double value) {
  return std::isnan(value) ? AttributeValue{} : AttributeValue{value};
}

// Returns the variance of a position uniform over the cell: side^2 / 12. The height's is unknown (NaN) unless
// the DEM states its deviation.
Eigen::Matrix3d cell_covariance(const Georeference& where, double latitude, double height_sd) {
  double width = where.dx * where.crs.metres_per_unit(), length = where.dy * where.crs.metres_per_unit();
  if (where.crs.kind() == CrsKind::geographic) {
    const double per_degree = where.crs.body().mean_radius() * kRadiansPerDegree;
    width = where.dx * per_degree * std::cos(latitude * kRadiansPerDegree);
    length = where.dy * per_degree;
  }
  const double height_variance = height_sd > 0 ? height_sd * height_sd : std::nan("");
  return Eigen::Vector3d(width * width / 12, length * length / 12, height_variance).asDiagonal();
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
    top.quality = {.seen = 1, .visible = 1, .feature_confidences = {}};
    top.quality.feature_confidences.resize(type_.features.size());
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
    if (std::isnan(summit.prominence_low)) return 1;  // no unknown terrain, and nothing is higher
    if (std::isnan(summit.prominence)) return 0.5;
    return std::clamp(summit.prominence_low / summit.prominence, 0.0, 1.0);
  }

  const DemSource& dem_;
  const Georeference& where_;
  const MountainTopOptions& options_;
  TypeId id_;
  const LandmarkType& type_;
};

/// Decides which summits become landmarks, and names them.
class SummitFilter {
 public:
  SummitFilter(std::span<const Summit> summits, std::span<const Isolation> isolations, const DemSource& dem,
               const TypeRegistry& types, const MountainTopOptions& options)
      : summits_(summits),
        isolations_(isolations),
        dem_(dem),
        type_(types[types.id("mountain_top")]),
        elevation_(type_.features[feature_index(type_, "elevation")]),
        options_(options) {
    if (cells_may_share_uids()) name_all(types);
  }

  /// Returns why a summit is left out; empty: it is kept.
  std::string reason_to_reject(std::size_t i) const {
    const auto& metres = isolations_[i].metres;
    if (metres && !(*metres >= options_.min_isolation.value)) return "isolation too small";
    if (const auto at = position(i); !dem_.in_area(at.xyz.x(), at.xyz.y()))
      return "outside the area of interest";
    if (!(summits_[i].height >= elevation_.min_value && summits_[i].height <= elevation_.max_value))
      return "elevation outside the range of the type";
    return "";
  }

  /// Returns the index of the first summit at or after a cell.
  std::size_t find(std::int64_t cell) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(summits_, cell, {}, &Summit::cell) -
                                    summits_.begin());
  }

  /// Returns the uid of the nearest ancestor that is kept; empty if there is none.
  std::string parent_uid(std::size_t i) const {
    for (std::int64_t parent = summits_[i].parent; parent >= 0;) {
      const std::size_t at = find(parent);
      if (at == summits_.size() || summits_[at].cell != parent) return "";
      if (reason_to_reject(at).empty()) return uid(at);
      parent = summits_[at].parent;
    }
    return "";
  }

  std::string uid(std::size_t i) const {
    const Crs& crs = dem_.geometry().where.crs;
    return uids_.empty() ? make_uid(type_, crs, position(i)) : uids_.at(i);
  }

 private:
  Point<MapCrs> position(std::size_t i) const {
    const GridGeometry& grid = dem_.geometry();
    return {{grid.where.x(static_cast<double>(summits_[i].cell % grid.columns)),
             grid.where.y(static_cast<double>(summits_[i].cell / grid.columns)), summits_[i].height}};
  }

  // Uids round positions to 1e-7 degrees or 1 cm.
  bool cells_may_share_uids() const {
    const Georeference& where = dem_.geometry().where;
    const bool degrees = where.crs.kind() == CrsKind::geographic;
    const double unit = degrees ? 1e-7 : 0.01 / where.crs.metres_per_unit();
    return std::min(where.dx, -where.dy) < 2 * unit;
  }

  void name_all(const TypeRegistry& types) {
    std::vector<Landmark> all;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < summits_.size(); ++i) {
      if (!reason_to_reject(i).empty()) continue;
      all.emplace_back().type = types.id("mountain_top");
      all.back().position = position(i);
      index.push_back(i);
    }
    assign_uids(types, dem_.geometry().where.crs, all);
    for (std::size_t k = 0; k < all.size(); ++k) uids_[index[k]] = all[k].uid;
  }

  std::span<const Summit> summits_;
  std::span<const Isolation> isolations_;
  const DemSource& dem_;
  const LandmarkType& type_;
  const FeatureSpec& elevation_;
  const MountainTopOptions& options_;
  std::unordered_map<std::size_t, std::string> uids_;  // only where cells may share one
};

}  // namespace

double expected_visibility(Meters prominence, Meters isolation, Meters body_radius, Meters range) {
  const double apart = std::min(isolation.value, range.value);
  if (!(prominence.value > 0) || !(apart > 0) || !(range.value > 0)) return 0;
  const double horizon = std::min(range.value, std::sqrt(2 * body_radius.value * prominence.value));
  const double free_length = std::sqrt(kSightLength * std::sqrt(prominence.value * apart));
  const double x = horizon / free_length;
  // 1 - (1 + x) exp(-x), without cancellation for small x
  const double fraction = x < 1e-4 ? x * x / 2 : 1 - (1 + x) * std::exp(-x);
  const double ratio = free_length / range.value;
  return std::clamp(2 * ratio * ratio * fraction, 0.0, 1.0);
}

MountainTops mountain_tops(std::span<const Summit> summits, std::span<const Isolation> isolations,
                           const DemSource& dem, const TypeRegistry& types, const MountainTopOptions& options,
                           const Window& window) {
  assert(summits.size() == isolations.size());
  assert(std::ranges::is_sorted(summits, {}, &Summit::cell));
  const SummitFilter filter(summits, isolations, dem, types, options);
  const TopMaker make(dem, types, options);
  const GridGeometry& grid = dem.geometry();
  MountainTops made;
  for (std::int64_t row = window.row; row < window.end_row(); ++row) {
    const std::size_t end = filter.find(grid.index(window.end_column() - 1, row) + 1);
    for (std::size_t i = filter.find(grid.index(window.column, row)); i < end; ++i) {
      if (const std::string reason = filter.reason_to_reject(i); !reason.empty()) {
        ++made.rejected[reason];
        continue;
      }
      Landmark& top = made.landmarks.emplace_back(make(summits[i], isolations[i]));
      top.uid = filter.uid(i);
      if (const std::string parent = filter.parent_uid(i); !parent.empty()) make.set_parent(top, parent);
    }
  }
  return made;
}

}  // namespace waymark::pipeline
