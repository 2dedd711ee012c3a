// SPDX-License-Identifier: Apache-2.0
#include "importers/hash.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <memory>
#include <set>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};

// A VRT may be built on VRTs.
void collect(const std::string& raster, std::vector<std::string>& files, std::set<std::string>& known) {
  const GdalDataset dataset = open_raster(raster);
  const GdalMessages quiet;
  const std::unique_ptr<char*, decltype(&CSLDestroy)> list(dataset->GetFileList(), &CSLDestroy);
  for (char** file = list.get(); file && *file; ++file) {
    if (!known.insert(*file).second) continue;
    files.emplace_back(*file);
    if (files.back().ends_with(".vrt")) collect(files.back(), files, known);
  }
}

}  // namespace

InputFile hash_file(const std::string& path) {
  const GdalMessages gdal;
  const std::unique_ptr<VSILFILE, CloseFile> file(VSIFOpenL(path.c_str(), "rb"));
  if (!file)
    throw Error(ErrorCode::input, "the file cannot be read", path, "check that it exists and may be read");
  Sha256 sum;
  InputFile found{.path = path, .bytes = 0, .sha256 = {}};
  std::string piece(kPiece, '\0');
  while (const std::size_t count = VSIFReadL(piece.data(), 1, kPiece, file.get())) {
    sum.add({piece.data(), count});
    found.bytes += count;
  }
  if (!VSIFEofL(file.get()))
    throw Error(ErrorCode::input, "reading the file failed: " + gdal.last_error(), path, "try again");
  found.sha256 = sum.hex();
  return found;
}

std::vector<std::string> files_behind(const std::string& raster) {
  std::vector<std::string> files;
  std::set<std::string> known;
  collect(raster, files, known);
  return files;
}

}  // namespace waymark
