// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/viewing/web_map.hpp"

namespace waymark::apps {
namespace {

class Web final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "web",
        .group = Group::use,
        .summary = "Write a folder that shows a map in web browsers, from any file server",
        .about =
            "Landmarks are vector tiles, terrain is tiles of heights, both in PMTiles archives beside a page "
            "and a style for MapLibre. Crowded tiles of coarse zooms show the foremost landmarks: the "
            "largest prominence or "
            "radius times confidence, then quality. The finest zoom shows each landmark once.\n\n"
            "The page needs the libraries MapLibre GL JS and pmtiles in its folder `lib`. They are not part "
            "of Waymark: the program `fetch-maplibre` in the folder fetches and checks them, or --assets "
            "copies them. Afterwards the page needs no other server.\n\n"
            "Stands and tree crowns of the map are shown as areas.\n\n"
            "Other bodies than the Earth have a scale bar of their own radius. Maps of a local CRS, and "
            "polar "
            "ones, are drawn to scale on a plane. The result does not depend on --threads.",
        .arguments =
            {file_word("MAP", &request_.map, "Map (.gpkg)"),
             Argument{"-o,--output", "DIR", &request_.output, "Folder to write; an older web map is replaced"}
                 .needed()
                 .offering(Offer::folder),
             Argument{"--aoi", "POLYGONS", &request_.aoi,
                      "Area of interest, in any CRS of the body: show the landmarks inside"}
                 .offering(Offer::file),
             Argument{"--type", "TYPE", &request_.types, "Landmark type to show; may be repeated"}.or_else(
                 "all types"),
             Argument{"--min-confidence", "C", &request_.min_confidence,
                      "Smallest probability of existence shown, 0 to 1"}
                 .or_else("0"),
             Argument{"--dem", "DEM", &request_.dem, "Elevation model; may be repeated"}
                 .offering(Offer::file)
                 .or_else("that of the map"),
             Argument{"--terrain-pixels", "N", &request_.terrain_pixels,
                      "Most pixels of the longer side of the terrain; 0 leaves it out"}
                 .or_else("4096"),
             Argument{"--max-zoom", "Z", &max_zoom_, "Zoom that shows all landmarks, 0 to 22"}.or_else(
                 "chosen by their density"),
             Argument{"--assets", "DIR", &request_.assets,
                      "Folder of the map library, as scripts/fetch-maplibre fetches it"}
                 .offering(Offer::folder)
                 .or_else("fetched later"),
             Argument{"--title", "TEXT", &request_.title, "Title of the page"}.or_else("the map's name"),
             format_option(&format_)},
        .examples = {{"waymark web alps.gpkg -o site && (cd site && sh fetch-maplibre lib)",
                      "A page with all that it needs"},
                     {"waymark web mars.gpkg -o site --dem ctx_dem.tif --type crater --min-confidence 0.5",
                      "Craters on terrain"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.max_zoom = static_cast<int>(max_zoom_);
    request_.threads = static_cast<int>(session.threads);
    const workflows::WebMapResult made =
        workflows::make_web_map(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(), {{"folder", request_.output},
                                   {"landmarks", made.landmarks},
                                   {"outside", made.outside},
                                   {"max_zoom", std::int64_t{made.max_zoom}},
                                   {"landmark_tiles", made.landmark_tiles},
                                   {"terrain_tiles", made.terrain_tiles},
                                   {"areas", made.shapes},
                                   {"area_tiles", made.shape_tiles},
                                   {"has_library", made.has_library}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"folder", ResultKind::text, "Folder that was written"},
            {"landmarks", ResultKind::integer, "Landmarks on the map"},
            {"outside", ResultKind::integer, "Landmarks beyond the edges of web maps"},
            {"max_zoom", ResultKind::integer, "Zoom that shows all landmarks"},
            {"landmark_tiles", ResultKind::integer, "Tiles of landmarks"},
            {"terrain_tiles", ResultKind::integer, "Tiles of terrain; 0 without a DEM"},
            {"areas", ResultKind::integer, "Polygons of stands and crowns"},
            {"area_tiles", ResultKind::integer, "Tiles of them"},
            {"has_library", ResultKind::flag, "Whether the map library is in the folder"}};
  }

  std::string format_ = "text";
  workflows::WebMapRequest request_;
  std::int64_t max_zoom_ = -1;
};

}  // namespace

void register_command_web(CommandTable& commands);
void register_command_web(CommandTable& commands) {
  commands.add<Web>();
}

}  // namespace waymark::apps
