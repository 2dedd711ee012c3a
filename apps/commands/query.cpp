// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include "apps/command.hpp"
#include "apps/landmark_formats.hpp"
#include "apps/log.hpp"
#include "workflows/query/query.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {
namespace {

std::vector<Argument> query_arguments(workflows::QueryRequest& request) {
  return {
      Argument{"--type", "T", &request.types, "Landmarks of this type; may be repeated"}
          .offering(workflows::all_types().names())
          .or_else("all"),
      {"--bbox", "X0 Y0 X1 Y1", &request.bbox, "Landmarks in this box; X0 > X1 crosses the antimeridian"},
      Argument{"--aoi", "POLYGONS", &request.aoi, "Landmarks inside this area"}.offering(Offer::file),
      {"--near", "X Y RADIUS", &request.near, "Landmarks within RADIUS metres of X Y, nearest first"},
      {"--nearest", "X Y COUNT", &request.nearest, "The COUNT landmarks nearest to X Y"},
      {"--min", "FEATURE=VALUE", &request.min_features,
       "Landmarks whose feature, or confidence, quality, seen or other number, is at least this; may be "
       "repeated"},
      {"--max", "FEATURE=VALUE", &request.max_features,
       "Landmarks whose feature or other number is at most this; may be repeated"},
      Argument{"--crs", "CRS", &request.crs, "CRS of the coordinates given and printed"}.or_else("the map's"),
      Argument{"--sensor", "NAME|FILE", &request.sensor,
               "Quality as this sensor sees it; `waymark sensors` lists them, FILE.json is one of your "
               "own, map: the profile that the map records"}
          .offering(workflows::all_sensors().names()),
      {"--min-confidence", "P", &request.min_confidence,
       "Landmarks that exist with at least this probability, 0 to 1"},
      {"--min-quality", "Q", &request.min_quality,
       "Landmarks of at least this quality, 0 to 1; leaves out those seen once of once, which have none"},
      {"--largest", "FEATURE", &request.largest,
       "Largest values of this feature, or of confidence or another number, first"},
      {"--limit", "N", &request.limit, "At most this many"},
  };
}

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
    request_.wgs84 = format_ == "geojson";
    const workflows::QueryResult found = workflows::query(map_, request_);
    for (const std::string& reason : found.why_empty) log_warning(reason);
    RowContext context{.types = &found.types, .sensor = found.sensor.get()};
    if (!request_.near.empty() || !request_.nearest.empty())
      context.distance = [&](const Landmark& landmark) { return found.distances.at(landmark.uid); };
    print(row_columns(request_.types.empty() ? found.types.names() : request_.types, context),
          found.landmarks, found.crs);
    return 0;
  }

 private:
  void print(const std::vector<RowColumn>& columns, const std::vector<Landmark>& landmarks,
             const Crs& crs) const {
    if (format_ == "csv") return print_csv(std::cout, columns, landmarks);
    if (format_ == "json") return print_json(std::cout, columns, landmarks);
    if (format_ == "geojson") return print_geojson(std::cout, columns, landmarks);
    print_table(std::cout, columns, landmarks, crs);
  }

  std::string map_, format_ = "table";
  workflows::QueryRequest request_;
};

}  // namespace

void register_command_query(CommandTable& commands);
void register_command_query(CommandTable& commands) {
  commands.add<Query>();
}

}  // namespace waymark::apps
