// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>
#include "apps/session.hpp"
#include "exporters/detections.hpp"
namespace waymark {

/// Refuses, before any work is done, an output whose name ends in none of .csv, .geojson, .json, .gpkg or
/// whose folder cannot be written. Throws Error.
void check_detection_output(const std::string& output);

/// Writes what was found in the image at `path`, in the format the output's name ends in; a GeoPackage with
/// the record of this run.
void write_detections(const std::string& output, const ImageDetections& found, const std::string& path,
                      const Session& session, std::chrono::system_clock::time_point started);

}  // namespace waymark
