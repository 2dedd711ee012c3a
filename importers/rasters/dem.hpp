// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>
#include "core/units.hpp"
#include "geo/dem_source.hpp"
namespace waymark::importers {

/// Input files of a DEM and options for reading them.
struct DemImport {
  std::vector<std::string> files =
      {};  ///< any path GDAL opens, `/vsi...` included; the first file has priority
  NodataPolicy nodata = NodataPolicy::ocean;
  std::string crs = {};   ///< replaces the files' own; "local": metres on no body; empty: the files' own
  std::int64_t band = 0;  ///< of the heights, from 1; 0: the only one
  std::string height_unit = {};  ///< replaces that of the band; empty: the band's
  double height_scale = 1;       ///< factor of all heights
  std::string area = {};         ///< file of polygons: the area of interest (DemSource::in_area); empty: all
  std::int64_t fill_distance = 100;  ///< cells; NodataPolicy::fill interpolates voids up to here from data
  std::int64_t memory_bytes = 0;     ///< for decoded blocks, all threads together; 0: dem_memory()
  Meters height_sd{0};               ///< of a height; 0: unknown
  bool metric = false;               ///< project a DEM in degrees to a plane in metres (metric_dem.hpp)
  bool inspect = true;  ///< compare seams, refuse a DEM without heights; false: open the headers only
};

/// A DEM in files that GDAL reads: one raster, or a mosaic of adjacent or overlapping ones.
class ImportedDem : public DemSource {
 public:
  /// Returns warnings, one line each, in a fixed order: seams that disagree, a constant DEM, an unknown
  /// height unit, a layout that is slow to read.
  virtual const std::vector<std::string>& warnings() const = 0;
  /// Returns whether a square of cells is read without whole rows of its file.
  virtual bool has_square_blocks() const = 0;
  /// Returns the options it was opened with; opening with them again gives the same heights.
  virtual const DemImport& import() const = 0;
};

/// Opens the files as one grid. Heights are in metres, whatever the scale, offset and unit of the band. A
/// cell that is no-data, masked, NaN or infinite has no height. South-up files are flipped.
/// - Distances from the body's centre, as in shape maps, become elevations above the sphere of the CRS's
///   equatorial radius, with a warning.
/// - Files must share CRS, cell size and alignment, within 1/1000 of a cell.
/// - Geographic files join across the antimeridian: x may then exceed 180, or be below -180.
/// - A grid in degrees or in a cylindrical projection that covers all longitudes wraps; columns that repeat
///   the first ones are dropped.
/// Throws Error for a file that is missing, damaged, rotated, without CRS or not a DEM; the hint names the
/// remedy. Costs about 1 ms per file, and with `inspect` the reading of the overlaps.
std::shared_ptr<const ImportedDem> import_dem(const DemImport& import);

/// Returns the number of bands of a raster. Throws Error{input} if GDAL does not read it.
int band_count(const std::string& path);

}  // namespace waymark::importers
