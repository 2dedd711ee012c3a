// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/locate_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/options/option_reader.hpp"
#include "core/units.hpp"
#include "exporters/formatting.hpp"
#include "geo/crs.hpp"
#include "geodb/map_store.hpp"
#include "importers/tables/named_cells.hpp"
#include "importers/tables/table_number.hpp"
#include "workflows/localization/localize_method.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

using localization::BodyCrater;
using localization::CraterSearchOptions;
using localization::ImageCrater;
using localization::ImagePose;

constexpr double kAltitudeRange = 0.15;  // of a stated altitude

struct CraterMap {
  std::vector<BodyCrater> craters = {};
  std::vector<std::string> uids = {};
  Body body = {};
};

CraterMap read_craters(const LocateRequest& request) {
  const geodb::MapStore store = geodb::MapStore::open(request.map);
  if (store.crs().kind() == CrsKind::local)
    throw Error(ErrorCode::input, "the map is in a local CRS: it is on no body", request.map,
                "place it first: `waymark register --help`");
  const std::string& name = all_types()[find_type(all_types(), EvidenceModel::bowl).value()].name;
  const LandmarkType* const type = store.types().find(name);
  if (!type)
    throw Error(ErrorCode::input, "the map has no craters", request.map,
                "import a catalogue: `waymark import --help`");
  CraterMap map{.body = store.crs().body()};
  const localization::BodySurface surface(map.body);
  const Crs degrees = geographic_crs(store.crs());
  std::optional<CrsTransform> to_degrees;
  if (!degrees.same_as(store.crs())) to_degrees.emplace(store.crs(), degrees);
  const std::size_t size = feature_index(*type, type->body.feature);
  store.visit(type->name, [&](Landmark&& l) {
    const FeatureValue& radius = l.features.at(size);
    if (!radius.known() || !(radius.value > 0)) return;
    if (l.confidence < request.min_confidence) return;
    CrsTransform::XY at{l.position.xyz.x(), l.position.xyz.y()};
    if (to_degrees) at = (*to_degrees)(at.x, at.y);
    const double height = std::isfinite(l.position.xyz.z()) ? l.position.xyz.z() : 0;
    const double variance = (l.covariance(0, 0) + l.covariance(1, 1)) / 2;
    map.craters.push_back({.at = surface.point({at.x, at.y}, height),
                           .radius = type->body.radius_per_value * radius.value,
                           .sd = variance > 0 ? std::sqrt(variance) : 0});
    map.uids.push_back(l.uid);
  });
  if (map.craters.empty())
    throw Error(ErrorCode::input, "the map has no craters with a radius", request.map,
                "import a catalogue: `waymark import --help`");
  return map;
}

struct Detections {
  std::vector<ImageCrater> craters = {};  // from the middle of the image
  std::vector<std::int64_t> rows = {};
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
};

Detections read_detections(const std::string& file, const LocateRequest& request) {
  importers::NamedCells cells(file);
  const auto x = cells.find({"x"}), y = cells.find({"y"}), diameter = cells.find({"diameter"}),
             radius = cells.find({"radius"});
  if (!x || !y || (!diameter && !radius))
    throw Error(ErrorCode::input, "the table needs the columns x, y and diameter or radius, in pixels", file,
                "`waymark detect craters IMAGE -o OUT.csv` writes them");
  Detections out;
  while (cells.next()) {
    const auto number = [&](std::size_t column) {
      return importers::to_real(cells.text(column), cells.header().decimal_comma);
    };
    const auto at_x = number(*x), at_y = number(*y), size = number(diameter ? *diameter : *radius);
    if (!at_x || !at_y || !size || !(*size > 0))
      throw Error(ErrorCode::input, "a detection needs numbers, and a size above 0", cells.location(),
                  "remove or complete the line");
    out.craters.push_back({{*at_x, *at_y}, diameter ? *size / 2 : *size});
    out.rows.push_back(cells.row());
  }
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  if (request.size.size() == 2) {
    out.size = {request.size[0], request.size[1]};
    middle = (out.size - Eigen::Vector2d::Ones()) / 2;  // (0, 0) is the middle of the first pixel
  } else if (!out.craters.empty()) {
    Eigen::Vector2d low = out.craters[0].at, high = low;
    for (const ImageCrater& c : out.craters) low = low.cwiseMin(c.at), high = high.cwiseMax(c.at);
    middle = (low + high) / 2, out.size = high - low;
  }
  for (ImageCrater& c : out.craters) c.at -= middle;
  return out;
}

