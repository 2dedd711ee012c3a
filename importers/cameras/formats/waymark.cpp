// SPDX-License-Identifier: Apache-2.0
// Waymark's own camera file; docs/reference/camera_file.md.
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <map>

#include "core/solve.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/interior_orientation.hpp"
#include "importers/images/sun_position.hpp"
#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

CameraWorld world_of(const JsonValue& frame) {
  frame.expect_only({"axes", "crs", "origin"});
  const std::map<std::string, CameraWorld::Axes> kinds{{"grid", CameraWorld::Axes::grid},
                                                       {"enu", CameraWorld::Axes::enu},
                                                       {"body_fixed", CameraWorld::Axes::earth},
                                                       {"arbitrary", CameraWorld::Axes::arbitrary}};
  const JsonValue axes = frame["axes"];
  const auto kind = kinds.find(axes.text());
  if (kind == kinds.end())
    axes.refuse(fmt::format("'{}' is no kind of axes", axes.text()),
                "kinds: grid, enu, body_fixed, arbitrary");
  CameraWorld world{.axes = kind->second};
  if (frame.has("crs")) world.crs = frame["crs"].text();
  if (world.axes == CameraWorld::Axes::enu) world.origin = frame["origin"].vector3();
  return world;
}

Sun sun_of(const JsonValue& sun) {
  sun.expect_only({"azimuth", "elevation", "sd"});
  const double azimuth = sun["azimuth"].number(), elevation = sun["elevation"].number();
  if (!(elevation > 0 && elevation <= 90))
    sun["elevation"].refuse(fmt::format("the sun is below the horizon: elevation {}", elevation),
                            "degrees above the horizontal, (0, 90]");
  if (!(azimuth >= -360 && azimuth <= 360))
    sun["azimuth"].refuse(fmt::format("{} is no azimuth", azimuth),
                          "degrees clockwise from grid north, [-360, 360]");
  const double sd = sun.number("sd", Sun{}.sd.value);
  if (!(sd >= 0)) sun["sd"].refuse(fmt::format("a standard deviation of {}", sd), "degrees, 0 or more");
  return {.azimuth = Degrees{azimuth < 0 ? azimuth + 360 : azimuth},
          .elevation = Degrees{elevation},
          .sd = Degrees{sd}};
}

Eigen::Matrix3d rotation_of(const JsonValue& image) {
  if (image.has("quaternion")) {
    if (image.has("rotation")) image.refuse("both rotation and quaternion are given", "leave one out");
    const auto q = image["quaternion"].numbers();
    const double norm = q.size() == 4 ? Eigen::Vector4d(q[0], q[1], q[2], q[3]).norm() : 0;
    if (!(std::abs(norm - 1) < 1e-3))
      image["quaternion"].refuse("this is no rotation: w, x, y, z of length 1 are needed");
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  }
  const Eigen::Matrix3d given = image["rotation"].matrix3();
  const double off = (given * given.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(off < 1e-3))
    image["rotation"].refuse(fmt::format("this is no rotation: R R' is {:.2g} off the identity", off));
  if (!(given.determinant() > 0))
    image["rotation"].refuse("this is a reflection: its determinant is -1", "one axis has the wrong sign");
  const SingularValues3 parts = singular_values(given);
  return parts.u * parts.v.transpose();
}

std::optional<Eigen::Matrix<double, 6, 6>> covariance_of(const JsonValue& image) {
  Eigen::Matrix<double, 6, 6> made = Eigen::Matrix<double, 6, 6>::Zero();
  if (image.has("covariance")) {
    const JsonValue rows = image["covariance"];
    for (std::size_t r = 0; r < 6; ++r) {
      const auto row = rows[r].numbers();
      if (row.size() != 6) rows[r].refuse(fmt::format("this must be 6 numbers, there are {}", row.size()));
      for (std::size_t c = 0; c < 6; ++c) made(static_cast<int>(r), static_cast<int>(c)) = row[c];
    }
    if (!(made - made.transpose()).isZero(1e-9 * (1 + made.norm())) || !(made.diagonal().minCoeff() >= 0))
      rows.refuse("this is no covariance: it must be symmetric, with a diagonal of 0 or more");
    return made;
  }
  if (!image.has("rotation_sd") && !image.has("position_sd")) return std::nullopt;
  const double turn = image.number("rotation_sd", 0) * kRadiansPerDegree,
               shift = image.number("position_sd", 0);
  if (!(turn >= 0 && shift >= 0)) image.refuse("a standard deviation is negative");
  made.diagonal() << turn * turn, turn * turn, turn * turn, shift * shift, shift * shift, shift * shift;
  return made;
}

