// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/subset_layers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

namespace waymark::exporters {
namespace {

/// Rows of one layer that belong to a choice of landmarks, in another CRS.
class LayerReader {
 public:
  LayerReader(const geodb::MapStore& map, const LandmarkChoice& chosen, const Crs& crs, std::string name)
      : map_(&map), chosen_(chosen), name_(std::move(name)) {
    if (!map.crs().same_as(crs)) transform_.emplace(map.crs(), crs);
    const auto types = map.types().names();
    chooses_all_ = !chosen.inside && !(chosen.min_confidence > 0) &&
                   std::ranges::all_of(types, [&](const std::string& type) {
                     return std::ranges::find(chosen.types, type) != chosen.types.end();
                   });
  }

  /// Returns the number of rows without a position in the CRS.
  std::int64_t visit(const std::function<void(const geodb::ShapeLayer&)>& begin,
                     const std::function<void(const geodb::Shape&)>& take) const {
    std::int64_t lost = 0;
    std::size_t uid = 0;
    bool has_uid = false;
    geodb::visit_shape_layer(
        map_->path(), name_,
        [&](const geodb::ShapeLayer& layer) {
          const auto at = std::ranges::find(layer.columns, "uid", &AttributeSpec::name);
          has_uid = at != layer.columns.end();
          uid = static_cast<std::size_t>(at - layer.columns.begin());
          if (begin) begin(layer);
        },
        [&](geodb::Shape&& shape) {
          if (has_uid && !chooses_all_ && !is_of_chosen(shape.values[uid])) return;
          if (!reproject(shape)) {
            ++lost;
            return;
          }
          if (take) take(shape);
        });
    return lost;
  }

 private:
  bool is_of_chosen(const AttributeValue& uid) const {
    const auto* text = std::get_if<std::string>(&uid);
    if (!text) return true;
    const auto landmark = map_->find(*text);
    return landmark && chosen_.has(*map_, *landmark);
  }

  bool reproject(geodb::Shape& shape) const {
    if (!transform_) return true;
    bool finite = true;
    const auto move = [&](std::vector<Eigen::Vector2d>& ring) {
      for (Eigen::Vector2d& corner : ring) {
        const auto there = (*transform_)(corner.x(), corner.y());
        corner = {there.x, there.y};
        finite = finite && corner.allFinite();
      }
    };
    for (geodb::ShapePart& part : shape.parts) {
      move(part.outer);
      for (auto& hole : part.holes) move(hole);
    }
    return finite;
  }

  const geodb::MapStore* map_;
  LandmarkChoice chosen_;
  std::string name_;
  std::optional<CrsTransform> transform_;
  bool chooses_all_ = true;
};

}  // namespace

bool LandmarkChoice::has(const geodb::MapStore& map, const Landmark& landmark) const {
  const std::string& type = map.types()[landmark.type].name;
  return std::ranges::find(types, type) != types.end() && likely(landmark) &&
         (!inside || inside(landmark.position.xyz.x(), landmark.position.xyz.y()));
}

std::vector<geodb::ShapeLayer> subset_layers(const geodb::MapStore& map, const LandmarkChoice& chosen,
                                             const Crs& crs, std::vector<std::string>& warnings) {
  std::vector<geodb::ShapeLayer> layers;
  std::vector<std::string> whole;
  for (const std::string& name : geodb::shape_layers(map.path())) {
    const auto reader = std::make_shared<const LayerReader>(map, chosen, crs, name);
    geodb::ShapeLayer layer;
    const std::int64_t lost = reader->visit([&](const geodb::ShapeLayer& header) { layer = header; }, {});
    const bool has_uid = std::ranges::find(layer.columns, "uid", &AttributeSpec::name) != layer.columns.end();
    if (chosen.inside && !has_uid) {
      whole.push_back(name);
      continue;
    }
    if (lost > 0)
      warnings.push_back(fmt::format("{} rows of the layer {} have no position in {} and are left out", lost,
                                     name, crs.id()));
    layer.generator = [reader](const std::function<void(const geodb::Shape&)>& take) {
      reader->visit({}, take);
    };
    layers.push_back(std::move(layer));
  }
  if (!whole.empty())
    warnings.push_back(fmt::format("layers of the whole map are left out: {}", fmt::join(whole, ", ")));
  return layers;
}

}  // namespace waymark::exporters
