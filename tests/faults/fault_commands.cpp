// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/fault_commands.hpp"

#include <cstdlib>
#include <ostream>
#include <utility>

namespace waymark::test {

void PrintTo(const Command& command, std::ostream* out) {
  *out << command.name;
}

bool is_slow() {
  return std::getenv("WAYMARK_SLOW_TESTS") != nullptr;
}

const std::vector<Command>& commands() {
  const auto with = [](const std::string& line, const std::string& older, const std::string& newer) {
    const auto filled = [&](const std::string& by) {
      std::string text = line;
      for (std::size_t at; (at = text.find('%')) != std::string::npos;) text.replace(at, 1, by);
      return text;
    };
    return std::pair{filled(older), filled(newer)};
  };
  static const std::vector<Command> all = [&] {
    std::vector<Command> made;
    const auto add = [&](const std::string& name, const std::string& line, const std::string& older,
                         const std::string& newer, bool edits_map = false,
                         const std::vector<std::string>& inputs = {}) {
      const auto [first, second] = with(line, older, newer);
      made.push_back({name, first, second, edits_map, inputs});
    };
    add("import", "import $IN/%.csv -o $OUT/map.gpkg --type rock --map-crs EPSG:32632", "few", "many");
    add("peaks", "peaks $IN/%.tif -o $OUT/map.gpkg --work $OUT/work --tile-cells 64", "small", "large");
    for (const char* ending :
         {"gpkg", "csv", "geojson", "kml", "shp", "fgb", "gml", "gdb", "tab", "mif", "ods", "xlsx", "sqlite"})
      add(std::string("export_") + ending,
          std::string("export $IN/%.gpkg $OUT/rocks.") + ending + " --overwrite", "few", "many");
    add("report", "report $IN/%.gpkg -o $OUT/report.html", "few", "many");
    add("inventory_csv", "inventory $IN/trees.gpkg --grid % -o $OUT/stands.csv --report $OUT/stands.html",
        "80", "40");
    add("inventory_copy", "inventory $IN/trees.gpkg --grid % -o $OUT/trees.gpkg", "80", "40");
    add("inventory_in_place", "inventory $OUT/trees.gpkg --grid % -o $OUT/trees.gpkg", "80", "40", true);
    add("localize_csv", "localize $IN/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method ekf", "short", "long");
    add("localize_gpkg", "localize $IN/few.gpkg $IN/%.jsonl -o $OUT/track.gpkg --method ekf", "short",
        "long");
    add("localize_live",
        "localize $OUT/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method ekf --layers $OUT/few.gpkg --live 5",
        "short", "long", true);
    add("slam_map",
        "localize $IN/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method slam --write-map $OUT/map.gpkg",
        "short", "long");
    add("simulate_site", "simulate $IN/site.json -o $OUT --seed %", "1", "2");
    add("simulate_forest", "simulate $IN/forest.json -o $OUT --seed %", "1", "2");
    add("allometry", "allometry fit $IN/%.trees.csv -o $OUT/table.csv", "few", "many");
    if (is_slow()) add("train", "train craters -o $OUT/model.txt --scenes 2 --rounds 1 --seed %", "1", "2");
    add("detect_csv", "detect craters $IN/%.pgm -o $OUT/craters.csv --image-sun-angle 0", "small", "large");
    add("detect_gpkg", "detect craters $IN/%.pgm -o $OUT/craters.gpkg --image-sun-angle 0", "small", "large");
    add("trees", "trees --chm $IN/%.chm.tif -o $OUT/map.gpkg --tile-cells 64", "small", "large");
    add("craters", "craters --dem $IN/%.tif -o $OUT/map.gpkg --with-dem", "small", "large");
    add("hazards",
        "hazards $IN/%.ground.tif -o $OUT/hazard.tif --polygons $OUT/hazard.gpkg --nav2 $OUT/hazard.yaml "
        "--rock-cover 0 --detection-limit 0.5",
        "small", "large");
    for (const char* ending : {"gpkg", "csv", "geojson"})
      add(std::string("route_") + ending,
          std::string("route $IN/few.gpkg --from -10,-10 --to %,20 --sensor horizontal_laser --weight 1 -o "
                      "$OUT/route.") +
              ending,
          "20", "30");
    add("update_map", "localize $OUT/few.gpkg $IN/%.jsonl -o $OUT/track.csv --method slam --update-map",
        "short", "long", true);
    add("reconstruct",
        "reconstruct $IN/flight/images --cameras $IN/flight/truth/cameras.json -o $OUT --until % --threads 1",
        "poses", "dem");
    add("merge", "merge $IN/few.gpkg $IN/%.gpkg -o $OUT/map.gpkg", "few", "many");
    const std::string add_rock = " add --type rock --at % 5200000 --feature radius=0.4";
    add("edit_copy", "edit $IN/few.gpkg" + add_rock + " -o $OUT/map.gpkg", "500800", "500900");
    add("edit_in_place", "edit $OUT/few.gpkg" + add_rock, "500800", "500900", true);
    add("map", "map $IN/%.jsonl -o $OUT/map.gpkg", "short", "long");
    add("observability", "observability $IN/few.gpkg -o $OUT/info.tif --sensor horizontal_laser --cell %",
        "8", "4");
    add("view", "view $IN/%.gpkg -o $OUT/view.html", "few", "many");
    add("web", "web $IN/%.gpkg -o $OUT", "few", "many");
    add("stac", "stac $IN/%.gpkg -o $OUT/item.json", "few", "many");
    add("detect_geojson", "detect craters $IN/%.pgm -o $OUT/craters.geojson --image-sun-angle 0", "small",
        "large");
    add("picture", "evaluate track $IN/track.csv --truth $IN/%.jsonl --picture $OUT/track.svg", "short",
        "long");
    add("buildings", "buildings --chm $IN/%.chm.tif --trees -o $OUT/map.gpkg", "small", "large");
    add("images",
        "images --cameras $IN/site/cameras.json --dem $IN/site/dem.tif --crs local --find % -o $OUT/map.gpkg",
        "rocks", "craters", false, {"simulate $IN/site.json -o $IN/site"});
    add("job", "run $IN/site%/job.json -o $OUT/map.gpkg --work $OUT/work", "1", "2", false,
        {"simulate $IN/site.json -o $IN/site1 --seed 1", "simulate $IN/site.json -o $IN/site2 --seed 2"});
    add("register", "register $IN/rough.gpkg --to $IN/%.catalogue.csv --crs EPSG:32632 -o $OUT/map.gpkg",
        "near", "far", false, {"import $IN/rough.csv -o $IN/rough.gpkg --type crater --map-crs local"});
    add("locate", "locate $IN/moon.gpkg $IN/%.pixels.csv -o $OUT/at.csv --matches $OUT/matches.csv", "three",
        "four", false, {"import $IN/moon.csv -o $IN/moon.gpkg --type crater --map-crs IAU_2015:30100"});
    add("simulate_street", "simulate $IN/street.json -o $OUT --seed %", "1", "2");
    add("train_sensor", "train sensor $IN/%.jsonl --map $IN/few.gpkg -o $OUT/sensor.json", "short", "long");
    for (const char* ending : {"tum", "kitti", "g2o"})
      add(std::string("localize_") + ending,
          std::string("localize $IN/few.gpkg $IN/%.jsonl --method ekf -o $OUT/track.") + ending, "short",
          "long");
    made.push_back({.name = "restore",
                    .older = with("edit $OUT/few.gpkg" + add_rock, "500800", "").first,
                    .newer = "restore $OUT/few.gpkg",
                    .edits_map = true,
                    .can_repeat = false});
    return made;
  }();
  return all;
}

}  // namespace waymark::test
