// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/reconstruct.hpp"
#include "apps/command.hpp"
#include "apps/console.hpp"

namespace waymark::apps {
namespace {

class Reconstruct final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "reconstruct",
        .group = Group::make,
        .summary = "Make a DEM, an orthophoto and a map from overlapping images",
        .about =
            "Writes into a folder: cameras.json (poses), points.las and points.ply (tie points), colmap, "
            "dem.tif "
            "(height, its standard deviation, that of the poses, number of views, convergence angle, score, "
            "reason of "
            "no data), orthophoto.tif, report.html and job.json, which `waymark run` turns into the map.\n\n"
            "Poses without control points, GPS positions, a map image, a coarse DEM or an altimeter have an "
            "arbitrary scale and end "
            "there. Images "
            "without a pose are named with the reason; the exit code is then 3.\n\n"
            "Heights are measured where two or more images agree. Every other cell has no data and a reason "
            "(docs/methods/heights_from_images.md).",
        .arguments =
            {Argument{"", "IMAGES...", &request_.images,
                      "Images, patterns or folders; default: those the camera file names"},
             Argument{"-o,--output", "DIR", &request_.folder, "Folder for the products; it may exist"}
                 .needed()
                 .offering(Offer::folder),
             Argument{"--cameras", "FILE", &request_.cameras,
                      "Camera file with the poses, in any format that load_images reads"}
                 .or_else("poses are solved from the images")
                 .offering(Offer::file),
             Argument{"--camera-crs", "CRS", &request_.camera_crs,
                      "CRS of the positions in --cameras, if the file names none: COLMAP, Bundler"}
                 .or_else("such poses are tied to the map by --control"),
             Argument{
                 "--lens,--camera", "FILE", &request_.lens,
                 "Camera file whose lens is kept, e.g. cameras.json of an earlier flight; it may name other "
                 "images, or none"}
                 .or_else("the lens is calibrated from the images")
                 .offering(Offer::file),
             Argument{
                 "--readout-time", "S", &request_.readout_time,
                 "Seconds from the first to the last row of a rolling shutter: poses are solved with the "
                 "motion of the camera, which needs times of exposure (EXIF, or taken_utc in --lens)"}
                 .or_else("that of --lens, else a global shutter"),
             Argument{
                 "--control", "POINTS", &request_.control,
                 "Surveyed points: gcp_list.txt of OpenDroneMap, or a layer of points with --marks; "
                 "names that begin with check are check points. With --cameras: a table with the columns "
                 "image,x,y,z or frame_x,frame_y,frame_z,x,y,z that ties poses of an arbitrary frame to "
                 "the map"}
                 .or_else("GPS positions of the images, else --map, else --dem")
                 .offering(Offer::file),
             Argument{"--marks", "TABLE", &request_.marks,
                      "Table with the columns point,image,column,row: where images show the surveyed points"}
                 .offering(Offer::file),
             Argument{
                 "--altimeter", "TABLE", &request_.altimeter,
                 "Table with the columns image,above_ground,sd or image,height,sd, metres: heights of the "
                 "cameras; alone they give a local frame of true size"}
                 .offering(Offer::file),
             Argument{
                 "--dem", "COARSE", &request_.dem,
                 "Coarse DEM at which the search for heights starts; images without any position are placed "
                 "in it by their relief"}
                 .or_else("heights are searched below the cameras")
                 .offering(Offer::file),
             Argument{"--map", "MAP_IMAGE", &request_.map_image,
                      "Orthophoto of the site, e.g. of an orbiter: images without any position are placed in "
                      "it by "
                      "what they show"}
                 .offering(Offer::file),
             Argument{"--crs", "CRS", &request_.crs, "CRS of the map"}.or_else(
                 "that of the camera file, control points, map image or DEM, else the UTM zone of the "
                 "images"),
             Argument{"--cell", "M", &request_.cell, "Size of a cell of the DEM"}.or_else(
                 "twice the median size of a pixel on the terrain"),
             Argument{"--aoi", "POLYGONS", &request_.aoi,
                      "Area of interest, in any CRS of the body: DEM and orthophoto of the box around it"}
                 .offering(Offer::file),
             Argument{"--until", "PRODUCT", &until_, "Last product to make"}
                 .one_of({"poses", "dem", "ortho"})
                 .or_else("ortho"),
             Argument{"--map-landmarks", "MAP.gpkg", &request_.map,
                      "Run job.json as well and write the map of rocks, craters and mountain tops"}
                 .offering(Offer::file),
             Argument{"--work", "DIR", &request_.work,
                      "Keep finished steps here, so that a killed or changed run does only what is missing"}
                 .offering(Offer::folder),
             format_option(&format_)},
        .examples =
            {{"waymark reconstruct images --cameras cameras.json -o site", "DEM, orthophoto and a job"},
             {"waymark reconstruct images --cameras cameras.json -o site --map-landmarks site.gpkg",
              "The map in one command"},
             {"waymark reconstruct images --control gcp_list.txt -o site",
              "From pictures and surveyed points"},
             {"waymark reconstruct images --lens cameras.json --readout-time 0.033 -o site --until poses",
              "Poses of a rolling shutter with a known lens"},
             {"waymark reconstruct images --altimeter heights.csv -o site",
              "In true size by heights above ground, with nothing else"},
             {"waymark reconstruct images --map orbital_mosaic.tif -o site",
              "From pictures and an orthophoto of the site"},
             {"waymark reconstruct images --cameras colmap/sparse/0 --control gnss.csv --crs EPSG:32651 "
              "--dem srtm.tif --until dem -o site",
              "A DEM from poses of COLMAP, tied to the map, started at a coarse one"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    using workflows::ReconstructUntil;
    request_.until = until_ == "poses" ? ReconstructUntil::poses
                     : until_ == "dem" ? ReconstructUntil::dem
                                       : ReconstructUntil::ortho;
    request_.threads = static_cast<int>(session.threads);
    request_.command_line = session.command_line;
    const workflows::ReconstructResult made =
        workflows::reconstruct(request_, console_callbacks(session, format_));
    if (format_ == "json") print_made(made);
    return made.exit_code();
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"folder", ResultKind::text, "Folder that was written"},
            {"images", ResultKind::integer, "Images with a pose"},
            {"failed", ResultKind::integer, "Images without a pose"},
            {"crs", ResultKind::text, "CRS of poses and products; null: the frame is arbitrary"},
            {"cells", ResultKind::integer, "Cells of the DEM; null: none was made"},
            {"measured", ResultKind::integer, "Cells with a height; null as cells"},
            {"map", ResultKind::text, "Map that was written; null: none"},
            {"landmarks", ResultKind::counts, "Landmarks of the map by type"}};
  }

  void print_made(const workflows::ReconstructResult& made) const {
    const auto if_dem = [&](std::int64_t n) { return made.cells > 0 ? ResultValue(n) : ResultValue(); };
    print_result(result_keys(),
                 {{"folder", request_.folder},
                  {"images", std::int64_t(made.images)},
                  {"failed", std::int64_t(made.failed)},
                  {"crs", text_or_null(made.crs)},
                  {"cells", if_dem(made.cells)},
                  {"measured", if_dem(made.kept)},
                  {"map", text_or_null(made.map && made.map->written ? request_.map : "")},
                  {"landmarks", made.map ? made.map->landmarks : std::map<std::string, std::int64_t>{}}});
  }

  std::string format_ = "text";
  workflows::ReconstructRequest request_;
  std::string until_;
};

}  // namespace

void register_command_reconstruct(CommandTable& commands);
void register_command_reconstruct(CommandTable& commands) {
  commands.add<Reconstruct>();
}

}  // namespace waymark::apps
