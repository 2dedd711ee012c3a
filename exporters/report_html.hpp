// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>
#include "exporters/report/quality_section.hpp"
namespace waymark {

struct ReportOptions {
  std::string title = {};                 ///< empty: the name of the map file
  std::int64_t relief_pixels = 1200;      ///< longer side of the relief picture
  std::int64_t top = 25;                  ///< landmarks listed per type
  std::int64_t images = 4;                ///< images shown with what was found in them
  std::vector<QualityCheck> checks = {};  ///< comparisons with the truth
};

/// Writes a report of `map` as one HTML file that needs nothing else: no network, no script, no other file.
/// It shows a shaded-relief map with the landmarks, the foremost landmarks of each type, histograms, the
/// size-frequency distribution of craters, how good the landmarks are, images with what was found in them,
/// what the run read and did, and its warnings. The relief is drawn from the DEM inside the map, else from
/// the run's input files where they are still there and have not grown, else a graticule takes its place. A
/// huge DEM costs no more than a small one: it is read at the picture's resolution. The same map gives the
/// same bytes. Written aside and renamed; an existing report is replaced. Throws Error where the map cannot
/// be read or the report cannot be written.
void write_report(const std::filesystem::path& map, const std::filesystem::path& html,
                  const ReportOptions& options = {});

}  // namespace waymark
