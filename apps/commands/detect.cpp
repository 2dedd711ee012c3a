// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/detect.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "apps/detection_help.hpp"

namespace waymark::apps {
namespace {

std::vector<Argument> detect_arguments(workflows::DetectRequest& request, std::string& format,
                                       const DetectionHelp& help) {
  const std::vector<std::string> kinds = workflows::image_detectors().names();
  std::vector<Argument> arguments = {
      Argument{"", fmt::format("{}", fmt::join(kinds, "|")), &request.kind, "What to detect"}
          .needed()
          .offering(kinds),
      file_word("IMAGE", &request.image, "Image that GDAL opens, /vsi paths too"),
      Argument{"-o,--output", "OUT", &request.output,
               "Table to write: .csv, .geojson or .gpkg; an older one is replaced"}
          .needed()
          .offering(Offer::file),
      Argument{"--method", "NAME", &request.method, "Method: " + help.methods}
          .offering(help.method_names)
          .or_else(help.default_method),
      Argument{"--image-sun-angle", "DEG", &request.image_sun_angle,
               "Direction towards the sun in the image, from x (right) towards y (down)"}
          .or_else("estimated from the image"),
      {"--sun-azimuth", "DEG", &request.sun_azimuth,
       "Azimuth of the sun, clockwise from map north, of a georeferenced image"},
      {"--sun-elevation", "DEG", &request.sun_elevation, "Sun above the horizon: gives rocks their heights"},
      {"--gsd", "M", &request.gsd, "Size of a pixel on the ground, of an image without georeference"},
      Argument{"--min-diameter", "PX", &request.min_diameter, "Smallest object detected"}.or_else(
          help.min_diameter),
      Argument{"--max-diameter", "PX", &request.max_diameter, "Largest object detected"}.or_else(
          help.max_diameter),
      Argument{"--min-confidence", "P", &request.min_confidence, "Drop less probable detections"}.or_else(
          help.min_confidence),
      Argument{"--band", "N", &request.band, "Band of the image, from 1"}.or_else(
          "brightness of a colour image, else the first"),
      Argument{"--aoi", "POLYGONS", &request.aoi,
               "Area of interest, in any CRS of the body: detections outside are dropped"}
          .offering(Offer::file),
      Argument{"--crs", "CRS", &request.crs, "CRS of a georeferenced image that names none, or a wrong one"}};
  for (Argument& setting : setting_arguments(workflows::image_detectors(), request))
    arguments.push_back(std::move(setting));
  arguments.push_back(
      Argument{"--tile-pixels", "N", &request.piece, "Side of the pieces a large image is searched in"}
          .or_else("8192"));
  arguments.push_back(format_option(&format));
  return arguments;
}

class Detect final : public Command {
 public:
  CommandSpec describe() override {
    const DetectionHelp help = detection_help(workflows::image_detectors());
    return {
        .name = "detect",
        .group = Group::make,
        .summary = "Find " + help.kinds + " in one image",
        .about =
            "Works on any image GDAL reads, whatever its size, without a camera or a DEM. Results are "
            "pixels: (0, 0) is the centre of the first pixel, x to the right, y down. An orthophoto gives "
            "map units as well, and so does --gsd.\n\n"
            "CSV has the columns x, y, diameter, major, minor, angle (of the major axis, degrees from x "
            "towards y), confidence, then the features of the type in metres and radians if the size of a "
            "pixel is known, then map_x and map_y if the image is georeferenced. GeoJSON has the same as "
            "properties; a GeoPackage is a map like any other.\n\n"
            "The direction of the light is estimated from the image unless it is given. Heights of rocks "
            "need --sun-elevation and the size of a pixel.",
        .arguments = detect_arguments(request_, format_, help),
        .examples =
            {{"waymark detect craters mosaic.png -o craters.csv", "Pixels; the sun is estimated"},
             {"waymark detect rocks ortho.tif -o rocks.gpkg --sun-azimuth 270 --sun-elevation 30",
              "A map with heights"},
             {"waymark detect rocks descent.png -o rocks.csv --image-sun-angle 135 --sun-elevation 25 "
              "--gsd 0.05",
              "Metres without a georeference"},
             {"waymark detect craters ctx.tif -o craters.geojson --method edges --min-confidence 0.8",
              "Another method, detections of high confidence only"},
             {"waymark detect trees naip.tif -o trees.gpkg",
              "Crowns in an RGB or RGB + near infrared image"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    request_.threads = static_cast<int>(session.threads);
    request_.command_line = session.command_line;
    const workflows::DetectResult found = workflows::detect(request_, console_callbacks(session, format_));
    if (format_ == "json")
      print_result(result_keys(),
                   {{"output", request_.output},
                    {"detections", static_cast<std::int64_t>(found.detections.detections.size())},
                    {"outside", found.outside},
                    {"light", text_or_null(found.light)},
                    {"warnings", found.warnings}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"output", ResultKind::text, "Table or map that was written"},
            {"detections", ResultKind::integer, "Objects in it"},
            {"outside", ResultKind::integer, "Objects outside the area of interest, which were dropped"},
            {"light", ResultKind::text, "Direction of the light, in words; null if it was given"},
            {"warnings", ResultKind::texts, "Reasons to doubt the result"}};
  }

  std::string format_ = "text";
  workflows::DetectRequest request_;
};

}  // namespace

void register_command_detect(CommandTable& commands);
void register_command_detect(CommandTable& commands) {
  commands.add<Detect>();
}

}  // namespace waymark::apps
