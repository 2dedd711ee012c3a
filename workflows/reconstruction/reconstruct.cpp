// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/reconstruct.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "core/error.hpp"
#include "exporters/staging_folder.hpp"
#include "workflows/output_path.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
#include "workflows/reconstruction/posed_images.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

void check_request(const ReconstructRequest& request) {
  if (request.folder.empty())
    throw Error(ErrorCode::usage, "no folder is given for the products", "", "pass -o DIR");
  if (request.cameras.empty() && request.images.empty())
    throw Error(ErrorCode::usage, "neither images nor poses are given", "",
                "name a folder of images, or pass --cameras FILE");
  if (!request.cameras.empty() && !request.lens.empty())
    throw Error(ErrorCode::usage, "--lens and --cameras are both given, but poses come with their lens", "",
                "leave out --lens");
  if (!(request.cell >= 0 && std::isfinite(request.cell)))
    throw Error(ErrorCode::usage, fmt::format("--cell {} is not a size in metres", request.cell), "",
                "pass a number above 0, or leave it out");
  if (!request.map.empty()) {
    if (request.until != ReconstructUntil::ortho)
      throw Error(ErrorCode::usage, "--map-landmarks needs all products, but --until stops before them", "",
                  "leave out one or the other");
    check_map_output(request.map);
  }
}

void make_output_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) exporters::fail_output(folder, failed.message());
}

}  // namespace

ReconstructResult reconstruct(const ReconstructRequest& request, const Callbacks& callbacks) {
  check_request(request);
  const fs::path folder = request.folder;
  make_output_folder(folder);
  if (request.cameras.empty()) {
    const PosedPhotos made = pose_photos({.images = request.images,
                                          .folder = request.folder,
                                          .lens = request.lens,
                                          .crs = request.crs,
                                          .threads = request.threads},
                                         callbacks);
    return {.images = made.posed, .failed = made.failures.size()};
  }
  const PosedImages posed = read_posed_images(
      {.images = request.images, .cameras = request.cameras, .crs = request.crs}, callbacks);
  exporters::write_file(folder / "cameras.json", camera_file(posed));
  callbacks.summary(
      fmt::format("{}: {} images with poses\n", (folder / "cameras.json").string(), posed.images.size()));
  return {.images = posed.images.size()};
}

}  // namespace waymark::workflows