ShutterMotion motion_of(const JsonValue& motion) {
  motion.expect_only({"shift", "turn"});
  const ShutterMotion made{.shift = motion["shift"].vector3(), .turn = motion["turn"].vector3()};
  if (!(made.turn.norm() < 1))
    motion["turn"].refuse(
        fmt::format("a camera that turns by {:.3g} rad while one image is read out", made.turn.norm()),
        "radians, less than 1");
  return made;
}

class CameraJsonReader {
 public:
  explicit CameraJsonReader(const JsonValue& root) : root_(root) {
    root.expect_only({"waymark_cameras", "frame", "sun", "cameras", "images"});
    if (const auto version = root["waymark_cameras"].integer(); version != 1)
      root["waymark_cameras"].refuse(fmt::format("layout {} is newer than this program", version),
                                     "it reads layout 1");
    if (root.has("sun")) sun_ = sun_of(root["sun"]);
    if (root.has("cameras"))
      for (const std::string& name : root["cameras"].keys()) lenses_[name] = lens_from(root["cameras"][name]);
  }

  CameraRecord record(const JsonValue& image) const {
    image.expect_only({"name", "camera", "centre", "rotation", "quaternion", "rotation_sd", "position_sd",
                       "covariance", "motion", "sun", "sun_direction", "image_sun_angle", "taken_utc"});
    CameraRecord record{.image = image["name"].text(), .location = "at " + image.location()};
    const LensRecord lens = lens_of(image["camera"]);
    record.camera = lens.camera;
    record.readout_time = lens.readout_time;
    if (image.has("centre")) {
      record.world_from_camera = Eigen::Isometry3d::Identity();
      record.world_from_camera->linear() = rotation_of(image);
      record.world_from_camera->translation() = image["centre"].vector3();
    }
    record.covariance = covariance_of(image);
    if (image.has("motion")) record.motion = motion_of(image["motion"]);
    record.sun = sun_;
    if (image.has("sun")) record.sun = sun_of(image["sun"]);
    if (image.has("sun_direction")) {
      record.towards_sun = image["sun_direction"].vector3();
      record.sun.reset();
      if (!(record.towards_sun->norm() > 0)) image["sun_direction"].refuse("this vector has no length");
    }
    if (image.has("image_sun_angle")) record.image_sun_angle = Degrees{image["image_sun_angle"].number()};
    if (image.has("taken_utc")) record.taken_utc = time_of(image["taken_utc"]);
    return record;
  }

  std::vector<LensRecord> lenses() const {
    std::vector<LensRecord> all;
    for (const auto& [name, lens] : lenses_) all.push_back(lens);
    return all;
  }

 private:
  static LensRecord lens_from(const JsonValue& lens) {
    return {.camera = camera_from_json(lens), .readout_time = readout_time_from_json(lens)};
  }

  LensRecord lens_of(const JsonValue& lens) const {
    if (!lens.is_text()) return lens_from(lens);
    const auto found = lenses_.find(lens.text());
    if (found == lenses_.end())
      lens.refuse(fmt::format("there is no camera '{}'", lens.text()), "cameras are listed at /cameras");
    return found->second;
  }

  static std::string time_of(const JsonValue& time) {
    const auto seconds = utc_seconds(time.text());
    if (!seconds)
      time.refuse(fmt::format("'{}' is no time with Z or an offset", time.text()),
                  "write 2021-02-18T20:51:06Z");
    return precise_utc_text(*seconds);
  }

  JsonValue root_;
  std::optional<Sun> sun_;
  std::map<std::string, LensRecord> lenses_;
};

CameraFile read_waymark(const CameraSource& source) {
  const JsonValue root = JsonValue::from_file(source.path);
  const CameraJsonReader reader(root);
  CameraFile file;
  file.lenses = reader.lenses();
  if (!root.has("images") && !file.lenses.empty()) return file;  // lenses only
  file.world = world_of(root["frame"]);
  const JsonValue images = root["images"];
  if (!images.is_array()) images.refuse("this must be an array of images");
  for (std::size_t i = 0; i < images.size(); ++i) file.images.push_back(reader.record(images[i]));
  return file;
}

}  // namespace

void register_camera_format_waymark(CameraFormats& formats);
void register_camera_format_waymark(CameraFormats& formats) {
  formats.add(
      {.name = "waymark",
       .summary = "Waymark's own JSON, docs/reference/camera_file.md",
       .recognises = [](const CameraSource& s) { return s.head.find("\"waymark_cameras\"") != s.head.npos; },
       .read = read_waymark});
}

}  // namespace waymark::importers
