// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/dem_source.hpp"
namespace waymark {

/// Level ground that somebody assumed where there is no DEM: 40 000 km either way in cells of 40 km.
class PlaneDem final : public DemSource {
 public:
  /// `crs` is projected or local; height in metres. `height_sd`: of the real ground against the plane,
  /// metres; it makes places seen from the side uncertain.
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

/// Whether the heights are assumed and not measured.
bool is_assumed_plane(const DemSource& dem);

}  // namespace waymark
