// SPDX-License-Identifier: Apache-2.0
// Image support data of the Community Sensor Model, as ALE writes them: JSON, frame cameras only; one per
// image, of the same name.
//  - Quaternions (w x y z) rotate J2000 into the body's and the instrument's frame; a constant rotation,
//    row by row, continues to the body-fixed frame and the camera.
//  - Positions are in J2000 from the body's centre, km if no unit is named.
//  - A pixel's position on the detector solves (sample, line) - centre = M (x, y) in mm; the ray is (x, y,
//    focal length). CSM counts pixels from the corner of the first: 0.5 is subtracted.
//  - Lenses: radial and transverse are given as in USGSCSM, in mm, and fitted by the Brown model; radtan is
//    Brown.
#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/fit_lens.hpp"
#include "importers/json_value.hpp"

namespace waymark::importers {
namespace {

// Returns the index of the time nearest to the middle of the exposure.
std::size_t moment(const JsonValue& table, std::size_t count, double time) {
  std::size_t best = 0;
  if (!table.has("ephemeris_times") || table["ephemeris_times"].size() != count) return 0;
  const JsonValue times = table["ephemeris_times"];
  for (std::size_t i = 1; i < count; ++i)
    if (std::abs(times[i].number() - time) < std::abs(times[best].number() - time)) best = i;
  return best;
}

// Returns the rotation from J2000 to the frame.
Eigen::Matrix3d rotation_of(const JsonValue& table, double time) {
  const JsonValue all = table["quaternions"];
  const auto q = all[moment(table, all.size(), time)].numbers();
  const double norm = q.size() == 4 ? Eigen::Vector4d(q[0], q[1], q[2], q[3]).norm() : 0;
  if (!(std::abs(norm - 1) < 1e-3)) all.refuse("this is no rotation: w, x, y, z of length 1 are needed");
  const Eigen::Matrix3d turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return table.has("constant_rotation") ? Eigen::Matrix3d(table["constant_rotation"].matrix3() * turn) : turn;
}

Eigen::Vector3d position_of(const JsonValue& table, double time) {
  const JsonValue all = table["positions"];
  const std::string unit = table.has("unit") ? table["unit"].text() : "km";
  if (unit != "km" && unit != "m")
    table["unit"].refuse(fmt::format("'{}' is no unit of length here", unit), "units: m, km");
  return all[moment(table, all.size(), time)].vector3() * (unit == "km" ? 1000 : 1);
}

// Distortion on the detector, mm: where a ray that would reach `p` without a lens arrives, or the inverse.
struct Distortion {
  std::string kind;
  std::vector<double> k, ky;

  bool is_none() const {
    return std::ranges::all_of(k, [](double v) { return v == 0; });
  }
  Eigen::Vector2d radial_inverse(const Eigen::Vector2d& distorted) const {
    const double s = distorted.squaredNorm();
    return distorted * (1 - (k[0] + s * (k[1] + s * k[2])));
  }
  Eigen::Vector2d transverse(const Eigen::Vector2d& p) const {
    const double x = p.x(), y = p.y();
    const std::array<double, 10> terms{1,     x,         y,         x * x,     x * y,
                                       y * y, x * x * x, x * x * y, x * y * y, y * y * y};
    Eigen::Vector2d out(0, 0);
    for (std::size_t i = 0; i < 10; ++i) out += terms[i] * Eigen::Vector2d(k[i], ky[i]);
    return out;
  }
};

Distortion distortion_of(const JsonValue& json) {
  const std::vector<std::string> kinds = json.keys();
  if (kinds.empty()) return {"none", {}, {}};
  Distortion found{kinds[0], {}, {}};
  const JsonValue terms = json[kinds[0]];
  if (found.kind == "transverse") {
    found.k = terms["x"].numbers();
    found.ky = terms["y"].numbers();
    if (found.k.size() != 10 || found.ky.size() != 10)
      terms.refuse("a transverse distortion has 10 terms in x and y");
    return found;
  }
  found.k = terms["coefficients"].numbers();
  if (found.is_none()) return {"none", {}, {}};
  if (found.kind == "radial") found.k.resize(3, 0);
  if (found.kind == "radtan") found.k.resize(5, 0);
  if (found.kind != "radial" && found.kind != "radtan")
    terms.refuse(fmt::format("lenses of kind '{}' cannot be used", found.kind),
                 "kinds: radial, radtan, transverse; use an orthophoto made by ISIS or ASP instead");
  return found;
}

class IsdReader {
 public:
  explicit IsdReader(const JsonValue& root) : root_(root), time_(root.number("center_ephemeris_time", 0)) {}

  CameraRecord record(const std::string& image) {
    CameraRecord made;
    made.image = image;
    made.location = "the camera";
    set_detector();
    made.camera = camera();
    const Eigen::Matrix3d body = rotation_of(root_["body_rotation"], time_);
    const Eigen::Matrix3d body_from_sensor =
        body * rotation_of(root_["instrument_pointing"], time_).transpose();
    const Eigen::Vector3d place = body * position_of(root_["instrument_position"], time_);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = body_from_sensor * sensor_from_ours_;
    pose.translation() = place;
    made.world_from_camera = pose;
    if (root_.has("sun_position"))
      made.towards_sun = body * position_of(root_["sun_position"], time_) - place;
    return made;
  }

