// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/posed_images.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "importers/images/image_set.hpp"
#include "importers/images/list_images.hpp"

namespace waymark::workflows {
namespace {

using Json = nlohmann::ordered_json;

std::string some_names(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 5;
  const std::size_t shown = std::min(names.size(), kShown);
  std::string text =
      fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

Crs map_crs(const PosedImagesRequest& request, const std::vector<ImageInfo>& images) {
  const Crs crs = request.crs.empty()      ? images.front().crs
                  : request.crs == "local" ? Crs::local()
                                           : Crs::from_text(request.crs);
  if (crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, fmt::format("{} is in degrees; heights need metres", crs.id()),
                request.crs.empty() ? request.cameras : "--crs",
                "pass a projected CRS, e.g. --crs EPSG:32651");
  return crs;
}

Json json_matrix(const Eigen::MatrixXd& m) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(m(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

Json json_lens(const Camera& camera) {
  std::size_t used = camera.distortion.size();
  while (used > 0 && camera.distortion[used - 1] == 0) --used;
  Json lens{{"columns", camera.columns}, {"rows", camera.rows}, {"fx", camera.fx},
            {"fy", camera.fy},           {"cx", camera.cx},     {"cy", camera.cy}};
  if (camera.skew != 0) lens["skew"] = camera.skew;
  lens["lens"] = camera.lens == Camera::Lens::fisheye ? "fisheye" : "brown";
  lens["distortion"] = std::vector<double>(camera.distortion.begin(),
                                           camera.distortion.begin() + static_cast<std::ptrdiff_t>(used));
  return lens;
}

Json json_image(const ImageInfo& info) {
  const Eigen::Isometry3d& pose = info.view->grid_from_camera.transform;
  Json image{{"name", info.name}};
  image["centre"] = {pose.translation().x(), pose.translation().y(), pose.translation().z()};
  image["rotation"] = json_matrix(pose.linear());
  if (!info.view->covariance.isZero()) image["covariance"] = json_matrix(info.view->covariance);
  if (info.sun)
    image["sun"] = {{"azimuth", info.sun->azimuth.value},
                    {"elevation", info.sun->elevation.value},
                    {"sd", info.sun->sd.value}};
  if (!info.taken_utc.empty()) image["taken_utc"] = info.taken_utc;
  return image;
}

}  // namespace

PosedImages read_posed_images(const PosedImagesRequest& request, const Callbacks& callbacks) {
  importers::ImageListing listing{.files = request.images, .cameras = request.cameras};
  listing.import.crs = request.crs;
  const importers::ListedImages listed = importers::list_images(listing);
  for (const std::string& warning : listed.warnings) callbacks.warning(warning);
  std::vector<ImageInfo> posed;
  std::vector<std::string> dropped;
  for (const ImageInfo& image : listed.images)
    if (image.view && image.columns > 0)
      posed.push_back(image);
    else
      dropped.push_back(image.name);
  if (posed.size() < 2)
    throw Error(ErrorCode::input,
                fmt::format("heights need two images with poses, but {} of {} images {}", posed.size(),
                            listed.images.size(), posed.size() == 1 ? "has one" : "have one"),
                request.cameras,
                dropped.empty() ? "add images that overlap"
                                : fmt::format("no pose or not readable: {}", some_names(dropped)));
  return {.crs = map_crs(request, posed), .images = importers::image_set(posed)};
}

std::string camera_file(const PosedImages& posed) {
  Json file{{"waymark_cameras", 1}};
  const Crs& crs = posed.crs;
  file["frame"] = {{"axes", "grid"},
                   {"crs", crs.kind() == CrsKind::local ? "local"
                           : crs.authority().empty()    ? crs.wkt2()
                                                        : crs.id()}};
  file["cameras"] = Json::object();
  file["images"] = Json::array();
  std::vector<Camera> lenses;
  for (const ImageHandle& image : posed.images) {
    const Camera& camera = image->info().view->camera;
    const auto known = std::ranges::find(lenses, camera);
    const std::string name = fmt::format("lens_{}", known - lenses.begin() + 1);
    if (known == lenses.end()) {
      file["cameras"][name] = json_lens(camera);
      lenses.push_back(camera);
    }
    Json entry = json_image(image->info());
    entry["camera"] = name;
    file["images"].push_back(std::move(entry));
  }
  return file.dump(1) + "\n";
}

}  // namespace waymark::workflows
