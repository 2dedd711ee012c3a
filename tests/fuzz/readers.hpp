// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>
namespace waymark::test {

/// A reader of files, to be given bytes of all kinds.
struct Reader {
  std::string name;  ///< also of its folder of seeds
  std::string file;  ///< name of the file that holds the bytes
  std::function<void(const std::string& path)> read;
  std::map<std::string, std::string> beside = {};  ///< sound files in the same folder
};

/// Returns all readers: rasters, points, cameras, logs, jobs, tables, models, maps.
const std::vector<Reader>& readers();

}  // namespace waymark::test
