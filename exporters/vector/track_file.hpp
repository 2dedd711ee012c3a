// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "geo/local_frame.hpp"
#include "localization/track.hpp"
namespace waymark::exporters {

struct TrackOutput {
  const LocalFrame* frame =
      nullptr;  ///< null: metres of the map frame; else positions and the axes of yaw and covariances are
                ///< those of the map's CRS; covariances stay in metres
  const Crs* crs = nullptr;  ///< of a GeoPackage, which is always in the map's CRS
  bool timing = false;       ///< write the duration of each update; differs from run to run
};

/// Writes a track as CSV: t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected, then wrong
/// (matches that contradict the log; empty if the log has no identities), lost (0 or 1), cov_x_yaw,
/// cov_y_yaw, nis and nis_rows; seconds, metres, radians; with `timing` also seconds_used. Positions in a CRS
/// of a body have the column crs, which names it. Staged and renamed. Throws Error{output}.
void write_track_csv(const std::filesystem::path& file, const localization::Track& track,
                     const TrackOutput& output = {});

/// Writes the same columns as points of a GeoPackage, layer `track`. Needs `output.frame` and `output.crs`.
void write_track_geopackage(const std::filesystem::path& file, const localization::Track& track,
                            const TrackOutput& output);

/// A track, and the CRS of its positions and axes.
struct TrackFile {
  localization::Track track;
  std::string crs = {};  ///< as Crs::from_text() takes it; empty: the map frame, or the file does not say
};

/// Reads such a CSV or GeoPackage, or a file of TUM (read_track_tum()), and sorts the rows by time. Columns
/// may be in any order, separated by commas, semicolons or tabs. t, x, y are required, others default to 0;
/// Track::named counts the matches where `wrong` is known. Throws Error{input} with the line.
TrackFile read_track_file(const std::filesystem::path& file);

/// Returns the track of such a file in the map frame. Positions in the map's CRS are converted by `frame`.
/// Throws Error{usage} for positions in a CRS if `frame` is null or of another CRS.
localization::Track read_track(const std::filesystem::path& file, const LocalFrame* frame);

}  // namespace waymark::exporters
