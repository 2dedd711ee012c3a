// SPDX-License-Identifier: Apache-2.0
#include "geodb/rtree/box_order.hpp"

#include <algorithm>
#include <utility>

#include "core/reorder.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/rtree/hilbert.hpp"

namespace waymark::geodb {

void sort_along_curve(std::vector<IndexedBox>& boxes) {
  Envelope extent;
  for (const IndexedBox& box : boxes)
    extent.add(Envelope{.min_x = box.min_x, .min_y = box.min_y, .max_x = box.max_x, .max_y = box.max_y});
  const double width = std::max({extent.max_x - extent.min_x, extent.max_y - extent.min_y, 1e-9});
  const auto cell = [&](double value, double low) {
    return static_cast<std::uint16_t>(std::clamp((value - low) / width, 0.0, 1.0) * 65535);
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> curve_order;
  curve_order.reserve(boxes.size());
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    curve_order.emplace_back(hilbert_index(cell((boxes[i].min_x + boxes[i].max_x) / 2, extent.min_x),
                                           cell((boxes[i].min_y + boxes[i].max_y) / 2, extent.min_y)),
                             i);
  std::ranges::sort(curve_order);
  std::vector<std::uint32_t> order(boxes.size());
  std::ranges::transform(curve_order, order.begin(), [](const auto& entry) { return entry.second; });
  reorder(boxes, std::move(order));
}

}  // namespace waymark::geodb
