// SPDX-License-Identifier: Apache-2.0
// COLMAP: a folder with cameras and images, .bin or .txt.
//  - Quaternion and t are world to camera: X_camera = R X_world + t.
//  - The first pixel has its corner at (0, 0), so 0.5 is subtracted from the principal point.
//  - Frame and scale are arbitrary. For a model aligned by COLMAP set camera_crs: EPSG:4978 for ECEF.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/json_value.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;

struct Model {
  const char* name;
  std::size_t parameters;
};
// In the order of their ids, src/base/camera_models.h.
constexpr std::array<Model, 11> kModels{{{"SIMPLE_PINHOLE", 3},
                                         {"PINHOLE", 4},
                                         {"SIMPLE_RADIAL", 4},
                                         {"RADIAL", 5},
                                         {"OPENCV", 8},
                                         {"OPENCV_FISHEYE", 8},
                                         {"FULL_OPENCV", 12},
                                         {"FOV", 5},
                                         {"SIMPLE_RADIAL_FISHEYE", 4},
                                         {"RADIAL_FISHEYE", 5},
                                         {"THIN_PRISM_FISHEYE", 12}}};

Camera camera_of(std::size_t model, std::int64_t columns, std::int64_t rows, const std::vector<double>& p,
                 const std::string& where) {
  const std::string name = kModels[model].name;
  Camera camera{.columns = columns, .rows = rows};
  const bool one_focal = name.starts_with("SIMPLE") || name.starts_with("RADIAL");
  const std::size_t centre = one_focal ? 1 : 2;
  camera.fx = p[0];
  camera.fy = p[one_focal ? 0 : 1];
  camera.cx = p[centre] - 0.5;
  camera.cy = p[centre + 1] - 0.5;
  if (name == "FOV" || name == "THIN_PRISM_FISHEYE")
    throw Error(ErrorCode::input, fmt::format("cameras of model {} cannot be used", name), where,
                "colmap image_undistorter makes pinhole images of them");
  if (name.ends_with("FISHEYE")) camera.lens = Camera::Lens::fisheye;
  std::copy(p.begin() + static_cast<std::ptrdiff_t>(centre) + 2, p.end(), camera.distortion.begin());
  return camera;
}

struct Pose {
  std::array<double, 7> numbers{};  // qw qx qy qz tx ty tz
  std::int64_t camera = 0;
  std::string image;
};

Eigen::Isometry3d world_from_camera(const Pose& pose) {
  const auto& n = pose.numbers;
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = Eigen::Quaterniond(n[0], n[1], n[2], n[3]).normalized().toRotationMatrix();
  camera_from_world.translation() << n[4], n[5], n[6];
  return camera_from_world.inverse();
}

// Reads a sequence of little-endian numbers.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : path_(path), bytes_(read_vsi_text(path)) {}
  template <class T>
  T next() {
    T value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }
  std::string text() {
    const std::size_t end = bytes_.find('\0', at_);
    const std::string found = bytes_.substr(at_, end - at_);
    take(found.size() + 1);
    return found;
  }
  const char* take(std::size_t count) {
    if (count > bytes_.size() - at_)
      throw Error(ErrorCode::input,
                  fmt::format("the file ends after {} bytes, in the middle of an entry", bytes_.size()),
                  path_, "copy it again");
    at_ += count;
    return bytes_.data() + at_ - count;
  }

 private:
  std::string path_, bytes_;
  std::size_t at_ = 0;
};

using Cameras = std::map<std::int64_t, Camera>;

Cameras cameras_from_bytes(const std::string& path) {
  Bytes bytes(path);
  Cameras cameras;
  for (auto left = bytes.next<std::uint64_t>(); left > 0; --left) {
    const auto id = bytes.next<std::int32_t>();
    const auto model = static_cast<std::size_t>(bytes.next<std::int32_t>());
    const auto columns = static_cast<std::int64_t>(bytes.next<std::uint64_t>());
    const auto rows = static_cast<std::int64_t>(bytes.next<std::uint64_t>());
    if (model >= kModels.size())
      throw Error(ErrorCode::input, fmt::format("camera {} is of the unknown model {}", id, model), path,
                  "write it with a known one: colmap image_undistorter");
    std::vector<double> parameters(kModels[model].parameters);
    for (double& p : parameters) p = bytes.next<double>();
    cameras[id] = camera_of(model, columns, rows, parameters, path);
  }
  return cameras;
}

std::vector<Pose> poses_from_bytes(const std::string& path) {
  Bytes bytes(path);
  std::vector<Pose> poses;
  for (auto left = bytes.next<std::uint64_t>(); left > 0; --left) {
    bytes.next<std::int32_t>();
    Pose pose;
    for (double& n : pose.numbers) n = bytes.next<double>();
    pose.camera = bytes.next<std::int32_t>();
    pose.image = bytes.text();
    const auto points = bytes.next<std::uint64_t>();
    for (std::uint64_t i = 0; i < points; ++i) bytes.take(24);
    poses.push_back(std::move(pose));
  }
  return poses;
}

