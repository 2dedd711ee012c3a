// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "importers/gdal_session.hpp"
namespace waymark::importers {

/// EXIF values of a picture by GDAL's names and in its form: "EXIF_FocalLength" is "(8.8)".
struct ExifTags {
  std::map<std::string, std::string> values = {};

  /// Returns a value without blanks at its end; empty if there is none.
  std::string text(const std::string& name) const;
};

/// Reads the EXIF values of an open picture: those that GDAL reads, and of TIFF and PNG those that it leaves
/// in the file (all of PNG; make, model, orientation and time of TIFF). Damaged values count as absent.
ExifTags read_exif_tags(GDALDataset& dataset);

}  // namespace waymark::importers
