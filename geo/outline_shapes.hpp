// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include "geo/geometry_part.hpp"
namespace waymark::inline geo {

/// What becomes a landmark of an element's geometry.
enum class ShapeOf {
  point,     ///< each point
  centroid,  ///< one for the element: of its area, else of its lines, else of its points
  outline,   ///< the centroid of an area; other geometries are refused
  corners,   ///< vertices at which an outline or a line turns, and joints of lines
  ends,      ///< free ends of each line, once for each side
  walls,     ///< straight pieces of outlines and lines
};

/// Side from which an outline or a line is seen.
enum class OpenSide {
  outside,  ///< of outlines: a building from the street. Lines: both
  inside,   ///< of outlines: a room. Lines: both
  both,
};

/// How shapes are derived of a geometry. Lengths in metres, angles in radians.
struct ShapeOptions {
  ShapeOf shape = ShapeOf::point;
  OpenSide open = OpenSide::outside;
  double min_turn = 30 * 0.017453292519943295;  ///< of a corner
  double min_length = 0.3;                      ///< of a wall, and of the walls at a corner or an end
  double max_length = 0;                        ///< longer walls are cut into equal pieces; 0: they are not
};

/// Position of a landmark and what its geometry says of its features.
struct DerivedShape {
  Eigen::Vector3d at;   ///< as the vertices: metres
  std::string vertex;   ///< of the element, from 1: "3"; empty if the element has one shape
  double along_sd = 0;  ///< m along `along` beside the position's own: of a wall
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  /// By names: direction, orientation (rad, clockwise from north), opening_angle (rad), side, length,
  /// diameter (m), area (m2). Those that the shape has.
  std::map<std::string, double> values;
};

struct DerivedShapes {
  std::vector<DerivedShape> shapes;
  std::map<std::string, int> omitted;  ///< reason -> number of vertices or pieces
};

/// Derives the shapes of a geometry given in metres (x east, y north). If nothing can be derived of it, the
/// reason is in `omitted`.
/// - Consecutive vertices within 1 mm are one.
/// - A direction is the bisector into the open at a corner, else the normal of the seen face.
/// - A line that ends where it begins has no ends. Its centroid is that of the area within.
/// - `shared` holds for each vertex of each part what other outlines and lines have, too. It may be empty.
struct SharedVertex {
  bool corner = false;  ///< vertex of another outline: a corner there is hidden or of another angle
  bool wall = false;    ///< the wall to the next vertex is one of another outline, too
  bool joined = false;  ///< end of a line that is a vertex of another line
  std::optional<Eigen::Vector2d> next =
      {};                ///< vertex at which the only other line goes on; one of both has it
  bool meeting = false;  ///< three lines or more come here, or go on: corners are those of `wedges`
  /// Between walls that come here: next vertices of the walls right and left of it, seen from here.
  std::vector<std::array<Eigen::Vector2d, 2>> wedges = {};
};
DerivedShapes derive_shapes(const std::vector<GeometryPart>& parts, const ShapeOptions& options,
                            const std::vector<std::vector<SharedVertex>>& shared = {});

}  // namespace waymark::inline geo
