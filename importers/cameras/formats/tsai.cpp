// SPDX-License-Identifier: Apache-2.0
// Pinhole cameras of the Ames Stereo Pipeline: one .tsai file per image, of the same name.
//  - R is camera to world, C the position of the camera, usually body-fixed from the body's centre.
//  - Q = R' (P - C); u = (fu Qu / Qw + cu) / pitch, with Qu = u_direction . Q and so on; the first pixel's
//    centre is 0.
//  - Old files have no header, no pitch (it is 1) and no name of the lens: a TSAI lens if k1 is given.
//  - TSAI is OpenCV's Brown lens.
#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

struct Tsai {
  std::map<std::string, TextRow> values;  // the words after "key ="
  std::vector<std::string> words;         // lines of one word: type of camera, type of lens
};

Tsai parse(const std::string& path) {
  Tsai file;
  for (TextRow row : text_rows(path)) {
    if (row.words.size() == 1) {
      file.words.push_back(row.words[0]);
      continue;
    }
    if (row.words[1] != "=") continue;
    const std::string key = row.words[0];
    row.words.erase(row.words.begin(), row.words.begin() + 2);
    file.values[key] = std::move(row);
  }
  return file;
}

class TsaiReader {
 public:
  TsaiReader(const Tsai& file, const std::string& path) : file_(file), path_(path) {}

  CameraFile read() const {
    CameraRecord record;
    record.image = std::filesystem::path(path_).stem().string();
    record.location = "the camera";
    record.camera = lens();
    const Eigen::Vector3d centre = vector("C");
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const TextRow& r = row("R");
    for (int i = 0; i < 9; ++i)
      pose.linear()(i / 3, i % 3) = number_at(r, static_cast<std::size_t>(i), path_, "R");
    pose.linear() = Eigen::Matrix3d(pose.linear() * axes().transpose());
    pose.translation() = centre;
    record.world_from_camera = pose;
    CameraFile made;
    // No body is smaller than a kilometre and holds a camera this near its centre.
    constexpr double kFromCentre = 1e5;
    made.world.axes = centre.norm() > kFromCentre ? CameraWorld::Axes::earth : CameraWorld::Axes::arbitrary;
    made.images.push_back(std::move(record));
    return made;
  }

 private:
  const TextRow& row(const std::string& key) const {
    const auto found = file_.values.find(key);
    if (found == file_.values.end())
      throw Error(ErrorCode::input, fmt::format("'{} =' is missing", key), path_, "write the camera again");
    return found->second;
  }
  double number(const std::string& key) const { return number_at(row(key), 0, path_, key.c_str()); }
  double number(const std::string& key, double otherwise) const {
    return file_.values.contains(key) ? number(key) : otherwise;
  }
  Eigen::Vector3d vector(const std::string& key) const {
    const TextRow& r = row(key);
    return {number_at(r, 0, path_, key.c_str()), number_at(r, 1, path_, key.c_str()),
            number_at(r, 2, path_, key.c_str())};
  }

  // Rows are our x, y, z axes in the axes of the file.
  Eigen::Matrix3d axes() const {
    if (!file_.values.contains("u_direction")) return Eigen::Matrix3d::Identity();
    Eigen::Matrix3d rows;
    rows.row(0) = vector("u_direction");
    rows.row(1) = vector("v_direction");
    rows.row(2) = vector("w_direction");
    if (!((rows * rows.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-6) || !(rows.determinant() > 0))
      throw Error(ErrorCode::input, "u_direction, v_direction and w_direction are no right-handed axes",
                  path_, "mirrored cameras cannot be used");
    return rows;
  }

  Camera lens() const {
    const double pitch = number("pitch", 1);
    if (!(pitch > 0))
      throw Error(ErrorCode::input, fmt::format("pitch is {}", pitch), path_, "it must be positive");
    Camera camera;
    camera.fx = number("fu") / pitch;
    camera.fy = number("fv") / pitch;
    camera.cx = number("cu") / pitch;
    camera.cy = number("cv") / pitch;
    std::string kind = file_.values.contains("k1") ? "TSAI" : "NULL";
    for (const std::string& word : file_.words)
      if (!word.starts_with("VERSION") && word != "PINHOLE") kind = word;
    if (kind == "TSAI") {
      camera.distortion = {number("k1"), number("k2"), number("p1"), number("p2"), number("k3", 0)};
    } else if (kind == "FISHEYE") {
      camera.lens = Camera::Lens::fisheye;
      camera.distortion = {number("k1"), number("k2"), number("k3"), number("k4")};
    } else if (kind != "NULL") {
      throw Error(ErrorCode::input, fmt::format("lenses of kind {} cannot be used", kind), path_,
                  "convert it: convert_pinhole_model --output-type TSAI");
    }
    return camera;
  }

  const Tsai& file_;
  const std::string& path_;
};

}  // namespace

void register_camera_format_tsai(CameraFormats& formats);
void register_camera_format_tsai(CameraFormats& formats) {
  formats.add({.name = "tsai",
               .summary = "Ames Stereo Pipeline: pinhole .tsai, one per image",
               .recognises =
                   [](const CameraSource& s) {
                     return s.head.starts_with("VERSION_") ||
                            (s.head.find("fu =") != s.head.npos && s.head.find("\nR =") != s.head.npos);
                   },
               .read = [](const CameraSource& s) { return TsaiReader(parse(s.path), s.path).read(); }});
}

}  // namespace waymark::importers
