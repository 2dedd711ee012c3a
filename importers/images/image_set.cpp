// SPDX-License-Identifier: Apache-2.0
#include "importers/images/image_set.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <filesystem>
#include <utility>

#include "core/error.hpp"
#include "importers/cameras/scale_camera.hpp"
#include "importers/images/image_header.hpp"
#include "importers/images/image_pixels.hpp"
#include "importers/rasters/raster_handles.hpp"

namespace waymark::importers {
namespace {

// An image that opens its file when first read.
class FileImage final : public ImportedImage {
 public:
  FileImage(ImageInfo info, int band, std::shared_ptr<RasterHandles> files, std::size_t file,
            std::vector<std::string> warnings)
      : info_(std::move(info)),
        band_(band),
        files_(std::move(files)),
        file_(file),
        warnings_(std::move(warnings)) {}

  const ImageInfo& info() const override { return info_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  int band() const override { return band_; }

  Pixels read(const Window& window) const override {
    const RasterHandles::Lease dataset(*files_, file_);
    const GdalListener quiet;
    expect_as_listed(*dataset);
    return read_pixels(*dataset, window, band_, info_.path);
  }

 private:
  void expect_as_listed(GDALDataset& dataset) const {
    const bool same_size =
        dataset.GetRasterXSize() == info_.columns && dataset.GetRasterYSize() == info_.rows;
    std::vector<std::string> ignored;
    if (same_size && !info_.ortho) return;
    if (same_size)
      if (const auto now = orthophoto_georeference(dataset, info_.path, info_.crs.wkt2(), ignored);
          now && now->x0 == info_.ortho->x0 && now->y0 == info_.ortho->y0 && now->dx == info_.ortho->dx &&
          now->dy == info_.ortho->dy)
        return;
    if (info_.columns == 0)
      throw Error(ErrorCode::input,
                  "the image could not be read when the run listed it; see the warnings of load_images",
                  info_.path, "run again, or remove the image");
    throw Error(ErrorCode::input, "the image has changed since the run listed it: other size or georeference",
                info_.path, "run with --rerun-from load_images");
  }

  ImageInfo info_;
  int band_;
  std::shared_ptr<RasterHandles> files_;
  std::size_t file_;
  std::vector<std::string> warnings_;
};

std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

}  // namespace

std::shared_ptr<const ImportedImage> import_image(const std::string& path, const ImageImport& import) {
  const GdalDataset dataset = open_raster(path);
  const GdalListener quiet;
  const ImageHeader header = read_image_header(*dataset, path, import.band);
  ImageInfo info;
  info.name = name_of(path);
  info.path = path;
  info.columns = header.columns;
  info.rows = header.rows;
  info.view = import.view;
  info.sun = import.sun;
  info.image_sun_angle = import.image_sun_angle;
  info.gsd = import.gsd;
  info.saturated = import.saturated > 0 ? import.saturated : header.saturated;
  info.taken_utc = import.taken_utc;
  std::vector<std::string> warnings;
  if (import.view) {
    if (!import.crs.empty()) info.crs = Crs::from_text(import.crs);
    info.view->camera = scale_camera(info.view->camera, header.columns, header.rows, path, warnings);
  } else if (import.georeference) {
    info.ortho = orthophoto_georeference(*dataset, path, import.crs, warnings);
    if (info.ortho) info.crs = info.ortho->crs;
  }
  return std::make_shared<const FileImage>(std::move(info), import.band,
                                           std::make_shared<RasterHandles>(std::vector{path}), 0,
                                           std::move(warnings));
}

ImageSet image_set(const std::vector<ImageInfo>& images, int band) {
  std::vector<std::string> paths;
  for (const ImageInfo& image : images) paths.push_back(image.path);
  const auto files = std::make_shared<RasterHandles>(std::move(paths));
  ImageSet set;
  for (std::size_t i = 0; i < images.size(); ++i)
    set.push_back(std::make_shared<const FileImage>(images[i], band, files, i, std::vector<std::string>{}));
  return set;
}

}  // namespace waymark::importers
