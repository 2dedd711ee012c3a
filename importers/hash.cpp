// SPDX-License-Identifier: Apache-2.0
#include "importers/hash.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <set>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"
#include "importers/images/find_images.hpp"
#include "importers/standard_input.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

// A VRT may be built on VRTs.
void collect(const std::string& raster, std::vector<std::string>& files, std::set<std::string>& known) {
  const GdalDataset dataset = open_raster(raster);
  const GdalListener quiet;
  const std::unique_ptr<char*, decltype(&CSLDestroy)> list(dataset->GetFileList(), &CSLDestroy);
  for (char** file = list.get(); file && *file; ++file) {
    if (!known.insert(*file).second) continue;
    if (seekable_path(raster) != raster) return files.push_back(raster);  // the copy's name says nothing
    files.emplace_back(*file);
    if (files.back().ends_with(".vrt")) collect(files.back(), files, known);
  }
}

// A file that is no raster is listed alone; if it should have been one, its reader throws.
std::vector<std::string> parts_of(const std::string& path) {
  try {
    return raster_file_list(path);
  } catch (const Error&) {
    return {path};
  }
}

// A device adds nothing: its reader refuses it. /dev/stdin is read from its copy.
std::uint64_t add_content(const std::string& path, pipeline::Sha256& sum) {
  std::error_code unknown;
  if (std::filesystem::is_character_file(seekable_path(path), unknown)) return 0;
  const GdalListener gdal;
  const std::unique_ptr<VSILFILE, CloseFile> file(VSIFOpenL(seekable_path(path).c_str(), "rb"));
  if (!file) {
    const std::string reason = gdal.error_about(path);
    throw Error(ErrorCode::input, "the file cannot be read" + (reason.empty() ? "" : ": " + reason), path,
                "check that it exists and may be read");
  }
  std::uint64_t bytes = 0;
  std::string piece(kPiece, '\0');
  errno = 0;
  while (const std::size_t count = VSIFReadL(piece.data(), 1, kPiece, file.get())) {
    sum.add({piece.data(), count});
    bytes += count;
  }
  const int cause = errno;  // GDAL says nothing about a plain file
  if (!VSIFEofL(file.get())) {
    const std::string reason = gdal.error_about(path);
    throw Error(ErrorCode::input,
                "reading the file failed: " + (reason.empty() ? std::strerror(cause) : reason), path,
                "try again");
  }
  return bytes;
}

bool is_folder(const std::string& path) {
  VSIStatBufL status;
  return VSIStatL(path.c_str(), &status) == 0 && VSI_ISDIR(status.st_mode);
}

// Names and sizes of the files.
void add_listing(const std::string& folder, pipeline::Sha256& sum) {
  for (const std::string& path : image_files_in(folder)) {
    VSIStatBufL status;
    const bool there = VSIStatL(path.c_str(), &status) == 0;
    sum.add(fmt::format("{} {}\n", path.substr(folder.size()), there ? status.st_size : 0));
  }
}

std::vector<std::string> files_in(const std::string& folder) {
  const std::unique_ptr<char*, decltype(&CSLDestroy)> names(VSIReadDir(folder.c_str()), &CSLDestroy);
  std::vector<std::string> files;
  for (char** name = names.get(); name && *name; ++name)
    if (const std::string path = folder + "/" + *name; !is_folder(path)) files.push_back(path);
  std::ranges::sort(files);
  return files;
}

}  // namespace

InputFile hash_file(const std::string& path) {
  pipeline::Sha256 sum;
  InputFile input{.path = path, .bytes = 0, .sha256 = {}};
  if (path.ends_with('/') && seekable_path(path) == path) {
    add_listing(path, sum);
    input.sha256 = sum.hex();
    return input;
  }
  for (const std::string& file : hashed_files(path)) input.bytes += add_content(file, sum);
  input.sha256 = sum.hex();
  return input;
}

std::vector<std::string> hashed_files(const std::string& path) {
  if (path.ends_with('/') && seekable_path(path) == path) return {};
  if (is_folder(path)) return files_in(path);
  std::vector<std::string> files;
  for (const std::string& file : expand_pattern(path)) {
    const std::vector<std::string> parts = parts_of(file);
    files.insert(files.end(), parts.begin(), parts.end());
  }
  return files;
}

std::vector<std::string> raster_file_list(const std::string& raster) {
  std::vector<std::string> files;
  std::set<std::string> known;
  collect(raster, files, known);
  return files;
}

}  // namespace waymark::importers
