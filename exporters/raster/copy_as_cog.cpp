// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/copy_as_cog.hpp"

#include <gdal_priv.h>
#include <tbb/global_control.h>

#include <array>
#include <string>

#include "core/output_error.hpp"

namespace waymark::exporters {

void copy_as_cog(GDALDataset& raster, AtomicFile& aside, const std::filesystem::path& path,
                 GdalMessages& messages) {
  const std::string threads =
      "NUM_THREADS=" +
      std::to_string(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  const std::array<const char*, 6> options{"COMPRESS=DEFLATE", "PREDICTOR=YES", "OVERVIEW_RESAMPLING=NEAREST",
                                           "BIGTIFF=IF_SAFER", threads.c_str(), nullptr};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("COG");
  GDALDatasetUniquePtr written(driver->CreateCopy(aside.path().c_str(), &raster, FALSE,
                                                  const_cast<char**>(options.data()), stop_after_failure,
                                                  &messages));
  if (written) written->FlushCache(true);
  if (!written || !messages.failures().empty())
    fail_output(path, messages.cause("not all of it was written"));
  written.reset();
  aside.commit();
}

}  // namespace waymark::exporters
