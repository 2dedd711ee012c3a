// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
namespace waymark::importers {

/// Unit of length of a drawing's coordinates.
struct DrawingUnit {
  std::string name;   ///< "mm"
  double metres = 1;  ///< of one unit
};

/// Returns the unit of this name: m, dm, cm, mm, km, in, ft, yd, mi, us_ft. Throws Error{usage} for another.
DrawingUnit drawing_unit(const std::string& name);

/// Reads the unit that the header of a DXF file states ($INSUNITS, Autodesk's DXF reference); `std::nullopt`
/// if it states none, or one that is not in use for drawings.
std::optional<DrawingUnit> read_dxf_unit(const std::string& path);

}  // namespace waymark::importers
