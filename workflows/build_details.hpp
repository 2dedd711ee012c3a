// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>
namespace waymark::workflows {

/// How the program was built, and the libraries that it runs with.
struct BuildDetails {
  std::string version;     ///< "0.1.0"
  std::string compiler;    ///< "GCC 12.2.0"
  std::string build_type;  ///< "Release"; empty: not known
  std::string processor;   ///< "x86_64"
  /// Name and version of each library; that of the library that is loaded, where it can be asked. GEOS is
  /// that of GDAL, which may be built without it: empty then.
  std::vector<std::pair<std::string, std::string>> libraries;
  /// Decompressors that GDAL may lack, and whether it has them: for MCAP chunks and rasters.
  std::vector<std::pair<std::string, bool>> decompressors;
};

BuildDetails build_details();

}  // namespace waymark::workflows
