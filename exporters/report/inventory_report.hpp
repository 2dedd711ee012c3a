// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
namespace waymark::exporters {

/// Content of a printed inventory: the layers `stand` and `stand_tree` of `waymark inventory`.
struct InventoryPage {
  static constexpr std::size_t kMaxTrees = 20'000;  ///< drawn in the map
  std::string title, crs;
  geodb::ShapeLayer stands;
  geodb::ShapeLayer trees;     ///< those to be drawn
  std::size_t tree_count = 0;  ///< of all
  std::vector<std::string> warnings, failed;
};

/// Writes one HTML file without external references: a map of stands and trees, a table of the stands, the
/// diameters of each. Staged and renamed. Throws Error{output}.
void write_inventory_report(const std::filesystem::path& path, const InventoryPage& page);

/// Returns the HTML of the page.
std::string inventory_html(const InventoryPage& page);

}  // namespace waymark::exporters
