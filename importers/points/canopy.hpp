// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/options/memory_option.hpp"
#include "geo/canopy_source.hpp"
#include "geo/dem_handle.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::importers {

/// Input files of the canopy model of one survey: heights above ground; surface and terrain; or laser points,
/// with or without a terrain model.
struct CanopyImport {
  std::vector<std::string> chm = {}, dsm = {}, dtm = {}, las = {};
  double resolution = 0;         ///< of a canopy from points, metres; 0: by their density
  double ground_square = 20;     ///< GroundRules::square where no point is classified as ground, metres
  std::string forest_type = {};  ///< raster of ForestType values on any grid; empty: none
  std::string crs = {};          ///< as in DemImport
  std::string area = {};         ///< file of polygons: the area of interest; empty: all
  std::string name = {};         ///< CanopySource::name; empty: that of the first file, without folders
  std::int64_t memory_bytes = MemoryOption{}.bytes();
  bool inspect = true;  ///< check a sample of the heights; false: open the headers only
};

/// A canopy model in files.
class ImportedCanopy : public CanopySource {
 public:
  virtual const std::vector<std::string>& warnings() const = 0;
  virtual const CanopyImport& import() const = 0;
  /// Returns the terrain model; null if there is a canopy height model only.
  virtual DemHandle terrain() const = 0;
  bool in_area(double x, double y) const final { return !area_ || area_->contains(x, y); }

 protected:
  /// Reads the area of interest of import(), if it has one, in the CRS of geometry().
  void read_area();

 private:
  std::optional<Area> area_;
};

/// Opens the files as one canopy model. Heights are metres.
/// - Heights are taken as feet if the CRS is in feet and the band names no unit.
/// - Negative heights become 0, heights above 150 m unknown.
/// - A terrain model on another grid is interpolated bilinearly at the cells of the surface.
/// - Files without a CRS are taken as metres on a plane, with a warning.
/// Throws Error{input} for a geographic CRS, rasters of different CRSs, elevations instead of heights, and a
/// terrain above its surface. Other irregularities are in warnings().
std::shared_ptr<const ImportedCanopy> import_canopy(const CanopyImport& import);

/// Opens LAS files as one catalogue: the canopy model of pipeline/forest/canopy_model.hpp, computed block by
/// block when read, so that memory does not grow with the files.
/// - Noise (classes 7 and 18) and withheld points are excluded.
/// - Feet, horizontal and vertical, follow the units of the CRS.
/// - With `dtm` heights are above that terrain model, whatever the classes of the points. A terrain that lies
///   more than 10 m apart from the ground of the laser is refused, more than 1 m is a warning.
/// - Else, if no point is classified as ground, ground points are found by pipeline/forest/ground_filter.hpp,
///   with a warning.
/// Throws Error{input} as read_las_header does, for a CRS in degrees, files of different CRSs, and too few
/// points to find the ground.
std::shared_ptr<const ImportedCanopy> import_points(const CanopyImport& import);

}  // namespace waymark::importers
