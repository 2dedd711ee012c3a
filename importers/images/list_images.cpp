// SPDX-License-Identifier: Apache-2.0
#include "importers/images/list_images.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>

#include <algorithm>

#include "core/error.hpp"
#include "importers/cameras/scale_camera.hpp"
#include "importers/gdal_session.hpp"
#include "importers/images/find_images.hpp"
#include "importers/images/image_header.hpp"
#include "importers/images/image_labels.hpp"
#include "importers/images/sun_position.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kNamed = 5;  // names in one warning

std::string joined_names(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kNamed);
  return fmt::format("{}{}",
                     fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                     names.size() > shown ? fmt::format(" and {} more", names.size() - shown) : "");
}

std::optional<CameraSet> read_cameras(const ImageListing& listing, std::vector<std::string>& warnings) {
  std::optional<CameraSet> all;
  if (listing.cameras.empty()) return all;
  const std::vector<std::string> files = expand_pattern(listing.cameras);
  if (files.empty())
    throw Error(ErrorCode::input, "no camera file matches the pattern", listing.cameras, "check the path");
  for (const std::string& file : files) {
    CameraSet set = import_cameras(file, listing.format, listing.import);
    for (const std::string& warning : set.warnings) warnings.push_back(warning);
    if (!all) {
      all = std::move(set);
      continue;
    }
    if (!set.crs.same_as(all->crs))
      throw Error(
          ErrorCode::input,
          fmt::format("the camera files are in different CRSs: {} and {}", all->crs.id(), set.crs.id()), file,
          "name the map's CRS in the option crs");
    for (ImageCamera& image : set.images) all->images.push_back(std::move(image));
  }
  return all;
}

class Lister {
 public:
  Lister(const ImageListing& listing, const std::optional<CameraSet>& cameras, ListedImages& out)
      : listing_(listing), cameras_(cameras), out_(out) {
    if (cameras_) crs_ = cameras_->crs;
    if (!listing.import.crs.empty()) crs_ = Crs::from_text(listing.import.crs);
  }

  void add(const FoundImage& found) {
    ImageInfo image;
    image.name = found.name;
    image.path = found.path;
    image.gsd = listing_.gsd;
    if (found.camera) image.taken_utc = found.camera->taken_utc;
    try {
      read_file(found, image);
    } catch (const Error& e) {
      broken_.push_back(fmt::format("{}: {}", found.name, e.problem()));
      image.columns = image.rows = 0;
    }
    out_.images.push_back(std::move(image));
  }

  void add_warnings() {
    if (!broken_.empty())
      out_.warnings.push_back(fmt::format("{} of {} images cannot be read and will fail: {}", broken_.size(),
                                          out_.images.size(), joined_names(broken_)));
    if (!unplaced_.empty())
      out_.warnings.push_back(fmt::format("{} of {} images have neither a pose nor a usable georeference: {}",
                                          unplaced_.size(), out_.images.size(), joined_names(unplaced_)));
    if (!local_times_.empty())
      out_.warnings.push_back(fmt::format(
          "the sun of {} images is unknown, because their EXIF times have no offset from UTC: pass "
          "time_zone, e.g. +08:00, or the sun itself: {}",
          local_times_.size(), joined_names(local_times_)));
  }

 private:
  void read_file(const FoundImage& found, ImageInfo& image) {
    const GdalDataset dataset = open_raster(found.path);
    const GdalListener quiet;
    const ImageHeader header = read_image_header(*dataset, found.path, static_cast<int>(listing_.band));
    image.columns = header.columns;
    image.rows = header.rows;
    image.saturated = listing_.saturated > 0 ? listing_.saturated : header.saturated;
    place(found, *dataset, image);
    const TimeTaken taken = time_taken(*dataset, listing_.time_zone);
    if (image.taken_utc.empty() && taken.utc) image.taken_utc = utc_text(*taken.utc);
    set_sun(found, taken, image);
  }

  void place(const FoundImage& found, GDALDataset& dataset, ImageInfo& image) {
    try {
      if (found.camera && found.camera->view) {
        image.crs = cameras_->crs;
        image.view = found.camera->view;
        image.view->camera =
            scale_camera(image.view->camera, image.columns, image.rows, found.path, out_.warnings);
        check_camera(image.view->camera, found.path, "", out_.warnings);
        return;
      }
      std::vector<std::string> warnings;
      image.ortho = orthophoto_georeference(dataset, found.path, "", warnings);
      for (std::string& warning : warnings) out_.warnings.push_back(std::move(warning));
      if (image.ortho) adopt(found, image);
    } catch (const Error& e) {
      image.view.reset();
      image.ortho.reset();
      unplaced_.push_back(fmt::format("{}: {} ({})", found.name, e.problem(), e.hint()));
      return;
    }
    if (!image.ortho)
      unplaced_.push_back(found.name + (found.camera ? " (not oriented in the camera file)" : ""));
  }

