// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include "geo/crs.hpp"
namespace waymark::exporters {

/// A point of a cloud; x, y in the units of the CRS, z in metres.
struct LasReturn {
  double x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t number = 1, of = 1;  ///< return `number` of `of`, 1 to 15
  std::uint8_t kind = 1;            ///< ASPRS class
  double time = 0;                  ///< seconds
};

/// Writes a point cloud as LAS 1.4, point format 6 (ASPRS 2019, R15), the CRS as WKT. Resolution is a
/// millimetre. Points are written as they come and the header at the end, so memory is bounded. Staged and
/// renamed.
class LasFile {
 public:
  /// Coordinates are stored as 32-bit millimetres from `origin`, in the CRS. Throws Error{output}.
  LasFile(std::filesystem::path path, const Crs& crs, double origin_x, double origin_y);
  ~LasFile();
  LasFile(const LasFile&) = delete;
  LasFile& operator=(const LasFile&) = delete;

  void add(const LasReturn& point);
  /// Writes the header and renames the file. Throws Error{output}.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace waymark::exporters
