// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>
namespace waymark::exporters {

/// A bin of a reliability diagram: landmarks of about the same claimed probability, and how many are correct.
struct ReliabilityBin {
  double mean = 0;  ///< of the claimed probabilities, [0, 1]
  int found = 0, right = 0;
};

/// Calibration of one claim of one type against the truth.
struct QualityCheck {
  std::string type;
  std::string claim;  ///< "confidence" or "quality"
  std::vector<ReliabilityBin> bins;
  double expected_error = 0;  ///< mean |claimed - right| over the landmarks
};

/// Contents of a report.
struct ReportOptions {
  std::string title = {};                 ///< empty: the name of the map file
  std::int64_t relief_pixels = 1200;      ///< longer side of the relief picture
  std::int64_t top = 25;                  ///< landmarks listed per type
  std::int64_t images = 4;                ///< images shown with their observations
  std::vector<QualityCheck> checks = {};  ///< comparisons with the truth
  /// Whether map and tables react to the pointer (zoom, filter, sort), by a script inside the page.
  bool interactive = false;
};

/// Writes a report of `map` as one HTML file without external references, and without scripts unless it is
/// interactive; it can be read and printed without running them. It shows:
/// - a shaded-relief map with the landmarks, the foremost landmarks of each type, histograms;
/// - the size-frequency distribution of craters, quality of the landmarks, images with their observations;
/// - inputs, stages and warnings of the run.
/// Relief and errors:
/// - The relief comes from the DEM inside the map, else from the run's input files if they have not changed.
///   Without either, a graticule is drawn.
/// - A DEM is read at the picture's resolution, so its size does not matter. The same map gives the same
///   bytes.
/// - The report is staged and renamed; an existing one is replaced.
/// - Throws Error if the map cannot be read or the report cannot be written.
void write_report(const std::filesystem::path& map, const std::filesystem::path& html,
                  const ReportOptions& options = {});

}  // namespace waymark::exporters
