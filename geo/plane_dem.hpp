// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/dem_source.hpp"
namespace waymark::inline geo {

/// Horizontal plane assumed if there is no DEM: 40 000 km by 40 000 km, in cells of 40 km.
class PlaneDem final : public DemSource {
 public:
  /// `crs` is projected or local; height in metres. `height_sd` is the standard deviation of the true terrain
  /// from the plane, metres; it adds uncertainty to positions from oblique views.
  PlaneDem(const Crs& crs, double height, double height_sd);

  const GridGeometry& geometry() const override { return geometry_; }
  NodataPolicy nodata_policy() const override { return NodataPolicy::unknown; }
  HeightWindow read(const Window& window) const override;
  double height_sd() const override { return height_sd_; }
  std::vector<std::string> files() const override { return {}; }
  double height() const { return height_; }

 private:
  GridGeometry geometry_;
  double height_, height_sd_;
};

/// Returns whether the DEM is an assumed plane.
bool is_assumed_plane(const DemSource& dem);

}  // namespace waymark::inline geo
