// SPDX-License-Identifier: Apache-2.0
#include "importers/images/find_images.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <set>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "importers/gdal_session.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;

bool is_folder(const std::string& path) {
  VSIStatBufL status;
  return VSIStatL(path.c_str(), &status) == 0 && VSI_ISDIR(status.st_mode);
}

bool exists(const std::string& path) {
  VSIStatBufL status;
  return VSIStatL(path.c_str(), &status) == 0;
}

bool is_pattern(const std::string& path) {
  return path.find_first_of("*?[") != std::string::npos && !exists(path);
}

// Returns the folders to search for the images of a camera set.
std::vector<std::string> folders_of(const std::vector<std::string>& files, const std::string& camera_file) {
  std::vector<std::string> folders;
  for (const std::string& file : files)
    if (is_folder(file)) folders.push_back(file);
  if (!files.empty()) return folders;
  const fs::path folder =
      is_folder(camera_file) ? fs::path(camera_file) : fs::path(camera_file).parent_path();
  for (const fs::path& place : {folder, folder / "images", folder.parent_path() / "images",
                                folder.parent_path().parent_path() / "images"})
    if (is_folder(place.string())) folders.push_back(place.string());
  return folders;
}

// Returns the name of an image as a path that stays in its folder: of others, such as /etc/a.png or ../a.png,
// the file name.
fs::path inside(const std::string& image) {
  const fs::path path = fs::path(image).lexically_normal();
  const bool stays = path.is_relative() && !path.empty() && *path.begin() != "..";
  return stays ? path : path.filename();
}

// Returns the camera's image in one of the folders, with an extension if the camera file omits it.
std::string locate(const std::string& name, const std::vector<std::string>& folders,
                   const std::map<std::string, std::string>& by_stem) {
  const fs::path image = inside(name);
  for (const std::string& folder : folders)
    for (const fs::path& path : {fs::path(folder) / image, fs::path(folder) / image.filename()})
      if (exists(path.string()) && !is_folder(path.string())) return path.string();
  for (const std::string& stem : {image.filename().string(), image.stem().string()})
    if (const auto found = by_stem.find(stem); found != by_stem.end()) return found->second;
  return folders.empty() ? image.string() : (fs::path(folders[0]) / image).string();
}

// Prefixes names with folders until they are unique.
void make_names_unique(std::vector<FoundImage>& images) {
  for (int folders = 0; folders < 8; ++folders) {
    std::map<std::string, int> uses;
    for (const FoundImage& image : images) ++uses[image.name];
    bool clear = true;
    for (FoundImage& image : images) {
      if (uses[image.name] < 2) continue;
      clear = false;
      fs::path parent = fs::path(image.path).parent_path();
      for (int up = 0; up < folders; ++up) parent = parent.parent_path();
      if (!parent.filename().empty()) image.name = parent.filename().string() + "/" + image.name;
    }
    if (clear) return;
  }
}

}  // namespace

bool is_image_name(const std::string& name) {
  static constexpr std::array kExtensions{".tif", ".tiff", ".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".img",
                                          ".jp2", ".vrt",  ".cub", ".bmp", ".webp", ".exr", ".jxl"};
  const std::string extension = lower_case(fs::path(name).extension().string());
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

std::vector<std::string> expand_pattern(const std::string& pattern) {
  if (!is_pattern(pattern)) return {pattern};
  const fs::path folder = fs::path(pattern).parent_path();
  const std::string wanted = fs::path(pattern).filename().string();
  const std::string place = folder.empty() ? "." : folder.string();
  const std::unique_ptr<char*, decltype(&CSLDestroy)> names(VSIReadDir(place.c_str()), &CSLDestroy);
  std::vector<std::string> found;
  for (char** name = names.get(); name && *name; ++name)
    if (fnmatch(wanted.c_str(), *name, FNM_PERIOD) == 0) found.push_back((folder / *name).string());
  std::ranges::sort(found);
  return found;
}

std::vector<std::string> image_files_in(const std::string& folder) {
  const std::unique_ptr<char*, decltype(&CSLDestroy)> names(VSIReadDir(folder.c_str()), &CSLDestroy);
  std::vector<std::string> images;
  for (char** name = names.get(); name && *name; ++name)
    if (is_image_name(*name)) images.push_back((fs::path(folder) / *name).string());
  std::ranges::sort(images);
  return images;
}

std::vector<FoundImage> find_images(const std::vector<std::string>& files, const CameraSet* cameras,
                                    const std::string& camera_file) {
  const GdalListener quiet;
  std::vector<std::string> paths;
  for (const std::string& file : files)
    if (is_folder(file))
      for (std::string& image : image_files_in(file)) paths.push_back(std::move(image));
    else {
      std::vector<std::string> matches = expand_pattern(file);
      if (matches.empty())
        throw Error(ErrorCode::input, "no image matches the pattern", file,
                    "patterns have * ? and [...] in the file name; check the folder and the spelling");
      std::ranges::move(matches, std::back_inserter(paths));
    }
  if (cameras) {
    const std::vector<std::string> folders = folders_of(files, camera_file);
    std::map<std::string, std::string> by_stem;
    for (const std::string& folder : folders)
      for (const std::string& path : image_files_in(folder))
        by_stem.emplace(fs::path(path).stem().string(), path);
    if (files.empty() || !folders.empty())
      for (const ImageCamera& image : cameras->images) paths.push_back(locate(image.image, folders, by_stem));
  }
  std::vector<FoundImage> found;
  std::set<std::string> known;
  for (const std::string& path : paths)
    if (known.insert(fs::path(path).lexically_normal().string()).second)
      found.push_back({.path = path,
                       .name = fs::path(path).filename().string(),
                       .camera = cameras ? find_camera(*cameras, path) : nullptr});
  make_names_unique(found);
  std::ranges::sort(found, {}, &FoundImage::name);
  return found;
}

}  // namespace waymark::importers