/// Turns a covariance from right and down of an image to east and north.
ImagePose::Covariance to_east_north(const ImagePose::Covariance& covariance, double azimuth) {
  ImagePose::Covariance turn = ImagePose::Covariance::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(azimuth), -std::sin(azimuth), -std::sin(azimuth), -std::cos(azimuth);
  return turn * covariance * turn.transpose();
}

LocatedImage located_image(const std::string& file, const Detections& seen,
                           const localization::CraterAnswer& answer, const localization::GroundCamera& camera,
                           const localization::BodySurface& surface) {
  LocatedImage image{.detections = file,
                     .located = answer.fix.has_value(),
                     .reason = std::string(answer.reason),
                     .wrong_probability = answer.wrong,
                     .detected = static_cast<std::int64_t>(seen.craters.size())};
  if (!answer.fix) return image;
  const localization::CraterFix& fix = *answer.fix;
  image.matched = fix.matched;
  image.residual_px = fix.residual;
  image.middle = surface.geodetic(fix.pose.ground).at;
  image.metres_per_pixel = std::exp(fix.pose.log_scale);
  image.azimuth = fix.pose.azimuth();
  image.tilt = fix.pose.tilt;
  image.covariance = to_east_north(fix.covariance, image.azimuth);
  if (const auto at = camera.position(fix.pose)) {
    const Geodetic above = surface.geodetic(*at);
    image.camera = above.at;
    image.altitude = above.height;
  } else {
    image.covariance.bottomRows<2>().setZero();
    image.covariance.rightCols<2>().setZero();
  }
  return image;
}

std::string text_of(const LocatedImage& image) {
  if (!image.located)
    return fmt::format(
        "{}: not located: {}; of {} craters; the best position is wrong with a probability of {:.2g}\n",
        image.detections, image.reason, image.detected, image.wrong_probability);
  const auto sd = [&](int k) { return std::sqrt(image.covariance(k, k)); };
  std::string text = fmt::format(
      "{}: middle at {:.6f}, {:.6f} ({:.2g}, {:.2g} m), {:.5g} m per pixel ({:.2g}), up is {:.3f} ({:.2g}) "
      "degrees from north",
      image.detections, image.middle.lon, image.middle.lat, sd(0), sd(1), image.metres_per_pixel,
      image.metres_per_pixel * sd(2), image.azimuth / kRadiansPerDegree, sd(3) / kRadiansPerDegree);
  if (image.altitude > 0)
    text += fmt::format(", camera {:.6g} m above {:.6f}, {:.6f}", image.altitude, image.camera.lon,
                        image.camera.lat);
  return text + fmt::format("; {} of {} craters match within {:.2f} px; wrong with a probability of {:.2g}\n",
                            image.matched, image.detected, image.residual_px, image.wrong_probability);
}

std::string positions_csv(const LocateResult& result) {
  std::string text =
      "detections,located,lon,lat,metres_per_pixel,azimuth_deg,tilt_x_deg,tilt_y_deg,camera_lon,camera_lat,"
      "altitude_m,var_east,var_north,cov_east_north,scale_sd,azimuth_sd_deg,matched,detected,residual_px,"
      "wrong_probability,reason\n";
  for (const LocatedImage& i : result.images) {
    text += exporters::csv_text(i.detections) + (i.located ? ",1" : ",0");
    if (i.located) {
      text += fmt::format(",{:.9f},{:.9f},{:.8g},{:.5f},{:.5f},{:.5f}", i.middle.lon, i.middle.lat,
                          i.metres_per_pixel, i.azimuth / kRadiansPerDegree, i.tilt.x() / kRadiansPerDegree,
                          i.tilt.y() / kRadiansPerDegree);
      text += i.altitude > 0 ? fmt::format(",{:.9f},{:.9f},{:.8g}", i.camera.lon, i.camera.lat, i.altitude)
                             : ",,,";
      text += fmt::format(",{:.6g},{:.6g},{:.6g},{:.4g},{:.4g}", i.covariance(0, 0), i.covariance(1, 1),
                          i.covariance(0, 1), i.metres_per_pixel * std::sqrt(i.covariance(2, 2)),
                          std::sqrt(i.covariance(3, 3)) / kRadiansPerDegree);
    } else {
      text += ",,,,,,,,,,,,,,";
    }
    text += fmt::format(",{},{},{:.4g},{:.4g},{}\n", i.matched, i.detected, i.residual_px,
                        i.wrong_probability, exporters::csv_text(i.reason));
  }
  return text;
}

