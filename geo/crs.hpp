// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "geo/body.hpp"
namespace waymark::inline geo {

/// Kind of coordinates.
enum class CrsKind {
  geographic,  ///< x = longitude, y = latitude, degrees
  projected,   ///< x = easting, y = northing, in `metres_per_unit`
  local,       ///< x right, y up in metres, without a body: images, testbeds
};

/// Coordinate reference system of a body, immutable. x is easting or longitude, whatever the axis order of
/// the authority.
class Crs {
 public:
  /// Parses WKT 1 or 2, PROJJSON, a PROJ string or "AUTHORITY:CODE" (EPSG:4326, IAU_2015:49910).
  /// - A definition without a code gets the code of an identical catalogued CRS (GeoTIFF drops IAU codes).
  /// - A compound CRS gives its horizontal part.
  /// - Throws Error if PROJ does not understand the definition.
  static Crs from_text(std::string_view definition);
  static Crs local();

  CrsKind kind() const;
  const std::string& name() const;       ///< "WGS 84 / UTM zone 11N"
  const std::string& authority() const;  ///< "EPSG", "IAU_2015"; empty if none
  const std::string& code() const;       ///< "4326", "49910"; empty if none
  std::string id() const;                ///< "EPSG:4326", or the name without a code
  const std::string& wkt2() const;       ///< WKT2:2019, one line
  const std::string& wkt1() const;       ///< WKT1 (GDAL flavour); empty if not expressible
  double metres_per_unit() const;        ///< of a projected or local CRS; 0 for geographic
  const Body& body() const;              ///< of a geographic or projected CRS; unnamed for local

  /// Returns whether both define the same coordinates.
  bool same_as(const Crs& other) const;

 private:
  struct Definition;
  explicit Crs(std::shared_ptr<const Definition> definition);
  std::shared_ptr<const Definition> definition_;
};

/// Transformation of x, y between two CRSs of the same body. Not thread-safe: create one per thread (~1 ms).
class CrsTransform {
 public:
  /// Throws Error if the CRSs are of different bodies, or only one is local.
  CrsTransform(const Crs& from, const Crs& to);
  ~CrsTransform();
  CrsTransform(CrsTransform&&) noexcept;
  CrsTransform& operator=(CrsTransform&&) noexcept;

  /// Coordinates in the units of a CRS; x is easting or longitude.
  struct XY {
    double x = 0, y = 0;
  };
  /// Transforms a point; NaN, NaN if it has no image.
  XY operator()(double x, double y) const;
  /// Transforms points in place; x and y have equal length. About 3 M points/s for UTM.
  void apply(std::vector<double>& x, std::vector<double>& y) const;

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

/// Returns the geographic CRS (degrees) of the datum of `crs`; `crs` itself if it is geographic. Throws Error
/// for a local CRS.
Crs geographic_crs(const Crs& crs);

}  // namespace waymark::inline geo
