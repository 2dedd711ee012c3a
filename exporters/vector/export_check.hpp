// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/vector/vector_format.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Reads a finished file again. Throws Error{output} if landmarks are missing, or if a reader would take the
/// coordinates for another body's. Returns warnings about a CRS that is stored without its name, or not at
/// all.
std::vector<std::string> check_export(const VectorFormat& format, const std::string& path,
                                      const std::string& output_name, const Crs& crs, std::int64_t landmarks);

}  // namespace waymark::exporters
