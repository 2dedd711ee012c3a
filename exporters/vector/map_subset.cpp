// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/map_subset.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/rotate_axes.hpp"
#include "exporters/vector/reproject.hpp"
#include "geo/axes_rotation.hpp"

namespace waymark::exporters {
namespace {

void reproject(std::vector<geodb::ImageRecord>& images, const Crs& from, const Crs& to) {
  if (from.same_as(to)) return;
  const CrsTransform transform(from, to);
  for (geodb::ImageRecord& image : images) {
    if (image.sun_azimuth && !image.footprint.empty()) {
      const Eigen::Vector2d& at = image.footprint.front().front();
      const Radians turn{axes_rotation(transform, from, to, at.x(), at.y())};
      image.sun_azimuth->value = std::fmod(image.sun_azimuth->value - to_degrees(turn).value + 720, 360);
    }
    for (auto& ring : image.footprint)
      for (Eigen::Vector2d& corner : ring) {
        const auto there = transform(corner.x(), corner.y());
        corner = {there.x, there.y};
      }
  }
}

/// Landmarks and observations of some types in another CRS, read from a map range by range.
class SubsetReader {
 public:
  SubsetReader(const geodb::MapStore& map, const TypeRegistry& types, const LandmarkChoice& chosen,
               const Crs& crs)
      : map_(&map), types_(types), chosen_(chosen), crs_(crs) {
    if (!map.crs().same_as(crs)) transform_.emplace(map.crs(), crs);
    for (TypeId id = 0; id < types.size(); ++id)
      for (const geodb::MapStore::RowRange& rows : map.row_ranges(types[id].name, kRows))
        ranges_.push_back({id, rows});
  }

  std::size_t parts() const { return ranges_.size(); }

  Reprojected landmarks(std::size_t part) const {
    const auto& [id, rows] = ranges_[part];
    const LandmarkType& type = types_[id];
    std::vector<Landmark> found;
    map_->visit(type.name, rows, [&, type_id = id](Landmark&& landmark) {
      if (!is_chosen(landmark)) return;
      landmark.type = type_id;
      found.push_back(std::move(landmark));
    });
    return exporters::reproject(std::move(found), type, map_->crs(), crs_);
  }

  /// Landmarks of a type that are chosen, and those of them without a position in the CRS.
  struct Count {
    std::int64_t kept = 0, lost = 0;
  };
  Count count(TypeId type) const {
    Count all;
    if (!leaves_out()) return {map_->count(types_[type].name), 0};
    for (std::size_t part = 0; part < parts(); ++part)
      if (ranges_[part].first == type)
        visit_chosen(part, [&](const Landmark&, bool has_place) { ++(has_place ? all.kept : all.lost); });
    return all;
  }

  std::vector<Observation> evidence(std::size_t part) const {
    std::vector<Observation> found;
    const auto& [id, rows] = ranges_[part];
    std::unordered_set<std::string> uids;  // of the landmarks that are kept
    if (leaves_out())
      visit_chosen(part, [&](const Landmark& landmark, bool has_place) {
        if (has_place) uids.insert(landmark.uid);
      });
    map_->visit_observations(types_[id].name, rows, [&](Observation&& seen) {
      if ((!leaves_out() || uids.contains(seen.landmark_uid)) && keep(seen)) found.push_back(std::move(seen));
    });
    return found;
  }

  /// Returns the rejected observations. Those of landmarks that are not in the map are left out.
  std::vector<Observation> rejected() const {
    std::vector<Observation> found;
    map_->visit_rejected([&](Observation&& seen) {
      if (!seen.landmark_uid.empty()) {
        const auto landmark = map_->find(seen.landmark_uid);
        if (!landmark || !is_chosen(*landmark)) return;
      } else if (!is_inside(seen)) {
        return;
      }
      if (keep(seen)) found.push_back(std::move(seen));
    });
    return found;
  }

 private:
  static constexpr std::int64_t kRows = 10'000;  // of a part

  bool leaves_out() const { return transform_ || chosen_.inside || chosen_.min_confidence > 0; }

  /// Visits the chosen landmarks of a part with whether each has a position in the CRS.
  template <class Visit>
  void visit_chosen(std::size_t part, const Visit& visit) const {
    const auto& [id, rows] = ranges_[part];
    map_->visit(types_[id].name, rows, [&](Landmark&& landmark) {
      if (!is_chosen(landmark)) return;
      const Eigen::Vector3d& at = landmark.position.xyz;
      const auto there = transform_ ? (*transform_)(at.x(), at.y()) : CrsTransform::XY{at.x(), at.y()};
      visit(landmark, std::isfinite(there.x) && std::isfinite(there.y));
    });
  }

  /// Takes a landmark or an observation in the CRS of the map.
  template <class Item>
  bool is_inside(const Item& item) const {
    return !chosen_.inside || chosen_.inside(item.position.xyz.x(), item.position.xyz.y());
  }

  bool is_chosen(const Landmark& landmark) const { return is_inside(landmark) && chosen_.likely(landmark); }

  bool keep(Observation& seen) const {
    const std::string& type = map_->types()[seen.type].name;
    if (types_.find(type) == nullptr) return false;
    seen.type = types_.id(type);
    if (transform_) {
      const Eigen::Vector3d& at = seen.position.xyz;
      rotate_axes(seen, types_[seen.type].features,
                  [&] { return axes_rotation(*transform_, map_->crs(), crs_, at.x(), at.y()); });
      const auto there = (*transform_)(at.x(), at.y());
      seen.position.xyz.head<2>() = Eigen::Vector2d(there.x, there.y);
    }
    return seen.position.xyz.head<2>().allFinite();
  }

  const geodb::MapStore* map_;
  TypeRegistry types_;  ///< of the subset
  LandmarkChoice chosen_;
  Crs crs_;
  std::optional<CrsTransform> transform_;
  std::vector<std::pair<TypeId, geodb::MapStore::RowRange>> ranges_;
};

}  // namespace

MapSubset map_subset(const geodb::MapStore& map, const LandmarkChoice& chosen, const Crs& crs) {
  MapSubset subset;
  geodb::MapContents& contents = subset.contents;
  contents.crs = crs;
  for (const std::string& name : chosen.types) contents.types.add(*map.types().find(name));
  const auto reader = std::make_shared<SubsetReader>(map, contents.types, chosen, crs);
  for (const std::string& name : chosen.types) {
    const SubsetReader::Count count = reader->count(contents.types.id(name));
    subset.layers.push_back({name, count.kept});
    if (count.lost > 0)
      subset.warnings.push_back(
          fmt::format("{} {} landmarks have no position in {} and are left out", count.lost, name, crs.id()));
  }
  contents.parts.count = reader->parts();
  contents.parts.landmarks = [reader](std::size_t part) {
    return std::make_shared<const std::vector<Landmark>>(reader->landmarks(part).landmarks);
  };
  contents.parts.evidence = [reader](std::size_t part) {
    return std::make_shared<const std::vector<Observation>>(reader->evidence(part));
  };
  contents.observations = reader->rejected();
  contents.images = map.images();
  reproject(contents.images, map.crs(), crs);
  const auto runs = map.runs();
  if (!runs.empty()) contents.run = runs.back();
  if (runs.size() > 1)
    subset.warnings.push_back(fmt::format("only the latest of {} runs is kept", runs.size()));
  if (map.has_dem_coverage()) subset.warnings.push_back("the elevation tiles of the map are left out");
  return subset;
}

}  // namespace waymark::exporters
