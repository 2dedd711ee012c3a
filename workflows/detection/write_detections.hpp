// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <string>
#include "exporters/vector/detections.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// Throws Error for an output whose name ends in none of .csv, .geojson, .json, .gpkg, or whose folder cannot
/// be written. Call it before any work is done.
void check_detection_output(const std::string& output);

/// Where detections are written, and what a map records about their origin.
struct DetectionOutput {
  std::string path;
  std::string image;  ///< file that was searched
  std::string command_line;
  std::chrono::system_clock::time_point started;
};

/// Writes detections in the format of the output's extension; a GeoPackage with the record of this run.
void write_detections(const exporters::ImageDetections& found, const DetectionOutput& output,
                      const Callbacks& callbacks = {});

}  // namespace waymark::workflows
