// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "apps/command.hpp"
#include "apps/detect_request.hpp"
#include "apps/find_in_image.hpp"
#include "apps/log.hpp"
#include "apps/progress.hpp"
#include "apps/registries.hpp"
#include "apps/session.hpp"
#include "apps/write_detections.hpp"

namespace waymark {
namespace {

class Detect final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "detect",
            .group = Group::make,
            .summary = "Find craters, rocks or trees in one image",
            .about =
                "Works on any image GDAL reads, whatever its size, without a camera or a DEM. Results are "
                "pixels: "
                "(0, 0) is the centre of the first pixel, x to the right, y down. An orthophoto gives map "
                "units as "
                "well, and so does --gsd.\n\n"
                "CSV has the columns x, y, diameter, major, minor, angle (of the major axis, degrees from x "
                "towards "
                "y), confidence, then the features of the type in metres and radians where the size of a "
                "pixel is "
                "known, then map_x and map_y where the image is georeferenced. GeoJSON has the same as "
                "properties; "
                "a GeoPackage is a map like any other.\n\n"
                "The direction of the light is estimated from the image where it is not told. Heights of "
                "rocks need "
                "--sun-elevation and the size of a pixel.",
            .arguments = arguments(request_),
            .examples = {
                {"waymark detect craters mosaic.png -o craters.csv", "Pixels; the sun is estimated"},
                {"waymark detect rocks ortho.tif -o rocks.gpkg --sun-azimuth 270 --sun-elevation 30",
                 "A map with heights"},
                {"waymark detect rocks descent.png -o rocks.csv --image-sun-angle 135 --sun-elevation 25 "
                 "--gsd 0.05",
                 "Metres without a georeference"},
                {"waymark detect craters ctx.tif -o craters.geojson --method edges --min-confidence 0.8",
                 "Another method, the surer ones only"},
                {"waymark detect trees naip.tif -o trees.gpkg",
                 "Crowns in an RGB or RGB + near infrared image"}}};
  }

  int run(const Session& session) override {
    const DetectPlan plan = plan_of(request_);
    check_detection_output(request_.output);
    const auto started = std::chrono::system_clock::now();
    for (const std::string& warning : plan.warnings) log_warning(warning);
    FoundInImage found = find_in_image(plan, static_cast<int>(session.threads), progress_renderer(session));
    for (const std::string& warning : found.warnings) log_warning(warning);
    if (!found.light.empty()) say(found.light + "\n");
    write_detections(request_.output, found.detections, plan.image->info().path, session, started);
    say(fmt::format("{}: {} {}\n", request_.output, found.detections.detections.size(), request_.kind));
    return 0;
  }

 private:
  DetectRequest request_;
};

}  // namespace

void register_command_detect(CommandTable& commands);
void register_command_detect(CommandTable& commands) {
  commands.add<Detect>();
}

}  // namespace waymark
