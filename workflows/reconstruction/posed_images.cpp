// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/posed_images.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/error.hpp"
#include "exporters/cameras/camera_file.hpp"
#include "importers/images/image_set.hpp"
#include "importers/images/list_images.hpp"

namespace waymark::workflows {
namespace {

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

}  // namespace

PosedImages read_posed_images(const PosedImagesRequest& request, const Callbacks& callbacks) {
  importers::ImageListing listing{.files = request.images, .cameras = request.cameras};
  listing.import.crs = request.crs;
  listing.import.camera_crs = request.tie.camera_crs;
  listing.import.control_points = request.tie.control_points;
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
  return {
      .crs = map_crs(request, posed), .images = importers::image_set(posed), .unposed = std::move(dropped)};
}

std::string text_of_crs(const Crs& crs) {
  return crs.kind() == CrsKind::local ? "local" : crs.authority().empty() ? crs.wkt2() : crs.id();
}

std::string camera_file(const PosedImages& posed) {
  exporters::CameraFileContent content;
  content.crs = text_of_crs(posed.crs);
  for (const ImageHandle& handle : posed.images) {
    const ImageInfo& info = handle->info();
    const auto lens =
        std::ranges::find(content.lenses, info.view->camera, &exporters::CameraFileLens::camera) -
        content.lenses.begin();
    if (lens == std::ssize(content.lenses)) content.lenses.push_back({info.view->camera});
    exporters::CameraFileImage& image = content.images.emplace_back();
    image.name = info.name;
    image.lens = static_cast<std::size_t>(lens);
    image.world_from_camera = info.view->grid_from_camera.transform;
    if (!info.view->covariance.isZero()) image.covariance = info.view->covariance;
    image.motion = info.view->motion;
    image.sun = info.sun;
    image.taken_utc = info.taken_utc;
  }
  return exporters::camera_file_text(content);
}

}  // namespace waymark::workflows