/// Returns the settings of a request. Throws Error{usage} for values that contradict each other.
CraterSearchOptions search_options(const LocateRequest& request, const Callbacks& callbacks) {
  CraterSearchOptions options;
  const auto refuse = [](const std::string& problem, const std::string& where, const std::string& hint) {
    throw Error(ErrorCode::usage, problem, where, hint);
  };
  const DescribeOptions describe = [&](OptionVisitor& visitor) { options.describe(visitor); };
  for (const std::string& setting : request.set)
    for (const std::string& warning : set_option(describe, setting)) callbacks.warning(warning);
  if (!request.size.empty() && !(request.size.size() == 2 && request.size[0] > 0 && request.size[1] > 0))
    refuse("the size of images is not positive", "--size", "e.g. --size 1024 1024");
  if (!(request.focal >= 0)) refuse("the focal length is negative", "--focal", "give pixels");
  if (request.altitude != 0) {
    if (!(request.altitude > 0)) refuse("the altitude is not above 0 m", "--altitude", "give metres");
    if (!(request.focal > 0))
      refuse("an altitude gives no scale without the focal length", "--altitude", "give --focal in pixels");
    if (!request.scale.empty()) refuse("--altitude and --scale exclude each other", "", "give one of them");
    options.min_scale = request.altitude / request.focal * (1 - kAltitudeRange);
    options.max_scale = request.altitude / request.focal * (1 + kAltitudeRange);
  }
  if (!request.scale.empty()) {
    if (request.scale.size() != 2 || !(request.scale[0] > 0) || !(request.scale[1] > request.scale[0]))
      refuse("the scale takes two numbers, the smaller first", "--scale", "e.g. --scale 50 200");
    options.min_scale = request.scale[0], options.max_scale = request.scale[1];
  }
  return options;
}

/// Throws Error{usage} for an output that is an input.
void check_outputs(const LocateRequest& request) {
  std::vector<std::string> inputs = request.detections;
  inputs.push_back(request.map);
  for (const std::string& output : {request.output, request.matches}) keep_inputs(output, inputs);
}

}  // namespace

LocateResult locate_images(const LocateRequest& request, const Callbacks& callbacks) {
  const CraterSearchOptions options = search_options(request, callbacks);
  check_outputs(request);
  const CraterMap map = read_craters(request);
  const localization::CraterIndex index(map.craters, map.body, options);
  const localization::BodySurface surface(map.body);
  const localization::GroundCamera camera(request.focal);
  LocateResult result{.images = {}, .map_craters = static_cast<std::int64_t>(map.craters.size())};
  std::string matches = "detections,row,uid\n";
  for (const std::string& file : request.detections) {
    const Detections seen = read_detections(file, request);
    const localization::CraterAnswer answer =
        index.find({.craters = seen.craters, .size = seen.size, .camera = camera});
    result.images.push_back(located_image(file, seen, answer, camera, surface));
    callbacks.summary(text_of(result.images.back()));
    if (answer.fix)
      for (std::size_t i = 0; i < seen.craters.size(); ++i)
        if (const auto crater = answer.fix->craters[i])
          matches += fmt::format("{},{},{}\n", exporters::csv_text(file), seen.rows[i],
                                 exporters::csv_text(map.uids[*crater]));
  }
  if (!request.output.empty()) write_file(request.output, positions_csv(result));
  if (!request.matches.empty()) write_file(request.matches, matches);
  return result;
}

std::string locate_settings(const LocateRequest& request) {
  CraterSearchOptions options = search_options(request, {});
  return options_as_text(option_table([&](OptionVisitor& visitor) { options.describe(visitor); }));
}

}  // namespace waymark::workflows
