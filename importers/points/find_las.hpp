// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
namespace waymark::importers {

/// Replaces each folder by the files in it, not below, whose names end in .las or .laz (.copc.laz, too),
/// whatever the case, sorted. Throws Error{input} for a folder without any.
std::vector<std::string> find_las_files(const std::vector<std::string>& files);

}  // namespace waymark::importers
