// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "geo/dem_handle.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark {

/// Which files make the canopy model of one survey: heights above ground; surface and terrain; or laser
/// points.
struct CanopyImport {
  std::vector<std::string> chm = {}, dsm = {}, dtm = {}, las = {};
  double resolution = 0;         ///< of a canopy from points, metres; 0: by their density
  std::string forest_type = {};  ///< raster of ForestType values on any grid; empty: none
  std::string crs = {};          ///< as DemImport::crs
  std::string name = {};         ///< CanopySource::name; empty: the first file's, without folders
  std::int64_t memory_bytes = std::int64_t{256} << 20;
  bool inspect = true;  ///< look at a sample of the heights; false: open the headers only
};

/// A canopy model on files.
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

/// The same from LAS files, which make one catalogue: the canopy model of pipeline/forest/canopy_model.hpp,
/// made block by block when it is read, so that memory does not grow with the files. Noise (classes 7 and 18)
/// and withheld points are left out. Feet, horizontal and vertical, by the units the CRS names. Throws
/// Error{input} as read_las_header does, for a CRS in degrees and files of different CRSs. Where no point is
/// classified as ground it is sought (pipeline/forest/ground_filter.hpp), with a warning; Error{input} where
/// the points are too few for that.
std::shared_ptr<const ImportedCanopy> import_points(const CanopyImport& import);

}  // namespace waymark
