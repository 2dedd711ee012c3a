// SPDX-License-Identifier: Apache-2.0
#include "exporters/records/map_extent.hpp"

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "core/error.hpp"

namespace waymark::exporters {
namespace {

[[noreturn]] void refuse(const std::string& map) {
  throw Error(ErrorCode::input, std::string("the extent of the map cannot be read: ") + CPLGetLastErrorMsg(),
              map, "check the disk, and the map with `waymark validate`");
}

}  // namespace

std::optional<MapBox> map_extent(const std::string& map) {
  GDALAllRegister();
  CPLErrorReset();
  const GDALDatasetUniquePtr file(GDALDataset::Open(map.c_str(), GDAL_OF_VECTOR));
  if (!file) refuse(map);
  OGRLayer* found = file->ExecuteSQL(
      "SELECT min(min_x), min(min_y), max(max_x), max(max_y) FROM gpkg_contents WHERE min_x IS NOT NULL",
      nullptr, nullptr);
  if (!found) refuse(map);
  std::optional<MapBox> box;
  for (const auto& row : *found)
    if (row->IsFieldSetAndNotNull(0))
      box = MapBox{row->GetFieldAsDouble(0), row->GetFieldAsDouble(1), row->GetFieldAsDouble(2),
                   row->GetFieldAsDouble(3)};
  file->ReleaseResultSet(found);
  if (CPLGetLastErrorType() >= CE_Failure) refuse(map);
  return box;
}

}  // namespace waymark::exporters
