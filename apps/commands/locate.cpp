// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "apps/console.hpp"
#include "core/units.hpp"
#include "workflows/localization/locate_image.hpp"

namespace waymark::apps {
namespace {

class Locate final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "locate",
        .group = Group::use,
        .summary = "Find where images were taken, by their craters alone",
        .about =
            "Compares craters detected in images that look nearly straight down with a map of the craters of "
            "a "
            "body. Position, direction and scale need not be known. Triangles of neighbouring craters, which "
            "are alike at any scale, propose positions; all craters of the image judge them. A position is "
            "accepted if its probability of being wrong is small.\n\n"
            "POSITIONS.csv has a row for each image: longitude and latitude of its middle (of the map's "
            "body), "
            "metres per pixel, direction of its upward edge from north, tilt, position and altitude of the "
            "camera with --focal, variances in metres, and the probability of being wrong.",
        .arguments =
            {file_word("MAP.gpkg", &request_.map, "Map with craters of a body, in any CRS of it"),
             Argument{"", "DETECTIONS...", &request_.detections,
                      "Tables of craters in pixels, one per image: columns x, y, and diameter or radius, as "
                      "`waymark detect craters` writes them"}
                 .needed()
                 .offering(Offer::file),
             Argument{"-o,--output", "POSITIONS.csv", &request_.output, "Positions to write"}.offering(
                 Offer::file),
             Argument{"--matches", "MATCHES.csv", &request_.matches,
                      "Crater of the map of each detection: detections, row, uid"}
                 .offering(Offer::file),
             Argument{"--size", "WIDTH HEIGHT", &request_.size, "Size of the images, pixels"}.or_else(
                 "the box of the detections"),
             Argument{"--focal", "PIXELS", &request_.focal,
                      "Focal length of a camera without distortion, whose axis passes through the middle of "
                      "the image"}
                 .or_else("images are orthophotos"),
             Argument{"--altitude", "METRES", &request_.altitude,
                      "Height of the camera above the surface, known to 15 %; needs --focal"}
                 .or_else("unknown"),
             Argument{"--scale", "MIN MAX", &request_.scale, "Smallest and largest metres per pixel"}.or_else(
                 "unknown"),
             Argument{"--min-confidence", "P", &request_.min_confidence,
                      "Use only craters of the map that exist with at least this probability, 0 to 1"}
                 .or_else("0"),
             Argument{"--set", "OPTION=VALUE", &request_.set,
                      "Change a setting of the search; may be repeated"},
             Argument{"--settings", "", &list_, "List all settings with their values; needs no map"}.alone(),
             format_option(&format_)},
        .examples = {{"waymark locate moon.gpkg craters.csv --size 1024 1024 --focal 1500 -o positions.csv",
                      "Where a camera over the Moon is"},
                     {"waymark locate moon.gpkg frame*.csv --size 1024 1024 --focal 1500 --altitude 100e3 "
                      "--format json",
                      "Frames from an altitude known to 15 %"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    if (list_) {
      std::cout << workflows::locate_settings(request_);
      return 0;
    }
    const workflows::LocateResult result =
        workflows::locate_images(request_, console_callbacks(session, format_));
    if (format_ == "json") print_images(result);
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {
        {"craters", ResultKind::integer, "Craters of the map"},
        {"located", ResultKind::integer, "Images that are located"},
        {"images", ResultKind::objects,
         "For each image: detections (file), located, reason, wrong_probability, detected, matched; if "
         "located also residual_px, lon_deg, lat_deg, metres_per_pixel, azimuth_deg, tilt_deg, covariance "
         "of east and north (m), ln of metres per pixel, azimuth and tilts (rad), and with --focal "
         "camera_lon_deg, camera_lat_deg, altitude_m"}};
  }

  static void print_images(const workflows::LocateResult& result) {
    nlohmann::ordered_json images = nlohmann::ordered_json::array();
    std::int64_t located = 0;
    for (const workflows::LocatedImage& image : result.images) {
      located += image.located;
      nlohmann::ordered_json one{
          {"detections", image.detections}, {"located", image.located},
          {"reason", image.reason},         {"wrong_probability", image.wrong_probability},
          {"detected", image.detected},     {"matched", image.matched}};
      if (image.located) {
        nlohmann::ordered_json covariance = nlohmann::ordered_json::array();
        const int parameters = image.altitude > 0 ? 6 : 4;
        for (int i = 0; i < parameters; ++i) {
          covariance.push_back(nlohmann::ordered_json::array());
          for (int j = 0; j < parameters; ++j) covariance.back().push_back(image.covariance(i, j));
        }
        one["residual_px"] = image.residual_px;
        one["lon_deg"] = image.middle.lon, one["lat_deg"] = image.middle.lat;
        one["metres_per_pixel"] = image.metres_per_pixel;
        one["azimuth_deg"] = image.azimuth / kRadiansPerDegree;
        one["tilt_deg"] = {image.tilt.x() / kRadiansPerDegree, image.tilt.y() / kRadiansPerDegree};
        one["covariance"] = covariance;
        if (image.altitude > 0) {
          one["camera_lon_deg"] = image.camera.lon, one["camera_lat_deg"] = image.camera.lat;
          one["altitude_m"] = image.altitude;
        }
      }
      images.push_back(one);
    }
    print_result(
        result_keys(),
        {{"craters", result.map_craters}, {"located", located}, {"images", ResultJson{images.dump()}}});
  }

  workflows::LocateRequest request_;
  std::string format_ = "text";
  bool list_ = false;
};

}  // namespace

void register_command_locate(CommandTable& commands);
void register_command_locate(CommandTable& commands) {
  commands.add<Locate>();
}

}  // namespace waymark::apps
