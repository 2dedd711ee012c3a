// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_control.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "geo/crs.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/ground_control.hpp"
#include "workflows/reconstruction/photo_positions.hpp"
#include "workflows/reconstruction/posed_images.hpp"

namespace waymark::workflows {
namespace {

Crs crs_of_points(const importers::GroundControl& found, const PhotoControlRequest& request) {
  const std::string& text = found.crs.empty() ? request.crs : found.crs;
  if (text.empty())
    throw Error(ErrorCode::input, "the control points have no CRS", request.points,
                "pass theirs by --crs, or write it on the first line of a gcp_list.txt");
  return text == "local" ? Crs::local() : Crs::from_text(text);
}

Crs crs_of_map(const PhotoControlRequest& request, const Crs& points, const Eigen::Vector3d& first) {
  if (!request.crs.empty()) {
    const Crs crs = request.crs == "local" ? Crs::local() : Crs::from_text(request.crs);
    if (crs.kind() != CrsKind::geographic) return crs;
    throw Error(ErrorCode::usage, fmt::format("{} is in degrees; poses need metres", crs.id()), "--crs",
                "pass a projected CRS, e.g. --crs EPSG:32651");
  }
  if (points.kind() != CrsKind::geographic) return points;
  if (points.body().name == earth().name) return Crs::from_text(importers::utm_zone(first.x(), first.y()));
  throw Error(ErrorCode::usage, fmt::format("the control points are in degrees of {}", points.body().name),
              request.points, "pass a projected CRS of that body by --crs");
}

void check_degrees(const importers::GroundControl& found, const Crs& crs, const std::string& file) {
  if (crs.kind() != CrsKind::geographic) return;
  for (const importers::GroundControlPoint& point : found.points)
    if (!(std::abs(point.position.y()) <= 90))
      throw Error(ErrorCode::input,
                  fmt::format("the latitude {} of the control point {} is beyond 90 degrees",
                              point.position.y(), point.name),
                  file, "longitude comes first, then latitude: they are probably exchanged");
}

// The pictures know roughly where they are: coordinates that fit only when exchanged are refused.
void check_exchange(const importers::GroundControl& found, const Crs& crs, const Photos& photos,
                    const std::string& file) {
  const auto middle = middle_of_positions(photos);
  if (!middle || crs.kind() == CrsKind::local || crs.body().name != earth().name) return;
  const CrsTransform to_degrees(crs, geographic_crs(crs));
  const Eigen::Vector3d& first = found.points.front().position;
  const auto as_given = to_degrees(first.x(), first.y()), exchanged = to_degrees(first.y(), first.x());
  if (degrees_apart({as_given.x, as_given.y}, *middle) < kLongestFlight) return;
  if (degrees_apart({exchanged.x, exchanged.y}, *middle) < kLongestFlight)
    throw Error(ErrorCode::input,
                "the two horizontal coordinates of the control points are exchanged: they fit the GPS "
                "positions of the images only the other way round",
                file, "easting or longitude comes first, then northing or latitude");
}

std::vector<pipeline::Mark> marks_in(const Photos& photos, const importers::GroundControlPoint& point,
                                     std::set<std::string>& unknown, std::vector<std::string>& warnings) {
  std::vector<pipeline::Mark> marks;
  for (const importers::GroundControlMark& mark : point.marks) {
    const auto image = picture_named(photos, mark.image);
    if (!image) {
      unknown.insert(mark.image);
      continue;
    }
    const importers::PhotoMetadata& m = photos.photos[*image].metadata;
    if (!(mark.pixel.minCoeff() >= -0.5 && mark.pixel.x() <= double(m.columns) - 0.5 &&
          mark.pixel.y() <= double(m.rows) - 0.5)) {
      warnings.push_back(
          fmt::format("the mark of control point {} at column {}, row {} is outside the image {} of {} x {} "
                      "pixels and was left out; check the order of column and row, and the size of the image",
                      point.name, mark.pixel.x(), mark.pixel.y(), mark.image, m.columns, m.rows));
      continue;
    }
    marks.push_back({.image = *image, .pixel = mark.pixel, .sd = mark.sd});
  }
  std::ranges::sort(marks, {}, &pipeline::Mark::image);
  return marks;
}

}  // namespace

std::optional<std::size_t> picture_named(const Photos& photos, const std::string& name) {
  const auto index = [&](auto&& same) -> std::optional<std::size_t> {
    const auto found = std::ranges::find_if(photos.photos, same);
    if (found == photos.photos.end()) return std::nullopt;
    return static_cast<std::size_t>(found - photos.photos.begin());
  };
  if (const auto exact = index([&](const Photo& p) { return p.name == name; })) return exact;
  const auto base = std::filesystem::path(name).filename();
  return index([&](const Photo& p) { return std::filesystem::path(p.name).filename() == base; });
}

PhotoControl photo_control(const PhotoControlRequest& request, const Photos& photos) {
  const importers::GroundControl found = importers::read_ground_control(request.points, request.marks);
  const Crs from = crs_of_points(found, request);
  check_degrees(found, from, request.points);
  check_exchange(found, from, photos, request.points);
  const Crs map = crs_of_map(request, from, found.points.front().position);
  std::optional<CrsTransform> transform;
  if (!from.same_as(map)) transform.emplace(from, map);
  const double unit = map.kind() == CrsKind::local ? 1 : map.metres_per_unit();

  PhotoControl out{.crs = text_of_crs(map)};
  std::set<std::string> unknown;
  std::size_t marks = 0;
  for (const importers::GroundControlPoint& point : found.points) {
    const Eigen::Vector3d& p = point.position;
    const auto at = transform ? (*transform)(p.x(), p.y()) : CrsTransform::XY{p.x(), p.y()};
    if (!std::isfinite(at.x) || !std::isfinite(at.y))
      throw Error(ErrorCode::input,
                  fmt::format("the control point {} at {}, {} is outside the area of {}", point.name, p.x(),
                              p.y(), map.id()),
                  request.points, "check its coordinates, the CRS of the points and --crs");
    pipeline::ControlPoint& control = out.points.emplace_back();
    control = {.name = point.name,
               .position = {at.x * unit, at.y * unit, std::isnan(p.z()) ? 0 : p.z()},
               .sd = point.sd,
               .marks = marks_in(photos, point, unknown, out.warnings),
               .check = point.check};
    if (std::isnan(p.z())) control.sd.z() = std::numeric_limits<double>::infinity();
    marks += control.marks.size();
  }
  if (marks == 0)
    throw Error(ErrorCode::input,
                fmt::format("none of the marks is in one of the {} images; the first names '{}'",
                            photos.photos.size(), unknown.empty() ? "none" : *unknown.begin()),
                request.marks.empty() ? request.points : request.marks,
                fmt::format("marks name images by their file names, e.g. {}", photos.photos[0].name));
  if (!unknown.empty())
    out.warnings.push_back(
        fmt::format("marks of control points in {} images that are not there were left out: {}",
                    unknown.size(), fmt::join(unknown, ", ")));
  return out;
}

std::string contradiction_of_positions(const PhotoControl& control, const Photos& photos) {
  const auto middle = middle_of_positions(photos);
  if (!middle) return "";
  const Crs crs = control.crs == "local" ? Crs::local() : Crs::from_text(control.crs);
  if (crs.kind() == CrsKind::local || crs.body().name != earth().name)
    return "the GPS positions of the images are not used: the control points are not on Earth's grid";
  const Eigen::Vector3d at = control.points.front().position / crs.metres_per_unit();
  const auto degrees = CrsTransform(crs, geographic_crs(crs))(at.x(), at.y());
  const LonLat truth{degrees.x, degrees.y};
  if (degrees_apart(*middle, truth) < kLongestFlight) return "";
  return fmt::format(
      "the GPS positions of the images are not used: they are {:.0f} km from the control points; {}",
      degrees_apart(*middle, truth) * 111, cause_of_distance(*middle, truth));
}

}  // namespace waymark::workflows
