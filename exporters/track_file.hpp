// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "geo/local_frame.hpp"
#include "localization/track.hpp"
namespace waymark {

struct TrackOutput {
  const LocalFrame* frame = nullptr;  ///< with it, positions are written in the map's CRS; metres of the map
                                      ///< frame otherwise
  const Crs* crs = nullptr;           ///< of a GeoPackage, which always is in the map's CRS
  bool timing = false;                ///< how long each update took: no two runs write the same
};

/// Writes a track. CSV: t,x,y,z,roll,pitch,yaw,var_x,var_y,cov_xy,var_yaw,matched,rejected, then wrong
/// (matches the log contradicts), lost (0 or 1), cov_x_yaw, cov_y_yaw, nis and nis_rows; seconds, metres,
/// radians; with `timing` seconds_used too. The file is written aside and renamed. Throws Error{output}.
void write_track_csv(const std::filesystem::path& file, const Track& track, const TrackOutput& output = {});

/// The same columns as points of a GeoPackage, layer `track`. `output.frame` and `output.crs` are needed.
void write_track_geopackage(const std::filesystem::path& file, const Track& track, const TrackOutput& output);

/// Reads such a CSV; columns may stand in any order, t, x, y are needed, others are 0 where they miss. Throws
/// Error{input} naming the line.
Track read_track_csv(const std::filesystem::path& file);

}  // namespace waymark
