// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>
#include "exporters/report/report_html.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/drive_statistics.hpp"
#include "localization/track_score.hpp"
#include "testbed/score.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A map or table of landmarks and the truth to compare it with, in one coordinate system.
struct LandmarkEvaluation {
  std::string result, truth;            ///< map, CSV or any layer of points
  std::string ignore = {};              ///< true objects that count neither way; empty: none
  std::string type = {};                ///< compare one landmark type; empty: all that the truth has
  std::string sensor = {};              ///< profile that weighs the quality of a map; empty: equal weights
  std::string match_by = "distance";    ///< "distance" or "overlap"
  double max_distance = 0.75;           ///< of a pair, in diameters
  double always_allowed_distance = 0;   ///< of a pair, in units of the positions
  double min_diameter = 0;              ///< smaller true objects are not evaluated
  double min_pixels = 3;                ///< true objects smaller than this in every image are not evaluated
  std::vector<double> size_edges = {};  ///< ascending diameters between which results are reported apart
};

/// Returns scores by landmark type; warns about types without a match. Throws Error{usage} for negative sizes
/// or types that cannot be paired, Error{input} for a table without positions.
std::map<std::string, testbed::Score> evaluate(const LandmarkEvaluation& request,
                                               const Callbacks& callbacks = {});

/// A track and the truth to compare it with.
struct TrackEvaluation {
  std::string track, truth;              ///< track.csv; a log with true poses or another track
  std::string align = "none";            ///< "none", "se2" or "sim2"
  importers::LogImport log_format = {};  ///< of a truth that is a log
  double max_gap = 0.5;                  ///< s between two true poses that may be interpolated
  std::string picture = {};              ///< .svg to draw; empty: none
  std::string map = {};                  ///< map that is drawn and whose frame the truth is put in
  std::vector<std::string> also = {};    ///< NAME=TRACK.csv: more tracks of the picture
};

/// Returns errors and consistency of a track, and draws the picture. Throws Error{input} if the truth has no
/// poses or no time in common with the track.
localization::TrackScore evaluate(const TrackEvaluation& request);

/// Returns the position errors of a track over time, without alignment. Throws as evaluate().
std::vector<localization::TrackErrorAt> track_errors(const TrackEvaluation& request);

/// Returns how far the confidence and quality of a map's landmarks agree with the truth, for a report.
std::vector<exporters::QualityCheck> check_quality(const std::string& map, const std::string& truth);

}  // namespace waymark::workflows