 private:
  // (sample, line) = affine_ * (x, y in mm) + origin_, pixels with the centre of the first at 0.
  void set_detector() {
    const auto s = root_["focal2pixel_samples"].numbers(), l = root_["focal2pixel_lines"].numbers();
    if (s.size() != 3 || l.size() != 3)
      root_.refuse("focal2pixel_samples and focal2pixel_lines have 3 numbers each");
    affine_ << s[1], s[2], l[1], l[2];
    const Eigen::Vector2d summing(root_.number("detector_sample_summing", 1),
                                  root_.number("detector_line_summing", 1));
    const Eigen::Vector2d start(root_.number("starting_detector_sample", 0),
                                root_.number("starting_detector_line", 0));
    const JsonValue centre = root_["detector_center"];
    origin_ = Eigen::Vector2d(centre["sample"].number() + s[0], centre["line"].number() + l[0]) - start;
    origin_ = origin_.cwiseQuotient(summing) - Eigen::Vector2d(0.5, 0.5);
    affine_ = summing.cwiseInverse().asDiagonal() * affine_;
    if (!(std::abs(affine_.determinant()) > 1e-12))
      root_["focal2pixel_lines"].refuse("pixels and focal plane do not meet");
    // affine_ = upper triangle * turn of the focal plane; a mirrored image has fx < 0.
    const double angle = std::atan2(-affine_(1, 0), affine_(1, 1));
    turn_ = Eigen::Rotation2Dd(angle).toRotationMatrix().transpose();
    triangle_ = affine_ * turn_.transpose();
    sensor_from_ours_ = Eigen::Matrix3d::Identity();
    sensor_from_ours_.topLeftCorner<2, 2>() = turn_.transpose();
  }

  Camera camera() const {
    const double focal = root_["focal_length_model"]["focal_length"].number();
    if (!(focal > 0))
      root_["focal_length_model"]["focal_length"].refuse(fmt::format("a focal length of {}", focal));
    Camera camera;
    camera.columns = root_["image_samples"].integer();
    camera.rows = root_["image_lines"].integer();
    camera.fx = triangle_(0, 0) * focal;
    camera.skew = triangle_(0, 1) * focal;
    camera.fy = triangle_(1, 1) * focal;
    camera.cx = origin_.x();
    camera.cy = origin_.y();
    const Distortion lens = distortion_of(root_["optical_distortion"]);
    if (lens.kind == "radtan") {
      const double f2 = focal * focal;
      camera.distortion = {lens.k[0] * f2, lens.k[1] * f2 * f2, lens.k[2] * focal, lens.k[3] * focal,
                           lens.k[4] * f2 * f2 * f2};
    } else if (lens.kind != "none") {
      fit(lens, focal, camera);
    }
    return camera;
  }

  void fit(const Distortion& lens, double focal, Camera& camera) const {
    std::vector<LensPair> pairs;
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20; ++j) {
        const Eigen::Vector2d pixel((static_cast<double>(camera.columns) - 1) * i / 20,
                                    (static_cast<double>(camera.rows) - 1) * j / 20);
        const Eigen::Vector2d place = affine_.inverse() * (pixel - origin_);
        Eigen::Vector2d undistorted = place, distorted = place;
        if (lens.kind == "radial") undistorted = lens.radial_inverse(place);
        if (lens.kind == "transverse") distorted = lens.transverse(place);
        pairs.push_back({turn_ * undistorted / focal, turn_ * distorted / focal});
      }
    const FittedLens fitted = fit_brown(pairs);
    const double max_error = fitted.max_error * std::max(std::abs(camera.fx), camera.fy);
    constexpr double kTolerated = 0.25;  // pixels
    if (!(max_error < kTolerated))
      root_["optical_distortion"].refuse(
          fmt::format("the {} distortion differs by {:.2g} pixels from the best Brown model", lens.kind,
                      max_error),
          "use an orthophoto made by ISIS or ASP instead");
    camera.distortion = fitted.distortion;
  }

  JsonValue root_;
  double time_;
  Eigen::Matrix2d affine_, turn_, triangle_;
  Eigen::Matrix3d sensor_from_ours_;
  Eigen::Vector2d origin_;
};

CameraFile read_csm_isd(const CameraSource& source) {
  const JsonValue root = JsonValue::from_file(source.path);
  const std::string model = root["name_model"].text();
  if (model != "USGS_ASTRO_FRAME_SENSOR_MODEL")
    root["name_model"].refuse(fmt::format("this is no frame camera: {}", model),
                              "for line scanners use orthophotos made by ISIS or ASP; they need no camera");
  std::filesystem::path name(source.path);
  name.replace_extension();
  CameraFile file;
  file.world.axes = CameraWorld::Axes::earth;
  file.images.push_back(IsdReader(root).record(name.filename().string()));
  return file;
}

}  // namespace

void register_camera_format_csm_isd(CameraFormats& formats);
void register_camera_format_csm_isd(CameraFormats& formats) {
  formats.add({.name = "csm_isd",
               .summary = "CSM image support data of frame cameras (ALE), one per image",
               .recognises =
                   [](const CameraSource& s) {
                     return s.head.find("\"name_model\"") != s.head.npos ||
                            s.head.find("\"isis_camera_version\"") != s.head.npos;
                   },
               .read = read_csm_isd});
}

}  // namespace waymark::importers
