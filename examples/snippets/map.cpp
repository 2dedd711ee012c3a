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
  geodb::write_map("rocks.gpkg", map, geodb::WriteMapOptions{.replace = true});  // the default
  //! [write]
}

void add_type() {
  //! [type]
  TypeRegistry types;
  types.add({.name = "lamp_post",
             .summary = "Street light",
             .features = {{"height", "m", Scale::ratio, 2, 20, "Ground to lamp"}},
             .body = BodySize{.feature = "height", .radius_per_value = 0.02},
             .drawn_as = Solid::cylinder});
  std::cout << types[types.id("lamp_post")].summary << '\n';
  //! [type]
}

void merge_observations() {
  //! [merge]
  const std::array<WeightedValue, 3> heights{{{7.9, 0.8}, {8.2, 0.9}, {8.0, 0.5}}};  // metres, weight
  const FeatureValue height = merge(heights, Scale::ratio);
  const std::optional<double> of_spread = spread_confidence(height, Scale::ratio, 0);
  const std::optional<double> of_paper =
      spread_confidence(height, Scale::ratio, 0, SpreadRule::paper);      // eq. 7
  const std::optional<double> of_counts = multiplicity_confidence(3, 4);  // seen in 3 of 4 images
  std::cout << height.value << " m, confidence " << of_spread.value_or(0) * of_counts.value_or(0) << " or "
            << of_paper.value_or(0) * of_counts.value_or(0) << '\n';
  //! [merge]
}

void convert_units() {
  //! [units]
  const Radians right = to_radians(90_deg);
  const Degrees back = to_degrees(right);
  std::cout << right.value << " rad, " << back.value << " deg, " << (2_m + 0.5_m) / 1_m << '\n';
  //! [units]
}

void rate_quality() {
  //! [quality]
  Landmark rock;  // seen in 3 of 4 images; radius and height have q_f of 0.9 and 0.7
  rock.quality = {.seen = 3, .visible = 4, .feature_confidences = {0.9, 0.7}};
  const std::array weights{0.8, 0.2};  // of radius and height
  const std::optional<double> multiplicity = multiplicity_confidence(rock.quality.seen, rock.quality.visible);
  std::cout << landmark_quality(multiplicity, rock.quality.feature_confidences, weights).value() << '\n';
  //! [quality]
}

void ask_types() {
  //! [types]
  const TypeRegistry& types = workflows::all_types();
  const LandmarkType& sign = types[types.id("traffic_sign")];
  std::cout << sign.attributes[attribute_index(sign, "code")].summary << ", " << to_string(sign.evidence)
            << '\n';
  const std::optional<TypeId> tree = find_type(types, parse_evidence_model("canopy"));
  const std::optional<TypeId> beacon = find_self_identifying_type(types);
  std::cout << types[tree.value()].name << ", " << types[beacon.value()].name << '\n';
  //! [types]
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
  const MapBox box{.west = 10, .south = 25, .east = 20, .north = 35};
  for (const Landmark& rock : map.in_box(box, LandmarkFilter{.type = "rock"}))
    std::cout << make_uid(map.types()[rock.type], map.crs(), rock.position) << '\n';  // its uid
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

void make_sensor() {
  //! [own_sensor]
  SensorRegistry sensors;
  register_sensor_profiles(sensors);
  sensors.add({.name = "my_laser",
               .summary = "Sees rocks by their radius",
               .weights = {FeatureWeight{"rock", "radius", 1}},
               .coverage = {.range = 20,
                            .detection = 0.7,
                            .detection_odds = DetectionOdds{3, -0.2, 1.4}}});  // metres, mean probability
  const SensorProfile& laser = sensors.at("my_laser");
  std::cout << detection_probability(laser.coverage, 12, 0.8) << '\n';  // at 12 m, of a rock of 0.8 m
  const geodb::MapStore store = geodb::MapStore::open("rocks.gpkg");
  for (const Landmark& rock : store.query({}))
    std::cout << quality_of(store.types()[rock.type], rock).value_or(0) << '\n';  // equal weights
  const LandmarkType& rocks = store.types()[store.types().id("rock")];
  std::cout << weights_for(laser, rocks)[feature_index(rocks, "radius")] << '\n';
  //! [own_sensor]
}

void ask_often() {
  //! [prepared]
  const geodb::MapStore store = geodb::MapStore::open("rocks.gpkg");
  workflows::QueryRequest request;
  request.near = {10, 30, 50};                            // x, y, metres
  const workflows::PreparedQuery nearby(request, store);  // checked once, run on any map
  for (const Landmark& rock : nearby.run(store))
    std::cout << rock.uid << " is " << nearby.distance(store, rock) << " m away\n";
  //! [prepared]
}

void read_rules() {
  //! [rules]
  for (const std::string& name : workflows::ready_rule_names())  // as `waymark import --rules NAME`
    std::cout << name << ": " << workflows::rules_text(name).size() << " bytes\n";
  //! [rules]
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
  geodb::check_before_copy("survey.gpkg");     // throws the first finding
  geodb::check_before_reading("survey.gpkg");  // the same, before tables and reports
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
  const std::string word = "rok", hint = nearest_name(word, workflows::all_types().names());
  const ErrorCode code = edit_distance(word, hint) < 3 ? ErrorCode::usage : ErrorCode::input;
  std::cout << Error(code, "there is no type " + word, "", "did you mean " + hint + "?").what() << '\n';
  //! [error]
}

}  // namespace

int main() {
  for (const auto& step :
       {write, add_type, merge_observations, convert_units, rate_quality, ask_types, read, ask, ask_often,
        edit, keep_in_memory, weigh, make_sensor, read_rules, import_table, deliver, fail})
    step();
}
