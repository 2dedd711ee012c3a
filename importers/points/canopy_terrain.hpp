// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "importers/points/canopy.hpp"
#include "importers/rasters/dem.hpp"
namespace waymark::importers {

/// Opens `files`; `what` names them in messages. Heights are taken to be in the unit of the CRS if that is
/// not the metre and the band names none. Throws Error{input} for a geographic CRS.
std::shared_ptr<const ImportedDem> open_heights(const std::vector<std::string>& files,
                                                const CanopyImport& import, const char* what,
                                                std::vector<std::string>& warnings);

/// Returns the CRS to open a file with: "local", with a warning, if it names none.
std::string crs_for(const std::string& file, const std::string& crs, std::vector<std::string>& warnings);

/// Terrain model under a surface on another grid.
class CanopyTerrain {
 public:
  CanopyTerrain() = default;
  /// Opens import.dtm for a surface. Throws Error{input} if they are in different CRSs or do not overlap.
  CanopyTerrain(const CanopyImport& import, const GridGeometry& surface, std::vector<std::string>& warnings);

  bool is_open() const { return raster_ != nullptr; }
  DemHandle dem() const { return raster_; }
  /// Returns true if every cell of the surface lies within the grid of the terrain.
  bool covers_surface() const;
  /// Returns the elevation of the terrain at cells of the surface, metres; NaN if unknown. Bilinear between
  /// cells of another grid.
  Grid<float> at(const Window& window) const;

 private:
  Grid<float> between_cells(const Window& window) const;

  std::shared_ptr<const ImportedDem> raster_;
  GridGeometry surface_;
  bool same_grid_ = true;
};

}  // namespace waymark::importers
