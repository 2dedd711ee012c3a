// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "geo/dem_handle.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark {

/// Which rasters make the canopy model of one survey: heights above ground, or surface and terrain.
struct CanopyImport {
  std::vector<std::string> chm = {}, dsm = {}, dtm = {};
  std::string forest_type = {};  ///< raster of ForestType values on any grid; empty: none
  std::string crs = {};          ///< as DemImport::crs
  std::int64_t memory_bytes = std::int64_t{256} << 20;
  bool inspect = true;  ///< look at a sample of the heights; false: open the headers only
};

/// A canopy model on rasters that GDAL reads.
class ImportedCanopy : public CanopySource {
 public:
  virtual const std::vector<std::string>& warnings() const = 0;
  virtual const CanopyImport& import() const = 0;
  /// The terrain model; null where there is only a canopy height model.
  virtual DemHandle terrain() const = 0;
};

/// Opens them. Heights are metres; where the CRS is in feet and the band does not name its unit they are
/// taken as feet. Negative heights become 0, more than 150 m unknown. A terrain model on another grid is
/// interpolated bilinearly at the surface's cells. Throws Error{input} for a geographic CRS, rasters of
/// different CRSs, elevations where heights should be, and a terrain above its surface; what else is odd is
/// in warnings(). Files without a CRS are taken as metres on a plane, with a warning.
std::shared_ptr<const ImportedCanopy> import_canopy(const CanopyImport& import);

}  // namespace waymark
