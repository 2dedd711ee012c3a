// SPDX-License-Identifier: Apache-2.0
#include "workflows/build_details.hpp"

#include <cpl_compressor.h>
#include <fmt/format.h>
#include <gdal.h>
#include <tbb/version.h>

#include <algorithm>
#include <string_view>

#include "geo/proj_version.hpp"
#include "geodb/library_versions.hpp"
#include "localization/ceres_version.hpp"
#include "pipeline/vision/opencv_version.hpp"

namespace waymark::workflows {
namespace {

std::string compiler() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

/// Returns the value of a line "KEY=value" of GDAL's build information; empty if it has none.
std::string gdal_build(std::string_view key) {
  const std::string lines = std::string("\n") + GDALVersionInfo("BUILD_INFO");
  const std::string start = fmt::format("\n{}=", key);
  const std::size_t at = lines.find(start);
  if (at == std::string::npos) return "";
  const std::size_t first = at + start.size();
  return lines.substr(first, lines.find('\n', first) - first);
}

}  // namespace

BuildDetails build_details() {
  std::string geos = gdal_build("GEOS_VERSION");  // "3.11.1-CAPI-1.17.1"
  geos.resize(std::min(geos.size(), geos.find('-')));
  return {.version = WAYMARK_VERSION,
          .compiler = compiler(),
          .build_type = WAYMARK_BUILD_TYPE,
          .processor = WAYMARK_PROCESSOR,
          .libraries = {{"gdal", GDALVersionInfo("RELEASE_NAME")},
                        {"geos", geos},
                        {"proj", proj_version()},
                        {"sqlite", geodb::sqlite_version()},
                        {"libpq", geodb::libpq_version()},
                        {"opencv", pipeline::opencv_version()},
                        {"ceres", localization::ceres_version()},
                        {"tbb", TBB_runtime_version()}},
          .decompressors = {{"zstd", CPLGetDecompressor("zstd") != nullptr},
                            {"lz4", CPLGetDecompressor("lz4") != nullptr}}};
}

}  // namespace waymark::workflows
