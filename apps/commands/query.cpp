// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <unordered_map>

#include "apps/command.hpp"
#include "apps/landmark_formats.hpp"
#include "apps/query_area.hpp"
#include "apps/query_request.hpp"
#include "exporters/vector_format.hpp"

namespace waymark {
namespace {

class Query final : public Command {
 public:
  CommandSpec describe() override {
    std::vector<Argument> all{file_word("MAP.gpkg", &map_, "Map to read; it is not changed")};
    for (auto& argument : query_arguments(request_)) all.push_back(argument);
    all.push_back(
        Argument{"--format", "FORM", &format_, "How to print them; geojson is always longitude and latitude"}
            .one_of({"table", "csv", "json", "geojson"})
            .or_else("table"));
    return {
        .name = "query",
        .group = Group::use,
        .summary = "Print the landmarks of a map that meet conditions",
        .about =
            "Distances are metres on the ground, also across the antimeridian and at the poles. The table "
            "shows the features; csv, json and geojson have every column of the map.",
        .arguments = all,
        .examples = {
            {"waymark query alps.gpkg --largest prominence --limit 10", "The ten most prominent summits"},
            {"waymark query alps.gpkg --near 8.0 46.5 5000 --type mountain_top", "All within 5 km"},
            {"waymark query alps.gpkg --min prominence=300 --format csv > tops.csv", "A table for a script"},
            {"waymark query site.gpkg --sensor stereo_camera --min-quality 0.6",
             "What a stereo camera can rely on"}}};
  }

  int run(const Session&) override {
    const MapStore map = MapStore::open(map_);
    const MapQuestion question(request_, map);
    const Crs printed = format_ == "geojson" ? output_crs(kGeoJson, map.crs(), "", map_) : question.crs();
    const std::vector<Landmark> found = question.answer(map);
    RowContext context{.types = &map.types(), .sensor = question.sensor()};
    if (question.from_point()) context.distance = distances(question, map, found);
    print(row_columns(request_.types.empty() ? map.types().names() : request_.types, context),
          in_crs(found, map.types(), map.crs(), printed), printed);
    return 0;
  }

 private:
  inline static const VectorFormat kGeoJson{.driver = "GeoJSON", .earth_only = true, .only_wgs84 = true};

  /// Measured before the landmarks are moved to another CRS.
  static std::function<double(const Landmark&)> distances(const MapQuestion& question, const MapStore& map,
                                                          const std::vector<Landmark>& found) {
    std::unordered_map<std::string, double> by_uid;
    for (const Landmark& landmark : found) by_uid[landmark.uid] = question.distance(map, landmark);
    return [by_uid = std::move(by_uid)](const Landmark& landmark) { return by_uid.at(landmark.uid); };
  }

  void print(const std::vector<RowColumn>& columns, const std::vector<Landmark>& landmarks,
             const Crs& crs) const {
    if (format_ == "csv") return print_csv(std::cout, columns, landmarks);
    if (format_ == "json") return print_json(std::cout, columns, landmarks);
    if (format_ == "geojson") return print_geojson(std::cout, columns, landmarks);
    print_table(std::cout, columns, landmarks, crs);
  }

  std::string map_, format_ = "table";
  QueryRequest request_;
};

}  // namespace

void register_command_query(CommandTable& commands);
void register_command_query(CommandTable& commands) {
  commands.add<Query>();
}

}  // namespace waymark
