// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>
namespace waymark::exporters {

/// Which landmarks are exported, and how.
struct ExportOptions {
  std::string driver = {};  ///< OGR driver, e.g. "FlatGeobuf"; empty: by the extension of the output
  std::vector<std::string> types = {};  ///< landmark types; empty: all the map has
  std::string crs =
      {};  ///< any text Crs understands; empty: the map's, or EPSG:4326 if the format requires it
  /// Whether the position of a landmark in the map's CRS is inside the area of interest; empty: everywhere.
  std::function<bool(double x, double y)> inside = {};
  double min_confidence = 0;            ///< leaves out landmarks of less, and of none, if above 0
  bool overwrite = false;               ///< false: an existing output is an error
  std::vector<std::string> label = {};  ///< values of a PDS4 label, "NAME=VALUE"
  /// That GDAL may take for a format it does not write in pieces: a FlatGeobuf that would take more has no
  /// spatial index, others give a warning.
  std::int64_t max_megabytes = 300;
  double area_km2 = 0;  ///< counting area of a crater count (.scc, .diam); 0: that of the map
};

/// Landmarks written of one type.
struct ExportedLayer {
  std::string type;
  std::int64_t landmarks = 0;
};

/// What an export wrote.
struct ExportSummary {
  std::string driver;  ///< OGR's short name of the format written
  std::string crs;     ///< Crs::id() of the coordinates written
  std::vector<ExportedLayer> layers;
  std::vector<std::string> files;     ///< written: more than one for single-layer formats
  std::vector<std::string> warnings;  ///< losses of the format, e.g. column names cut to ten letters
};

/// Writes the landmarks of `map` as `out`, in any vector format of this GDAL.
/// - The result is staged in the output's own folder and renamed, so a failure leaves an older output
///   unchanged. A `/vsi...` output is written in place.
/// - A GeoPackage is a map again, with evidence, images, shape layers and the latest run of these landmarks.
/// - Single-layer formats (CSV, Shapefile, FlatGeobuf, GeoJSON) get `out` for a map of one type and
///   `<stem>_<type>.<ext>` for each of several.
/// Throws Error for an unknown type, driver or CRS; a format that cannot hold the CRS or points; a CRS of
/// another body; an output that exists, cannot be written, or does not fit on the disk.
/// Writes 20 k landmarks/s to GeoJSON, 150 k/s to GeoPackage, 190 k/s to FlatGeobuf, including the check
/// (2-core machine under load). Memory does not grow with the landmarks, except for GeoPackage and where GDAL
/// holds a format whole: 220 bytes a landmark for FlatGeobuf's index, 500 to 670 for ODS and XLSX.
ExportSummary export_map(const std::filesystem::path& map, const std::string& out,
                         const ExportOptions& options = {});

}  // namespace waymark::exporters
