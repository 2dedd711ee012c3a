// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/read_photos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

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

using importers::KnownLenses;

constexpr std::size_t kNoLens = ~std::size_t{0};

/// Lenses that are known for pictures, and what of them applies.
class LensSource {
 public:
  explicit LensSource(const PhotosRequest& request)
      : file_(request.lens), readout_time_(request.readout_time) {
    if (!file_.empty()) known_ = importers::import_lenses(file_);
  }

  /// Returns the entry of a picture in the camera file, or null.
  const KnownLenses::Entry* entry(const Photo& photo) const { return find_entry(known_, photo.path); }

  /// Returns the index of the lens of a picture: that of its entry, else the only one of its size.
  std::size_t lens_of(const Photo& photo) const {
    const auto fits = [&](std::size_t i) {
      const Camera& camera = known_.lenses[i].camera;
      return camera.columns == photo.metadata.columns && camera.rows == photo.metadata.rows;
    };
    if (const auto* named = entry(photo); named && named->lens && fits(*named->lens)) return *named->lens;
    std::size_t found = kNoLens;
    for (std::size_t i = 0; i < known_.lenses.size(); ++i) {
      if (!fits(i)) continue;
      if (found != kNoLens) return kNoLens;
      found = i;
    }
    return found;
  }

  pipeline::LensGuess guess(const Photo& photo) const {
    const importers::PhotoMetadata& m = photo.metadata;
    if (const std::size_t i = lens_of(photo); i != kNoLens) {
      const importers::KnownLens& lens = known_.lenses[i];
      return {.camera = lens.camera,
              .focal_sd = 0,
              .readout_time = lens.readout_time > 0 ? lens.readout_time : readout_time_};
    }
    return {.camera = {.columns = m.columns,
                       .rows = m.rows,
                       .fx = m.focal,
                       .fy = m.focal,
                       .cx = double(m.columns - 1) / 2,
                       .cy = double(m.rows - 1) / 2},
            .focal_sd = m.focal_sd,
            .readout_time = readout_time_};
  }

  /// Returns why no lens of the file holds for a picture; empty: one does, or there is no file.
  std::string refusal(const Photo& photo) const {
    if (file_.empty() || lens_of(photo) != kNoLens) return {};
    const auto of_size = std::ranges::count_if(known_.lenses, [&](const importers::KnownLens& lens) {
      return lens.camera.columns == photo.metadata.columns && lens.camera.rows == photo.metadata.rows;
    });
    if (of_size > 1)
      return fmt::format(
          "{} has {} lenses for {} x {} pixels and does not name {}: its lens is calibrated instead", file_,
          of_size, photo.metadata.columns, photo.metadata.rows, photo.name);
    return fmt::format("{} has {} x {} pixels, but {} has no lens of that size: it is calibrated instead",
                       photo.name, photo.metadata.columns, photo.metadata.rows, file_);
  }

  /// Returns what of the file does not apply to the pictures; empty: all does, or nothing names images.
  std::string unused_entries(const std::vector<Photo>& photos) const {
    std::size_t named = 0;
    std::set<const KnownLenses::Entry*> used;
    for (const Photo& photo : photos)
      if (const auto* e = entry(photo)) ++named, used.insert(e);
    const std::size_t absent = known_.images.size() - used.size();
    if (file_.empty() || absent == 0) return {};
    std::string first;
    for (const KnownLenses::Entry& e : known_.images)
      if (first.empty() && !used.contains(&e)) first = e.image;
    return fmt::format("{}: its lens is used; {} of the {} images that it names are not here, e.g. {}\n",
                       file_, absent, known_.images.size(), first);
  }

 private:
  std::string file_;
  double readout_time_;
  KnownLenses known_ = {};
};

// Images that share a lens have equal keys.
auto lens_key(const Photo& photo, const LensSource& lenses) {
  return std::tuple(photo.metadata.columns, photo.metadata.rows, photo.metadata.camera,
                    std::lround(photo.metadata.focal), lenses.lens_of(photo));
}

Photo read_photo(const importers::FoundImage& found) {
  const importers::GdalDataset dataset = importers::open_raster(found.path);
  const importers::GdalListener quiet;
  Photo photo{.name = found.name,
              .path = found.path,
              .metadata = importers::read_photo_metadata(*dataset, found.path)};
  photo.saturated = importers::read_image_header(*dataset, found.path, 0).saturated;
  const importers::TimeTaken taken = importers::time_taken(*dataset, "");
  if (taken.utc) photo.taken_utc = importers::utc_text(*taken.utc);
  photo.time = taken.clock;
  return photo;
}

// Returns why a picture is no view of a camera; empty if it is.
std::string refusal_of_picture(const importers::PhotoMetadata& m) {
  if (m.is_orthophoto) return "it is an orthophoto (it has a georeference), not a picture";
  if (const int o = m.orientation; o == 2 || o == 4 || o == 5 || o == 7)
    return fmt::format(
        "it is stored as a mirror image (EXIF orientation {}): write it upright, e.g. by `exiftran -a`, or "
        "correct the orientation",
        o);
  return {};
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

// A rolling shutter can only be modelled with the times between images.
void warn_of_missing_times(const Photos& photos, const Callbacks& callbacks) {
  std::size_t rolling = 0, untimed = 0;
  for (const Photo& photo : photos.photos) {
    if (!(photos.lenses[photo.lens].readout_time > 0)) continue;
    ++rolling;
    untimed += !photo.time;
  }
  if (untimed > 0)
    callbacks.warning(fmt::format(
        "{} of {} images of a rolling shutter have no time of exposure, and count as taken at once: "
        "write EXIF times, or taken_utc into the camera file of --lens",
        untimed, rolling));
}

}  // namespace

Photos read_photos(const PhotosRequest& request, const Callbacks& callbacks) {
  const LensSource known(request);
  Photos out;
  for (const importers::FoundImage& found :
       thin_files(importers::find_images(request.images, nullptr, ""), request.max_images, callbacks))
    try {
      Photo photo = read_photo(found);
      if (std::string refusal = refusal_of_picture(photo.metadata); !refusal.empty()) {
        out.unused.push_back({found.name, std::move(refusal)});
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
    if (const auto* entry = known.entry(photo); entry && !photo.time)
      photo.time = importers::utc_seconds(entry->taken_utc);
    const auto same = std::ranges::find_if(
        first_of_lens, [&](const Photo* p) { return lens_key(*p, known) == lens_key(photo, known); });
    photo.lens = static_cast<std::size_t>(same - first_of_lens.begin());
    if (same != first_of_lens.end()) continue;
    first_of_lens.push_back(&photo);
    out.lenses.push_back(known.guess(photo));
    if (const std::string refusal = known.refusal(photo); !refusal.empty()) callbacks.warning(refusal);
  }
  if (const std::string unused = known.unused_entries(out.photos); !unused.empty()) callbacks.summary(unused);
  warn_of_missing_times(out, callbacks);
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
