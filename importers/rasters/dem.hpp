// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>
#include "geo/dem_source.hpp"
namespace waymark {

/// Which files make a DEM, and how they are read.
struct DemImport {
  std::vector<std::string> files = {};  ///< anything GDAL opens, `/vsi...` too; the first one wins
  NodataPolicy nodata = NodataPolicy::ocean;
  std::string crs = {};  ///< instead of the files' own; "local": metres on no body; empty: as the files say
  std::int64_t memory_bytes = std::int64_t{512} << 20;  ///< for decoded blocks, all threads together
  double height_sd = 0;                                 ///< of a height, metres; 0: not known
  bool metric = false;  ///< a DEM in degrees is laid on a plane in metres (metric_dem.hpp)
  bool inspect = true;  ///< compare seams, refuse a DEM without heights; false: open the headers only
};

/// A DEM on files that GDAL reads: one raster, or a mosaic that touches or overlaps.
class ImportedDem : public DemSource {
 public:
  /// What a person should know: seams that disagree, a constant DEM, an unknown height unit, a layout that is
  /// slow to read. One line each, in a fixed order.
  virtual const std::vector<std::string>& warnings() const = 0;
  /// How it was opened; opening it so again gives the same heights.
  virtual const DemImport& import() const = 0;
};

/// Opens the files as one grid. Heights are in metres whatever the band's scale, offset and unit are; a cell
/// that is no-data, masked, NaN or infinite has no height. South-up files are turned.
///  - Distances from the body's centre, as shape maps hold them, become elevations above the sphere of the
///    CRS's equatorial radius, with a warning.
///  - Files must share CRS, cell size and alignment, within 1/1000 of a cell.
///  - Geographic files across the antimeridian join: x may then exceed 180, or be below -180.
///  - A grid in degrees or in a cylindrical projection that goes all the way round wraps; columns that
///    repeat the first ones are dropped.
/// Throws Error for a file that is missing, damaged, rotated, in no CRS or not a DEM; the hint says what
/// mends it. Costs about 1 ms per file, and with `inspect` the reading of what overlaps.
std::shared_ptr<const ImportedDem> import_dem(const DemImport& import);

}  // namespace waymark
