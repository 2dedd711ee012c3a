// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "geodb/shape_layer.hpp"
namespace waymark {

/// What a forester prints: the layers `stand` and `stand_tree` of `waymark inventory`.
struct InventoryPage {
  static constexpr std::size_t kMostTrees = 20'000;  ///< that a map is drawn with
  std::string title, crs;
  ShapeLayer stands;
  ShapeLayer trees;            ///< as many as shall be drawn
  std::size_t tree_count = 0;  ///< of all
  std::vector<std::string> warnings, failed;
};

/// One HTML file that needs no network and no other file: a map of stands and trees, a table of the stands,
/// the diameters of each. Written aside and renamed. Throws Error{output}.
void write_inventory_report(const std::filesystem::path& path, const InventoryPage& page);

/// The page itself.
std::string inventory_html(const InventoryPage& page);

}  // namespace waymark
