// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "geo/body.hpp"
namespace waymark {

enum class CrsKind {
  geographic,  ///< x = longitude, y = latitude, degrees
  projected,   ///< x = easting, y = northing, in `metres_per_unit`
  local,       ///< x right, y up in metres, on no body: images, testbeds
};

/// A coordinate reference system on some body, immutable. Always x = east or longitude first, whatever the
/// authority's axis order is.
class Crs {
 public:
  /// From WKT 1 or 2, PROJJSON, a PROJ string or "AUTHORITY:CODE" (EPSG:4326, IAU_2015:49910). A definition
  /// without a code that equals a catalogued one at 100 % confidence gets that code back (GeoTIFF drops IAU
  /// codes). Of a compound CRS the horizontal part is used. Throws Error if PROJ does not understand it.
  static Crs from_text(std::string_view definition);
  static Crs local();

  CrsKind kind() const;
  const std::string& name() const;       ///< "WGS 84 / UTM zone 11N"
  const std::string& authority() const;  ///< "EPSG", "IAU_2015"; empty if none
  const std::string& code() const;       ///< "4326", "49910"; empty if none
  std::string id() const;                ///< "EPSG:4326", or the name where there is no code
  const std::string& wkt2() const;       ///< WKT2:2019, one line
  const std::string& wkt1() const;       ///< WKT1 (GDAL flavour); empty where it cannot be expressed
  double metres_per_unit() const;        ///< of a projected or local CRS; 0 for geographic
  const Body& body() const;              ///< of a geographic or projected CRS; an empty name for local

  /// True if both describe the same coordinates.
  bool same_as(const Crs& other) const;

 private:
  struct Definition;
  explicit Crs(std::shared_ptr<const Definition> definition);
  std::shared_ptr<const Definition> definition_;
};

/// Converts x, y between two CRSs of the same body. Not shared between threads: make one per thread (~1 ms).
class CrsTransform {
 public:
  /// Throws Error naming both where they are on different bodies or one is local and the other is not.
  CrsTransform(const Crs& from, const Crs& to);
  ~CrsTransform();
  CrsTransform(CrsTransform&&) noexcept;
  CrsTransform& operator=(CrsTransform&&) noexcept;

  struct XY {
    double x = 0, y = 0;
  };
  /// NaN, NaN where the point has no image.
  XY operator()(double x, double y) const;
  /// In place, x and y of equal length; about 3 M points/s for UTM.
  void apply(std::vector<double>& x, std::vector<double>& y) const;

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

/// The geographic CRS (degrees) on the same datum as `crs`; `crs` itself where it is geographic.
/// Throws Error for a local CRS.
Crs geographic_of(const Crs& crs);

}  // namespace waymark
