// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/map.hpp. Each function works by itself, in their order.
#include <array>
#include <fstream>
#include <iostream>
#include <waymark/map.hpp>
using namespace waymark;

namespace {

void write() {
  //! [write]
  geodb::MapContents map;  // in a local CRS: metres
  register_landmark_types(map.types);
  const TypeId rock = map.types.id("rock");
  Landmark boulder{
      .uid = {}, .type = rock, .position = {{12, 30, 0}}, .features = {}, .attributes = {}, .quality = {}};
  boulder.features.resize(map.types[rock].features.size());
  boulder.features[feature_index(map.types[rock], "radius")] = {.value = 0.8, .observations = 3};
  map.landmarks = {boulder};
  assign_uids(map.types, map.crs, map.landmarks);
  geodb::write_map("rocks.gpkg", map);
  //! [write]
}

void add_type() {
  //! [type]
  TypeRegistry types;
  types.add({.name = "lamp_post",
             .summary = "Street light",
             .features = {{"height", "m", Scale::ratio, 2, 20, "Ground to lamp"}},
             .drawn_as = Solid::cylinder});
  std::cout << types[types.id("lamp_post")].summary << '\n';
  //! [type]
}

void merge_observations() {
  //! [merge]
  const std::array<WeightedValue, 3> heights{{{7.9, 0.8}, {8.2, 0.9}, {8.0, 0.5}}};  // metres, weight
  const FeatureValue height = merge(heights, Scale::ratio);
  const std::optional<double> of_spread = spread_confidence(height, Scale::ratio, 0);
  const std::optional<double> of_counts = multiplicity_confidence(3, 4);  // seen in 3 of 4 images
  std::cout << height.value << " m, confidence " << of_spread.value_or(0) * of_counts.value_or(0) << '\n';
  //! [merge]
}

void read() {
  //! [read]
  const geodb::MapStore store = geodb::MapStore::open("rocks.gpkg");
  geodb::MapQuery nearby;
  nearby.types = {"rock"};
  nearby.near = geodb::MapQuery::Near{10, 30, 5_m};
  for (const Landmark& rock : store.query(nearby))
    std::cout << rock.uid << " is " << store.distance(rock, 10, 30) << " m away\n";
  //! [read]
}

void ask() {
  //! [query]
  workflows::QueryRequest request;  // as `waymark query rocks.gpkg --largest radius --limit 3`
  request.largest = "radius";
  request.limit = 3;
  for (const Landmark& rock : workflows::query("rocks.gpkg", request).landmarks)
    std::cout << rock.uid << '\n';
  //! [query]
}

void edit() {
  //! [edit]
  geodb::MapEditor editor = geodb::MapEditor::open("rocks.gpkg");
  Landmark rock = editor.map().query({}).front();
  rock.confidence = 0.5;
  editor.transact([&] { editor.update(rock); });  // all changes of the function, or none
  //! [edit]
}

void keep_in_memory() {
  //! [memory]
  const geodb::MapStore store = geodb::MapStore::open("rocks.gpkg");
  const SemanticMap map(store.types(), store.crs(), store.query({}));
  for (const Landmark& rock : map.near(Point<MapCrs>{{12, 31, 0}}, 2_m)) std::cout << rock.uid << '\n';
  //! [memory]
}

void weigh() {
  //! [sensor]
  const geodb::MapStore store = geodb::MapStore::open("rocks.gpkg");
  const SensorProfile& laser = workflows::all_sensors().at("horizontal_laser");
  for (const Landmark& rock : store.query({}))
    std::cout << quality_for(laser, store.types()[rock.type], rock).value_or(0) << '\n';  // eq. 8
  //! [sensor]
}

void import_table() {
  std::ofstream("survey.csv") << "x,y,radius\n3,4,0.5\n8,1,1.2\n";
  //! [import]
  workflows::ImportRequest request{.table = "survey.csv", .map = "survey.gpkg"};
  request.options.type = "rock";
  request.options.map_crs = "local";
  const importers::ImportedTable table = workflows::import_landmarks(request);
  std::cout << table.rows << " rows\n";
  //! [import]
}

void deliver() {
  //! [deliver]
  for (const geodb::Finding& finding : geodb::validate_map("survey.gpkg"))
    std::cout << finding.code << ": " << finding.text << '\n';
  exporters::export_map("survey.gpkg", "survey.fgb", {.overwrite = true});
  exporters::write_report("survey.gpkg", "survey.html", {.title = "Survey"});
  //! [deliver]
}

void fail() {
  //! [error]
  try {
    geodb::MapStore::open("nowhere.gpkg");
  } catch (const Error& error) {
    std::cout << error.what() << "\nexit code " << exit_code(error.code()) << '\n';  // problem, place, remedy
  }
  //! [error]
}

}  // namespace

int main() {
  for (const auto& step : {write, add_type, merge_observations, read, ask, edit, keep_in_memory, weigh,
                           import_table, deliver, fail})
    step();
}
