// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/joined_layers.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "workflows/mapping/unused_name.hpp"

namespace waymark::workflows {
namespace {

bool same_schema(const geodb::ShapeLayer& a, const geodb::ShapeLayer& b) {
  return a.kind == b.kind && std::ranges::equal(a.columns, b.columns, [](const auto& x, const auto& y) {
           return x.name == y.name && x.kind == y.kind && x.unit == y.unit;
         });
}

}  // namespace

void add_layer(std::vector<geodb::ShapeLayer>& layers, geodb::ShapeLayer layer) {
  const auto own = std::ranges::find(layers, layer.name, &geodb::ShapeLayer::name);
  if (own == layers.end()) {
    layers.push_back(std::move(layer));
    return;
  }
  if (!same_schema(*own, layer)) {
    layer.name = unused_name(layer.name, "_", [&](const std::string& name) {
      return std::ranges::find(layers, name, &geodb::ShapeLayer::name) != layers.end();
    });
    layers.push_back(std::move(layer));
    return;
  }
  std::set<std::pair<std::vector<AttributeValue>, std::vector<double>>> known;
  const auto is_new = [&](const geodb::Shape& row) {
    std::vector<double> vertices;
    for (const geodb::ShapePart& part : row.parts)
      for (const Eigen::Vector2d& p : part.outer) vertices.insert(vertices.end(), {p.x(), p.y()});
    return known.emplace(row.values, std::move(vertices)).second;
  };
  for (const geodb::Shape& row : own->rows) static_cast<void>(is_new(row));
  for (geodb::Shape& row : layer.rows)
    if (is_new(row)) own->rows.push_back(std::move(row));
}

}  // namespace waymark::workflows
