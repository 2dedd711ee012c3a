// SPDX-License-Identifier: Apache-2.0
#include "importers/gdal_session.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <mutex>
#include <string_view>

#include "core/error.hpp"
#include "importers/raster_file_checks.hpp"
#include "importers/standard_input.hpp"

namespace waymark::importers {
namespace {

// Not every path names a file: "NETCDF:a.nc:height" and "<VRTDataset>..." only GDAL can check.
bool is_plain_path(const std::string& path) {
  return path.starts_with('/') || path.find_first_of(":<") == std::string::npos;
}

bool begins_like_las(const std::string& path) {
  char head[4] = {};
  VSILFILE* file = VSIFOpenL(path.c_str(), "rb");
  if (file == nullptr) return false;
  const bool is_las =
      VSIFReadL(head, 1, sizeof head, file) == sizeof head && std::string_view(head, sizeof head) == "LASF";
  VSIFCloseL(file);
  return is_las;
}

/// Returns what a file system says that must not be used; GDAL's drivers drop it.
std::string refusal_of_file_system(const std::string& path) {
  const GdalListener gdal;
  VSILFILE* const file = path.starts_with("/vsi") ? VSIFOpenL(path.c_str(), "rb") : nullptr;
  if (file != nullptr) VSIFCloseL(file);
  const std::string said = gdal.error_about(path);
  return said.find("--allow-network") == said.npos ? "" : said;
}

[[noreturn]] void refuse(const std::string& path, const std::string& said) {
  if (const std::string reason = refusal_of_file_system(path); !reason.empty())
    throw Error(ErrorCode::input, reason, path, "pass --allow-network if you trust what names the file");
  VSIStatBufL status;
  const bool exists = VSIStatL(path.c_str(), &status) == 0;
  if (!exists && is_plain_path(path))
    throw Error(ErrorCode::input, "there is no such file", path, "check the path");
  if (exists && status.st_size == 0 && !VSI_ISDIR(status.st_mode))
    throw Error(ErrorCode::input, "the file is empty", path, "fetch or write it again");
  if (begins_like_las(path))
    throw Error(ErrorCode::input, "these are laser points, no raster", path,
                "`waymark trees` reads them by --las; elsewhere a raster of heights is needed");
  throw Error(ErrorCode::input, "this is not a raster that GDAL reads" + (said.empty() ? "" : ": " + said),
              path, "`gdalinfo --formats` lists what can be read; a damaged file must be fetched again");
}

}  // namespace

void GdalClose::operator()(GDALDataset* dataset) const {
  const GdalListener quiet;
  GDALClose(dataset);
}

GdalListener::GdalListener() {
  CPLPushErrorHandlerEx(
      [](CPLErr level, CPLErrorNum, const char* text) {
        static_cast<GdalListener*>(CPLGetErrorHandlerUserData())->hear(level, text);
      },
      this);
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
}

void GdalListener::hear(int level, std::string_view text) {
  const auto says = [&](const char* words) { return text.find(words) != text.npos; };
  // libjpeg's words for a file that ends early, and for a segment of one that does; pixels after it are grey.
  const bool ends_early = says("remature end of") && says("libjpeg");
  // libtiff's words for a tag or a directory that cannot be read.
  const bool lacks_tags = says("IO error during reading of") || says("Failed to read directory");
  content_is_missing_ = content_is_missing_ || ends_early || lacks_tags;
  if ((level >= CE_Failure || ends_early || lacks_tags) && first_error_.empty())
    first_error_ = text.substr(0, text.find(" (this warning"));
}

GdalListener::~GdalListener() {
  CPLPopErrorHandler();
}

std::string GdalListener::error_about(const std::string& path) const {
  std::string text = first_error_;
  for (const std::string& start : {"`" + path + "' ", path + ", band 1: ", path + ": "})
    if (text.starts_with(start)) text.erase(0, start.size());
  while (text.ends_with('.') || text.ends_with('\n')) text.pop_back();
  std::ranges::replace(text, '\n', ' ');  // of the file, which GDAL repeats
  return text;
}

GdalDataset open_raster(const std::string& path) {
  const GdalListener gdal;
  GdalDataset dataset(GDALDataset::Open(seekable_path(path).c_str(),
                                        GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR));
  if (!dataset) refuse(path, gdal.error_about(path));
  if (gdal.content_is_missing())
    throw Error(ErrorCode::input, "a part of the header cannot be read: " + gdal.error_about(path), path,
                "the file is truncated or damaged: fetch or write it again");
  check_raster_file(*dataset, path);
  return dataset;
}

}  // namespace waymark::importers
