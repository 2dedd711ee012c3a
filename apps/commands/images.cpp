// SPDX-License-Identifier: Apache-2.0
#include "apps/shortcut.hpp"
#include "workflows/mapping/image_stages.hpp"

namespace waymark::apps {
namespace {

class Images final : public Shortcut {
 public:
  Images()
      : Shortcut({"load_images.camera_format", "load_images.interior", "load_images.camera_crs",
                  "load_images.height_offset", "load_images.control_points", "load_images.position_sd",
                  "load_images.rotation_sd", "load_images.sun_azimuth", "load_images.sun_elevation",
                  "load_images.image_sun_angle", "load_images.time_zone", "load_images.gsd",
                  "load_dem.aoi"}) {}

 private:
  CommandSpec describe_own() override {
    return {
        .name = "images",
        .group = Group::make,
        .summary = "Map the rocks and craters that posed images show",
        .about =
            "Landmarks are detected in every image, projected onto the DEM, merged and valued. Poses come "
            "from a camera file of COLMAP, ODM, Metashape or others; orthophotos need none. Images "
            "without poses: `waymark reconstruct`.\n\n"
            "Pictures must show what casts shadows: a sun 10 to 60 degrees above the horizon, rocks of 5 "
            "pixels or more, bare ground, each place in two images or more. A warning says where the "
            "ground is not what the detectors were made for.",
        .arguments =
            {Argument{"", "IMAGES...", &files_.images,
                      "Images, patterns or folders; default: those that the camera file names"}
                 .offering(Offer::file),
             Argument{"--cameras", "FILE", &files_.cameras,
                      "Camera file with the poses, or a pattern; without it the images are orthophotos"}
                 .offering(Offer::file),
             Argument{"--dem", "DEM...", &files_.dem,
                      "Elevation models of the ground; without them it is level, at height 0"}
                 .offering(Offer::file),
             {"--crs", "CRS", &files_.crs,
              "CRS of the DEM instead of its own, or of the map without a DEM; local: metres on no body"},
             {"--height-sd", "M", &files_.height_sd, "Standard deviation of the ground's heights, metres"},
             Argument{"--find", "KINDS", &find_,
                      "Landmarks to search for, separated by commas: rocks, craters, mountain_tops"}
                 .or_else("rocks,craters")},
        .examples = {
            {"waymark images photos/ --cameras cameras.json --dem dem.tif -o map.gpkg",
             "Rocks and craters of a flight"},
            {"waymark images photos/ --cameras sparse/ --camera-format colmap --dem dem.tif -o map.gpkg",
             "Poses of COLMAP"},
            {"waymark images ortho.tif --dem dem.tif --find rocks --sun-azimuth 120 --sun-elevation 30 -o "
             "rocks.gpkg",
             "An orthophoto and its sun"},
            {"waymark images photos/ --cameras cameras.json --dem dem.tif --print-job > job.json",
             "The job, to change it and `waymark run` it"}}};
  }

  void add_stages(pipeline::Pipeline& pipeline) const override {
    workflows::add_image_stages(pipeline, files_, workflows::parse_image_finds(find_));
  }

  workflows::ImageFiles files_;
  std::string find_ = "rocks,craters";
};

}  // namespace

void register_command_images(CommandTable& commands);
void register_command_images(CommandTable& commands) {
  commands.add<Images>();
}

}  // namespace waymark::apps
