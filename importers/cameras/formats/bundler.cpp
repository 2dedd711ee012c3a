// SPDX-License-Identifier: Apache-2.0
// Bundler 0.3: bundle.out, with the list of image names beside it (list.txt) or named by `interior`.
//  - P = R X + t, p = -P / P.z: the camera looks along -z, y is up.
//  - p' = f (1 + k1 |p|^2 + k2 |p|^4) p, from the middle of the image, x to the right, y up.
//  - A camera with focal length 0 was not oriented. Frame and scale are arbitrary.
#include <fmt/format.h>

#include <filesystem>
#include <limits>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

std::vector<std::string> names_of(const CameraSource& source) {
  const std::filesystem::path folder = std::filesystem::path(source.path).parent_path();
  std::string list = source.interior;
  for (const char* name : {"list.txt", "bundle.out.list.txt"}) {
    std::error_code ignored;
    if (list.empty() && std::filesystem::exists(folder / name, ignored)) list = (folder / name).string();
  }
  if (list.empty())
    throw Error(ErrorCode::input, "a Bundler file does not name its images", source.path,
                "put list.txt beside it, or name the list in the option interior");
  std::vector<std::string> names;
  for (const TextRow& row : text_rows(list)) names.push_back(row.words[0]);
  return names;
}

// Iterates over the numbers of all rows; line breaks have no meaning in Bundler files.
class Numbers {
 public:
  explicit Numbers(const std::string& path) : path_(path), rows_(text_rows(path)) {}
  double next(const char* what) {
    while (row_ < rows_.size() && word_ >= rows_[row_].words.size()) ++row_, word_ = 0;
    if (row_ >= rows_.size())
      throw Error(ErrorCode::input, fmt::format("the file ends before {}", what), path_, "copy it again");
    return number_at(rows_[row_], word_++, path_, what);
  }
  std::size_t line() const { return row_ < rows_.size() ? rows_[row_].line : 0; }

 private:
  const std::string& path_;
  std::vector<TextRow> rows_;
  std::size_t row_ = 0, word_ = 0;
};

CameraRecord next_record(Numbers& numbers) {
  CameraRecord record;
  Camera camera;
  camera.fx = camera.fy = numbers.next("the focal length");
  camera.distortion[0] = numbers.next("k1");
  camera.distortion[1] = numbers.next("k2");
  record.location = fmt::format("line {}", numbers.line());
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 9; ++i) camera_from_world.linear()(i / 3, i % 3) = numbers.next("R");
  for (int i = 0; i < 3; ++i) camera_from_world.translation()[i] = numbers.next("t");
  if (!(camera.fx > 0)) return record;
  camera.cx = camera.cy = std::numeric_limits<double>::quiet_NaN();  // the middle of the image
  record.camera = camera;
  record.world_from_camera = Eigen::Isometry3d(camera_from_world.inverse());
  record.world_from_camera->linear() *= Eigen::Vector3d(1, -1, -1).asDiagonal();
  return record;
}

CameraFile read_bundler(const CameraSource& source) {
  const std::vector<std::string> names = names_of(source);
  Numbers numbers(source.path);
  const double count = numbers.next("the number of cameras");
  numbers.next("the number of points");
  if (count != static_cast<double>(names.size()))
    throw Error(ErrorCode::input,
                fmt::format("there are {} cameras, but {} image names", count, names.size()), source.path,
                "the list must be the one Bundler was given");
  CameraFile file;
  for (const std::string& name : names) {
    file.images.push_back(next_record(numbers));
    file.images.back().image = name;
  }
  return file;
}

}  // namespace

void register_camera_format_bundler(CameraFormats& formats);
void register_camera_format_bundler(CameraFormats& formats) {
  formats.add({.name = "bundler",
               .summary = "Bundler: bundle.out with list.txt; arbitrary frame",
               .recognises = [](const CameraSource& s) { return s.head.starts_with("# Bundle file"); },
               .read = read_bundler});
}

}  // namespace waymark::importers