  // Uses one CRS for the whole set: the map's, else that of the first orthophoto.
  void adopt(const FoundImage& found, ImageInfo& image) {
    const Crs own = image.ortho->crs;
    if (own.kind() == CrsKind::local && crs_) image.ortho->crs = *crs_;
    if (!crs_) crs_ = image.ortho->crs;
    if (!image.ortho->crs.same_as(*crs_))
      throw Error(ErrorCode::input, fmt::format("the image is in {}, the map in {}", own.id(), crs_->id()),
                  found.path,
                  fmt::format("gdalwarp -t_srs '{}' -r cubic '{}' out.tif", crs_->id(), found.path));
    image.crs = *crs_;
  }

  void set_sun(const FoundImage& found, const TimeTaken& taken, ImageInfo& image) {
    image.image_sun_angle = listing_.image_sun_angle;
    image.sun = listing_.sun;
    using From = ImageListing::SunFrom;
    if (image.sun || image.image_sun_angle || listing_.sun_from == From::nothing) return;
    if (listing_.sun_from == From::all) {
      if (found.camera) {
        image.sun = found.camera->sun;
        image.image_sun_angle = found.camera->image_sun_angle;
      }
      if (!image.sun && !image.image_sun_angle) set_sun_from_label(found, image);
      if (image.sun || image.image_sun_angle) return;
    }
    set_sun_from_time(found, taken, image);
  }

  void set_sun_from_label(const FoundImage& found, ImageInfo& image) {
    const LabelSun label = label_sun(label_of(found.path));
    if (!label.image_angle) return;
    // Right is east in a north-up orthophoto, 90 deg clockwise from north.
    if (image.ortho && label.elevation)
      image.sun = Sun{.azimuth = Degrees{std::fmod(label.image_angle->value + 450, 360.0)},
                      .elevation = *label.elevation};
    else
      image.image_sun_angle = label.image_angle;
  }

  void set_sun_from_time(const FoundImage& found, const TimeTaken& taken, ImageInfo& image) {
    if (!image.view && !image.ortho) return;
    const bool earthly = image.crs.kind() != CrsKind::local && image.crs.body().name == earth().name;
    const auto time = utc_seconds(image.taken_utc);
    if (!time && !taken.local.empty() && earthly) local_times_.push_back(found.name);
    if (listing_.sun_from == ImageListing::SunFrom::time && !time)
      throw Error(
          ErrorCode::input,
          taken.local.empty()
              ? "the sun cannot be computed: the image has no time"
              : fmt::format("the sun cannot be computed: the time {} has no offset from UTC", taken.local),
          found.path, "pass time_zone, e.g. +08:00, or sun_azimuth and sun_elevation");
    if (!time || (!earthly && listing_.sun_from == ImageListing::SunFrom::all)) return;
    const auto [x, y] = middle_of(image);
    const Sun sun = sun_on_map(*time, image.crs, x, y);
    if (sun.elevation.value > 0)
      image.sun = sun;
    else
      out_.warnings.push_back(
          fmt::format("{}: the sun at {} is at {:.1f} deg, below the horizon, and is not used", found.name,
                      image.taken_utc, sun.elevation.value));
  }

  static CrsTransform::XY middle_of(const ImageInfo& image) {
    if (image.ortho)
      return {image.ortho->x(static_cast<double>(image.columns) / 2),
              image.ortho->y(static_cast<double>(image.rows) / 2)};
    const double unit = image.crs.metres_per_unit();
    return {image.view->centre().xyz.x() / unit, image.view->centre().xyz.y() / unit};
  }

  const ImageListing& listing_;
  const std::optional<CameraSet>& cameras_;
  ListedImages& out_;
  std::optional<Crs> crs_;
  std::vector<std::string> broken_, unplaced_, local_times_;
};

}  // namespace

ListedImages list_images(const ImageListing& listing) {
  if (listing.files.empty() && listing.cameras.empty())
    throw Error(ErrorCode::usage, "no images are given", "",
                "name images or their folder in files, or a camera file");
  ListedImages out;
  const auto cameras = read_cameras(listing, out.warnings);
  const auto found = find_images(listing.files, cameras ? &*cameras : nullptr, listing.cameras);
  if (found.empty())
    throw Error(ErrorCode::input, "there are no images",
                listing.files.empty() ? listing.cameras : listing.files[0],
                "folders are searched for .tif .png .jpg .pgm .img .jp2 ... files, without subfolders");
  Lister lister(listing, cameras, out);
  for (const FoundImage& image : found) lister.add(image);
  lister.add_warnings();
  return out;
}

}  // namespace waymark::importers
