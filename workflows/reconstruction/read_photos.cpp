// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/read_photos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.hpp"
#include "importers/cameras/camera_set.hpp"
#include "importers/gdal_session.hpp"
#include "importers/images/find_images.hpp"
#include "importers/images/image_header.hpp"
#include "importers/images/image_labels.hpp"
#include "importers/images/image_pixels.hpp"
#include "importers/images/sun_position.hpp"

namespace waymark::workflows {
namespace {

// Images that share a lens have equal keys.
auto lens_key(const Photo& photo) {
  return std::tuple(photo.metadata.columns, photo.metadata.rows, photo.metadata.camera,
                    std::lround(photo.metadata.focal));
}

Photo read_photo(const importers::FoundImage& found) {
  const importers::GdalDataset dataset = importers::open_raster(found.path);
  const importers::GdalListener quiet;
  Photo photo{.name = found.name,
              .path = found.path,
              .metadata = importers::read_photo_metadata(*dataset, found.path)};
  photo.saturated = importers::read_image_header(*dataset, found.path, 0).saturated;
  if (const auto taken = importers::time_taken(*dataset, ""); taken.utc)
    photo.taken_utc = importers::utc_text(*taken.utc);
  return photo;
}

pipeline::LensGuess guess_of(const Photo& photo, const std::vector<Camera>& known) {
  const importers::PhotoMetadata& m = photo.metadata;
  for (const Camera& camera : known)
    if (camera.columns == m.columns && camera.rows == m.rows) return {.camera = camera, .focal_sd = 0};
  return {.camera = {.columns = m.columns,
                     .rows = m.rows,
                     .fx = m.focal,
                     .fy = m.focal,
                     .cx = double(m.columns - 1) / 2,
                     .cy = double(m.rows - 1) / 2},
          .focal_sd = m.focal_sd};
}

std::vector<importers::FoundImage> thin_files(std::vector<importers::FoundImage> found,
                                              std::size_t max_images, const Callbacks& callbacks) {
  if (found.size() <= max_images) return found;
  std::vector<importers::FoundImage> kept;
  for (std::size_t i = 0; i < max_images; ++i) kept.push_back(found[i * found.size() / max_images]);
  callbacks.warning(
      fmt::format("{} of {} images are taken, evenly in the order of their names; pass fewer images to "
                  "choose them yourself",
                  max_images, found.size()));
  return kept;
}

}  // namespace

Photos read_photos(const PhotosRequest& request, const Callbacks& callbacks) {
  const std::vector<Camera> known =
      request.lens.empty() ? std::vector<Camera>{} : importers::import_lenses(request.lens);
  Photos out;
  for (const importers::FoundImage& found :
       thin_files(importers::find_images(request.images, nullptr, ""), request.max_images, callbacks))
    try {
      Photo photo = read_photo(found);
      if (photo.metadata.is_orthophoto) {
        out.unused.push_back({found.name, "it is an orthophoto (it has a georeference), not a picture"});
        continue;
      }
      out.photos.push_back(std::move(photo));
    } catch (const Error& error) {
      out.unused.push_back({found.name, error.problem()});
    }
  if (out.photos.size() < 2)
    throw Error(ErrorCode::input,
                fmt::format("{} usable image{} found, but poses need two or more that overlap",
                            out.photos.size(), out.photos.size() == 1 ? " is" : "s are"),
                request.images.empty() ? "" : request.images[0],
                out.unused.empty()
                    ? "name a folder with JPEG, TIFF or PNG images"
                    : fmt::format("not usable: {}: {}", out.unused[0].name, out.unused[0].reason));
  std::vector<const Photo*> first_of_lens;
  for (Photo& photo : out.photos) {
    const auto same =
        std::ranges::find_if(first_of_lens, [&](const Photo* p) { return lens_key(*p) == lens_key(photo); });
    photo.lens = static_cast<std::size_t>(same - first_of_lens.begin());
    if (same != first_of_lens.end()) continue;
    first_of_lens.push_back(&photo);
    out.lenses.push_back(guess_of(photo, known));
    if (!request.lens.empty() && out.lenses.back().focal_sd > 0)
      callbacks.warning(
          fmt::format("{} has {} x {} pixels, but {} has no lens of that size: it is calibrated instead",
                      photo.name, photo.metadata.columns, photo.metadata.rows, request.lens));
  }
  return out;
}

Pixels block_means(const std::function<Pixels(const Window&)>& read, std::int64_t columns, std::int64_t rows,
                   std::int64_t by) {
  if (by == 1) return read({0, 0, columns, rows});
  Pixels out(columns / by, rows / by);
  const std::int64_t strip = 64;
  for (std::int64_t top = 0; top < out.rows(); top += strip) {
    const std::int64_t count = std::min(strip, out.rows() - top);
    const Pixels full = read({0, top * by, columns, count * by});
    for (std::int64_t r = 0; r < count; ++r)
      for (std::int64_t c = 0; c < out.columns(); ++c) {
        float sum = 0;
        for (std::int64_t y = 0; y < by; ++y)
          for (std::int64_t x = 0; x < by; ++x) sum += full(c * by + x, r * by + y);
        out(c, top + r) = sum / static_cast<float>(by * by);
      }
  }
  return out;
}

int reduction_to(std::int64_t columns, std::int64_t rows, double max_pixels) {
  int factor = 1;
  while (double(columns / factor) * double(rows / factor) > max_pixels) ++factor;
  return factor;
}

ReducedPixels read_reduced(const Photo& photo, double max_pixels) {
  const std::int64_t columns = photo.metadata.columns, rows = photo.metadata.rows;
  const int factor = reduction_to(columns, rows, max_pixels);
  const importers::GdalDataset dataset = importers::open_raster(photo.path);
  const auto read = [&](const Window& window) {
    return importers::read_pixels(*dataset, window, 0, photo.path);
  };
  return {.pixels = block_means(read, columns, rows, factor), .factor = factor};
}

}  // namespace waymark::workflows
