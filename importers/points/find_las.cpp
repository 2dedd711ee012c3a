// SPDX-License-Identifier: Apache-2.0
#include "importers/points/find_las.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

bool is_las_name(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".las" || extension == ".laz";
}

std::vector<std::string> las_files_in(const std::string& folder) {
  const CPLStringList names(VSIReadDir(folder.c_str()), TRUE);
  std::vector<std::string> files;
  for (int i = 0; i < names.size(); ++i)
    if (is_las_name(names[i])) files.push_back((std::filesystem::path(folder) / names[i]).string());
  if (files.empty())
    throw Error(ErrorCode::input, "the folder has no files whose names end in .las or .laz", folder,
                "name the files, or the folder that has them");
  std::ranges::sort(files);
  return files;
}

}  // namespace

std::vector<std::string> find_las_files(const std::vector<std::string>& files) {
  std::vector<std::string> found;
  for (const std::string& file : files) {
    VSIStatBufL status;
    if (VSIStatL(file.c_str(), &status) == 0 && VSI_ISDIR(status.st_mode)) {
      for (std::string& one : las_files_in(file)) found.push_back(std::move(one));
    } else {
      found.push_back(file);
    }
  }
  return found;
}

}  // namespace waymark::importers
