// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "importers/points/las_header.hpp"
namespace waymark::importers {

/// A laser return, in the units of the file.
struct LasPoint {
  double x = 0, y = 0, z = 0;
  std::uint8_t classification = 0;  ///< 2 ground; 7 and 18 noise
  std::uint8_t return_number = 1;   ///< from 1; 0: not numbered
  bool withheld = false;
  std::uint8_t return_count = 0;  ///< of its pulse; 0: not stated
  bool operator==(const LasPoint&) const = default;
};

/// Returns the point of an uncompressed record; only its first 17 bytes are read.
LasPoint las_point(const unsigned char* record, const LasHeader& header);

/// Returns false for noise and withheld points.
inline bool is_usable(const LasPoint& p) {
  return !p.withheld && p.classification != 7 && p.classification != 18;
}

/// Returns true for a first return, and for all returns if the file does not number them.
inline bool is_first(const LasPoint& p) {
  return p.return_number <= 1;
}

}  // namespace waymark::importers
