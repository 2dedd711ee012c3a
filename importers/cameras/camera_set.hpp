// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "core/units.hpp"
#include "geo/camera.hpp"
#include "geo/crs.hpp"
#include "geo/similarity.hpp"
#include "geo/sun.hpp"
namespace waymark::importers {

/// Options for information that a camera file may lack.
struct CameraImport {
  std::string crs = {};  ///< of the map: projected, or "local"; empty: the one the file names
  /// CRS of the positions if the file names none; empty: the map's. For a frame that the file leaves
  /// arbitrary: a projected CRS, or EPSG:4978 for body-fixed axes.
  std::string camera_crs = {};
  /// Added to every camera height to give heights of the DEM: minus the height of the DEM's zero (geoid,
  /// areoid) above the cameras' (ellipsoid, sphere).
  Meters height_offset{0};
  std::string interior = {};  ///< file with the interior orientation, for formats that store it separately
  std::string control_points = {};                ///< CSV, see docs/how_to/tie_cameras_to_the_map.md
  std::optional<Similarity> map_from_frame = {};  ///< instead of control points
  Degrees rotation_sd{0};                         ///< about each camera axis, if the file gives none
  Meters position_sd{0};                          ///< along each grid axis, if the file gives none
};

/// One image of a camera file.
struct ImageCamera {
  std::string image;                ///< as the file names it, folders included
  std::optional<PosedCamera> view;  ///< std::nullopt if the file has no pose for it
  std::optional<Sun> sun;
  std::optional<Degrees> image_sun_angle;
  std::string taken_utc;  ///< ISO 8601; empty: unknown
};

/// Cameras with poses in the grid frame of a map.
struct CameraSet {
  std::string format;               ///< as recognised: "waymark", "opensfm", ...
  Crs crs = Crs::local();           ///< of the map
  std::vector<ImageCamera> images;  ///< in the order of the file, names are unique
  std::vector<std::string> warnings;
};

/// Returns the names of the formats, for options and messages.
std::vector<std::string> camera_formats();

/// Reads a camera file; an empty `format` is recognised from the contents.
/// - Poses in ENU or body-fixed axes are rotated into the grid at the camera (meridian convergence).
/// - Scale and curvature of the projection are not applied: GridFrame is treated as Cartesian.
/// - Heights are those of the file plus `height_offset`; body-fixed ones are above the ellipsoid of the map's
///   CRS.
/// Throws Error{input} with file, location and remedy for:
/// - a value that is missing or not understood, duplicate image names;
/// - a lens whose distortion does not invert anywhere in the image;
/// - a frame without scale and without a similarity.
CameraSet import_cameras(const std::string& path, const std::string& format, const CameraImport& import);

/// A lens for images of the same camera.
struct KnownLens {
  Camera camera = {};
  double readout_time = 0;  ///< s from the first row to the last: a rolling shutter; 0: global or unknown

  friend bool operator==(const KnownLens&, const KnownLens&) = default;
};

/// Lenses of a camera file, and what it says of images beside their poses.
struct KnownLenses {
  struct Entry {
    std::string image = {};                ///< as the file names it, folders included
    std::optional<std::size_t> lens = {};  ///< index into `lenses`
    std::string taken_utc = {};            ///< ISO 8601; empty: unknown
  };
  std::vector<KnownLens> lenses = {};  ///< distinct ones, in the order of the file
  std::vector<Entry> images = {};      ///< may be none, and may name images that are not there
};

/// Reads the lenses of a camera file in any format, or of a file of interior orientations (OpenDroneMap's
/// cameras.json, Orthority's YAML). Poses and their frame do not matter, and images may be absent. Throws
/// Error{input} for a file without lenses.
KnownLenses import_lenses(const std::string& path);

/// Returns the entry of an image, as find_camera() does.
const KnownLenses::Entry* find_entry(const KnownLenses& known, const std::string& image_file);

/// Returns the entry with the most path components, counted from the end, in common with an image file; the
/// last one may lack its extension. Null if there is none, or if two agree equally.
const ImageCamera* find_camera(const CameraSet& set, const std::string& image_file);

}  // namespace waymark::importers
