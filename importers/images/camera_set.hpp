// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "geo/camera.hpp"
#include "geo/crs.hpp"
#include "geo/sun.hpp"
#include "importers/images/similarity.hpp"
namespace waymark {

/// What a camera file does not say itself.
struct CameraImport {
  std::string crs = {};  ///< of the map: projected, or "local"; empty: the one the file names
  /// Of positions in the file, where it does not say; empty: the map's. Of a frame that the file leaves
  /// arbitrary it says which it is: a projected CRS, or EPSG:4978, fixed to the body from its centre.
  std::string camera_crs = {};
  /// Added to every camera height to give heights of the DEM, metres: minus the height of the DEM's zero
  /// (geoid, areoid) above the cameras' (ellipsoid, sphere).
  double height_offset = 0;
  std::string interior = {};        ///< file with the interior orientation, for formats that keep it apart
  std::string control_points = {};  ///< CSV, see docs/camera_file.md
  std::optional<Similarity> map_from_frame = {};  ///< instead of control points
  double rotation_sd = 0;  ///< radians about each camera axis, where the file does not say
  double position_sd = 0;  ///< metres along each grid axis, where the file does not say
};

/// One image of a camera file.
struct ImageCamera {
  std::string image;                ///< as the file names it, folders included
  std::optional<PosedCamera> view;  ///< nothing where the file has no pose for it
  std::optional<Sun> sun;
  std::optional<Degrees> image_sun_angle;
  std::string taken_utc;  ///< ISO 8601; empty: unknown
};

/// Cameras placed in the grid frame of a map.
struct CameraSet {
  std::string format;               ///< as recognised: "waymark", "opensfm", ...
  Crs crs = Crs::local();           ///< of the map
  std::vector<ImageCamera> images;  ///< in the file's order, no two of one name
  std::vector<std::string> warnings;
};

/// Names of the formats, for options and messages.
std::vector<std::string> camera_formats();

/// Reads a camera file; `format` empty: recognised by its contents. Poses in ENU or earth-fixed axes are
/// turned into the grid at the camera (meridian convergence); scale and curvature of the projection are not
/// (GridFrame is taken as Cartesian). Heights are those of the file plus `height_offset`; earth-fixed ones
/// are above the ellipsoid of the map's CRS. Throws Error{input} with file, place in it and remedy: what is
/// missing or not understood, a lens whose distortion does not invert anywhere in the image, two images of
/// one name, a frame without scale and no similarity.
CameraSet import_cameras(const std::string& path, const std::string& format, const CameraImport& import);

/// The entry for an image file: the one that agrees in the most path components from the end, the last one
/// with or without its extension. Null where there is none, or where two agree equally.
const ImageCamera* camera_of(const CameraSet& set, const std::string& image_file);

}  // namespace waymark
