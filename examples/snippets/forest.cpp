// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/forest.hpp.
#include <cmath>
#include <fstream>
#include <iostream>
#include <waymark/forest.hpp>
#include <waymark/map.hpp>
using namespace waymark;

namespace {

//! [canopy]
/// A canopy height model in memory: two trees of 20 and 14 m, cells of one metre.
struct TwoTrees final : CanopySource {
  GridGeometry grid{.columns = 40, .rows = 20, .where = {}};
  std::string survey = "two trees";
  const GridGeometry& geometry() const override { return grid; }
  Grid<float> read(const Window& window) const override {
    Grid<float> heights(window.columns, window.rows, kNoCanopy);
    for (std::int64_t row = 0; row < 20; ++row)
      for (std::int64_t column = 0; column < 40; ++column)
        if (window.contains(column, row)) {
          const double a = std::hypot(column - 10, row - 10), b = std::hypot(column - 28, row - 10);
          heights(column - window.column, row - window.row) =
              static_cast<float>(std::max({0., 20 - a * a, 14 - b * b}));
        }
    return heights;
  }
  double ground_elevation(std::int64_t, std::int64_t) const override { return 0; }
  Grid<std::uint8_t> forest_types(const Window&) const override { return {}; }
  const std::string& name() const override { return survey; }
};
//! [canopy]

void find() {
  //! [trees]
  const TwoTrees canopy;
  const pipeline::TreeSearch search{.forest = pipeline::forest_preset(ForestType::conifer)};
  for (const pipeline::DetectedTree& tree : pipeline::find_trees(canopy, Window{0, 0, 40, 20}, search))
    std::cout << tree.height << " m high, crown " << tree.crown_diameter << " m wide\n";
  std::cout << pipeline::search_halo(search, 1) << " cells around are read\n";  // cells of one metre
  //! [trees]
}

void count() {
  //! [stand]
  const pipeline::StandPolygon hectare{.rings = {{{0, 0}, {100, 0}, {100, 100}, {0, 100}}}};  // metres
  std::vector<pipeline::StandTree> trees(3);
  for (std::size_t i = 0; i < trees.size(); ++i) {
    trees[i].position = {20. + 30. * static_cast<double>(i), 50};
    trees[i].height = 24, trees[i].diameter = 0.3;  // metres
  }
  const pipeline::StandAttributes figures = inventory(trees, hectare);
  std::cout << figures.stems.value << " stems per hectare, " << figures.basal_area.value
            << " m2 per hectare\n";
  for (const std::size_t tree : trees_in_stand(trees, hectare)) std::cout << trees[tree].height << " m\n";
  //! [stand]
}

void count_map() {
  std::ofstream("trees.csv")
      << "x,y,height,diameter\n10,10,20,0.25\n30,12,24,0.31\n20,40,18,0.22\n40,35,26,0.35\n";
  workflows::ImportRequest map{.table = "trees.csv", .map = "trees.gpkg"};
  map.options.type = "tree";
  map.options.map_crs = "local";
  workflows::import_landmarks(map);
  //! [inventory]
  workflows::InventoryRequest request{.map =
                                          "trees.gpkg"};  // as `waymark inventory trees.gpkg -o stands.csv`
  request.output = "stands.csv";
  request.max_trees = workflows::trees_in_memory({.megabytes = 64});
  for (const workflows::StandResult& stand : inventory(request).stands)
    std::cout << stand.stand.name << ": " << stand.figures.volume.value << " m3 per hectare\n";
  //! [inventory]
}

void fit() {
  std::ofstream table("measured.csv");
  table << "height,diameter\n";
  for (int i = 0; i < 60; ++i) {
    const double height = 10 + 0.3 * i;
    table << height << ',' << 1.1 * height * (1 + 0.1 * std::sin(7 * i)) << '\n';  // m, cm
  }
  table.close();
  //! [allometry]
  workflows::AllometryRequest request{.input = "measured.csv"};  // as `waymark allometry fit measured.csv`
  request.columns.diameter_unit = "cm";
  for (const pipeline::Allometry& row : workflows::fit_allometry(request))
    if (const auto stem = pipeline::stem_diameter(row, 20, 0.5, 0, 0))
      std::cout << stem->metres << " m at a height of 20 m\n";
  //! [allometry]
}

}  // namespace

int main() {
  for (const auto& step : {find, count, count_map, fit}) step();
}
