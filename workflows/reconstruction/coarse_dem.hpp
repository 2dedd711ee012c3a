// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include "geo/crs.hpp"
#include "geo/dem_source.hpp"
#include "pipeline/reconstruction/surface/coarse_heights.hpp"
#include "workflows/reconstruction/posed_images.hpp"
namespace waymark::workflows {

/// Coarse DEM in the grid frame of a map.
class CoarseDem {
 public:
  /// Opens the file. The map is that of the DEM if `map` is empty, or its UTM zone for a DEM in degrees on
  /// Earth. Throws Error{input} for a file that is no DEM, Error{usage} for degrees of another body.
  CoarseDem(std::string file, const std::optional<Crs>& map);

  const Crs& map() const { return map_; }
  /// Returns the bilinear height; not finite where it is unknown.
  double height(double x, double y) const;
  /// Returns the size of a cell of the file at a position, metres along x of the map.
  double cell(double x, double y) const;
  /// Returns the heights of an area; `side` is its width and height in metres. NaN: unknown.
  pipeline::CoarseHeights sample(const Eigen::Vector2d& middle, double side, std::int64_t nodes) const;
  /// Returns the heights of the whole DEM, with at most `nodes` cells across.
  pipeline::CoarseHeights sample_all(std::int64_t nodes) const;

 private:
  std::string file_;
  Crs map_ = Crs::local();
  std::shared_ptr<const DemSource> dem_;
  std::optional<CrsTransform> to_dem_;
  double unit_ = 1;
};

/// Reads the heights about posed images, at which the search for heights starts. Throws Error{input} for a
/// DEM that does not cover the images, or above which no camera lies.
pipeline::CoarseHeights read_coarse_dem(const std::string& file, const PosedImages& posed);

}  // namespace waymark::workflows