Cameras cameras_from_text(const std::string& path) {
  Cameras cameras;
  for (const TextRow& row : text_rows(path)) {
    const auto model = std::find_if(kModels.begin(), kModels.end(), [&](const Model& m) {
      return row.words.size() > 1 && row.words[1] == m.name;
    });
    if (model == kModels.end()) refuse_line(path, row.line, "there is no known camera model in the line");
    std::vector<double> parameters;
    for (std::size_t i = 0; i < model->parameters; ++i)
      parameters.push_back(number_at(row, 4 + i, path, "a parameter"));
    cameras[static_cast<std::int64_t>(number_at(row, 0, path, "the number"))] =
        camera_of(static_cast<std::size_t>(model - kModels.begin()),
                  static_cast<std::int64_t>(number_at(row, 2, path, "the width")),
                  static_cast<std::int64_t>(number_at(row, 3, path, "the height")), parameters, path);
  }
  return cameras;
}

// Every second line holds image points and may be empty; a name may contain blanks.
std::vector<Pose> poses_from_text(const std::string& path) {
  const std::string content = read_vsi_text(path);
  std::vector<Pose> poses;
  std::size_t line = 0;
  bool points = false;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    std::string_view text = std::string_view(content).substr(begin, end - begin);
    begin = end + 1;
    ++line;
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (text.starts_with('#')) continue;
    if (points || text.empty()) {
      points = false;
      continue;
    }
    TextRow row{line, {}};
    for (int word = 0; word < 9 && !text.empty(); ++word) {
      const std::size_t blank = std::min(text.find(' '), text.size());
      row.words.emplace_back(text.substr(0, blank));
      text.remove_prefix(std::min(blank + 1, text.size()));
    }
    Pose pose;
    for (std::size_t i = 0; i < 7; ++i) pose.numbers[i] = number_at(row, i + 1, path, "the pose");
    pose.camera = static_cast<std::int64_t>(number_at(row, 8, path, "the camera"));
    pose.image = text;
    poses.push_back(std::move(pose));
    points = true;
  }
  return poses;
}

fs::path folder_of(const std::string& path) {
  return fs::is_directory(path) ? fs::path(path) : fs::path(path).parent_path();
}

bool has(const fs::path& folder, const char* name) {
  std::error_code ignored;
  return fs::exists(folder / name, ignored);
}

CameraFile read_colmap(const CameraSource& source) {
  const fs::path folder = folder_of(source.path);
  const bool binary = has(folder, "cameras.bin") && has(folder, "images.bin");
  if (!binary && !(has(folder, "cameras.txt") && has(folder, "images.txt")))
    throw Error(ErrorCode::input, "a COLMAP model is a folder with cameras and images, .bin or .txt",
                source.path, "name the folder, e.g. sparse/0");
  const Cameras cameras = binary ? cameras_from_bytes((folder / "cameras.bin").string())
                                 : cameras_from_text((folder / "cameras.txt").string());
  const std::string images = (folder / (binary ? "images.bin" : "images.txt")).string();
  CameraFile file;
  for (const Pose& pose : binary ? poses_from_bytes(images) : poses_from_text(images)) {
    const auto camera = cameras.find(pose.camera);
    if (camera == cameras.end())
      throw Error(ErrorCode::input,
                  fmt::format("image '{}' is of camera {}, which is not there", pose.image, pose.camera),
                  images, "cameras and images must be of one model");
    CameraRecord record;
    record.image = pose.image;
    record.location = fmt::format("image {}", file.images.size() + 1);
    record.camera = camera->second;
    record.world_from_camera = world_from_camera(pose);
    file.images.push_back(std::move(record));
  }
  return file;
}

bool recognises(const CameraSource& source) {
  std::error_code ignored;
  const fs::path path(source.path);
  const auto is_model = [](const fs::path& folder) {
    return (has(folder, "cameras.bin") && has(folder, "images.bin")) ||
           (has(folder, "cameras.txt") && has(folder, "images.txt"));
  };
  if (fs::is_directory(path, ignored)) return is_model(path);
  // Either text may stand without its comment.
  const std::string name = path.filename().string();
  if ((name == "cameras.txt" || name == "images.txt") && is_model(path.parent_path())) return true;
  return name == "cameras.bin" || name == "images.bin" ||
         source.head.starts_with("# Camera list with one line of data per camera") ||
         source.head.starts_with("# Image list with two lines of data per image");
}

}  // namespace

void register_camera_format_colmap(CameraFormats& formats);
void register_camera_format_colmap(CameraFormats& formats) {
  formats.add({.name = "colmap",
               .summary = "COLMAP: folder with cameras and images, .bin or .txt; arbitrary frame",
               .recognises = recognises,
               .read = read_colmap});
}

}  // namespace waymark::importers
