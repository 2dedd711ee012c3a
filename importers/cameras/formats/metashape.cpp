// SPDX-License-Identifier: Apache-2.0
// Agisoft Metashape: cameras.xml.
//  - A camera's <transform> is camera to chunk; the chunk's (scale, rotation, translation) continues to the
//    centre of the Earth, or to local metres if the reference is a LOCAL_CS. Without it the frame is
//    arbitrary.
//  - u = w / 2 + cx + x' f + x' b1 + y' b2, v = h / 2 + cy + y' f, pixel corners at whole numbers: 0.5 is
//    subtracted.
//  - p1 and p2 are OpenCV's p2 and p1. k4, which OpenCV lacks, is fitted by the others.
#include <cpl_minixml.h>
#include <fmt/format.h>

#include <map>
#include <memory>

#include "core/error.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/fit_lens.hpp"
#include "importers/gdal_session.hpp"
#include "importers/json_value.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

using XmlNode = const CPLXMLNode*;

std::string value(XmlNode node, const char* path) {
  return CPLGetXMLValue(node, path, "");
}

// Returns the children of that name.
std::vector<XmlNode> children(XmlNode parent, const char* name) {
  std::vector<XmlNode> found;
  for (XmlNode child = parent ? parent->psChild : nullptr; child; child = child->psNext)
    if (child->eType == CXT_Element && std::string(child->pszValue) == name) found.push_back(child);
  return found;
}

class MetashapeReader {
 public:
  explicit MetashapeReader(const CameraSource& source) : path_(source.path) {
    const std::string content = read_vsi_text(path_);
    const GdalListener gdal;
    document_.reset(CPLParseXMLString(content.c_str()));
    XmlNode root = document_ ? CPLGetXMLNode(document_.get(), "=document") : nullptr;
    const auto chunks = children(root, "chunk");
    if (chunks.size() > 1) file_.warnings.push_back(path_ + ": it has several chunks, the first is used");
    chunk_ = chunks.empty() ? nullptr : chunks.front();
    if (!chunk_)
      throw Error(ErrorCode::input, "this is no camera file of Metashape: it has no chunk", path_,
                  "export it with File > Export > Export Cameras, format Agisoft XML");
  }

  CameraFile read() {
    for (XmlNode sensor : children(CPLGetXMLNode(chunk_, "sensors"), "sensor")) add_sensor(sensor);
    read_world();
    add_cameras(CPLGetXMLNode(chunk_, "cameras"));
    if (without_pose_ > 0)
      file_.warnings.push_back(fmt::format("{}: {} of {} cameras have no pose: not aligned", path_,
                                           without_pose_, file_.images.size()));
    return std::move(file_);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& place) const {
    throw Error(ErrorCode::input, problem, path_ + ", " + place, "export the cameras again");
  }

  double number(XmlNode node, const char* name, double otherwise) const {
    const std::string text = value(node, name);
    double found = otherwise;
    if (!text.empty() && !parse_number(text, found))
      refuse(fmt::format("{} must be a number, is '{}'", name, text), value(node, "label"));
    return found;
  }

  std::vector<double> numbers(const std::string& text, std::size_t count, const std::string& place) const {
    std::vector<double> all;
    for (std::size_t begin = text.find_first_not_of(" \n\t"); begin < text.size();) {
      const std::size_t end = std::min(text.find_first_of(" \n\t", begin), text.size());
      if (!parse_number(std::string_view(text).substr(begin, end - begin), all.emplace_back()))
        refuse(fmt::format("'{}' is no number", text.substr(begin, end - begin)), place);
      begin = text.find_first_not_of(" \n\t", end);
    }
    if (all.size() != count)
      refuse(fmt::format("there are {} numbers, {} are needed", all.size(), count), place);
    return all;
  }

  // Uses the adjusted calibration if there is one, else the initial one, else a plain lens of the nominal
  // focal length.
  void add_sensor(XmlNode sensor) {
    const std::string label = "sensor " + value(sensor, "label");
    const auto calibrations = children(sensor, "calibration");
    XmlNode best = calibrations.empty() ? nullptr : calibrations.front();
    for (XmlNode calibration : calibrations)
      if (value(calibration, "class") == "adjusted") best = calibration;
    const std::string type = value(best ? best : sensor, "type");
    if (type != "frame" && type != "fisheye") return;  // refused if a camera uses it
    Camera camera;
    camera.columns = static_cast<std::int64_t>(number(sensor, "resolution.width", 0));
    camera.rows = static_cast<std::int64_t>(number(sensor, "resolution.height", 0));
    const double f = best ? number(best, "f", 0) : nominal_focal(sensor);
    if (camera.columns < 1 || camera.rows < 1 || !(f > 0)) return;
    camera.fx = f + number(best, "b1", 0);
    camera.skew = number(best, "b2", 0);
    camera.fy = f;
    camera.cx = static_cast<double>(camera.columns) / 2 + number(best, "cx", 0) - 0.5;
    camera.cy = static_cast<double>(camera.rows) / 2 + number(best, "cy", 0) - 0.5;
    const auto k = [&](const char* name) { return number(best, name, 0); };
    if (type == "fisheye") {
      camera.lens = Camera::Lens::fisheye;
      camera.distortion = {k("k1"), k("k2"), k("k3"), k("k4")};
      if (k("p1") != 0 || k("p2") != 0)
        file_.warnings.push_back(
            fmt::format("{}: {}: p1 and p2 of a fisheye lens are left out", path_, label));
    } else {
      camera.distortion = {k("k1"), k("k2"), k("p2"), k("p1"), k("k3")};
      if (k("k4") != 0) fit_k4(camera, k("k4"), label);
    }
    sensors_[value(sensor, "id")] = camera;
  }

  double nominal_focal(XmlNode sensor) const {
    const double pixel = property(sensor, "pixel_width");
    return pixel > 0 ? property(sensor, "focal_length") / pixel : 0;
  }

  double property(XmlNode sensor, const char* name) const {
    for (XmlNode property : children(sensor, "property"))
      if (value(property, "name") == name) return number(property, "value", 0);
    return 0;
  }

  void fit_k4(Camera& camera, double k4, const std::string& label) {
    std::vector<LensPair> pairs;
    const double right = static_cast<double>(camera.columns) / (2 * camera.fx),
                 low = static_cast<double>(camera.rows) / (2 * camera.fy);
    const auto& d = camera.distortion;
    for (int i = -10; i <= 10; ++i)
      for (int j = -10; j <= 10; ++j) {
        const Eigen::Vector2d p(right * i / 10, low * j / 10);
        const double x = p.x(), y = p.y(), s = p.squaredNorm();
        const double radial = 1 + s * (d[0] + s * (d[1] + s * (d[4] + s * k4)));
        pairs.push_back({p, Eigen::Vector2d(x * radial + 2 * d[2] * x * y + d[3] * (s + 2 * x * x),
                                            y * radial + d[2] * (s + 2 * y * y) + 2 * d[3] * x * y)});
      }
    const FittedLens fitted = fit_brown(pairs);
    camera.distortion = fitted.distortion;
    file_.warnings.push_back(fmt::format("{}: {}: k4 is fitted by k1, k2 and k3, within {:.2g} pixels", path_,
                                         label, fitted.max_error * camera.fx));
  }

  void read_world() {
    const std::string reference = value(chunk_, "reference");
    XmlNode transform = CPLGetXMLNode(chunk_, "transform");
    if (!transform || value(transform, "rotation").empty()) return;
    const auto r = numbers(value(transform, "rotation"), 9, "chunk transform, rotation");
    const auto t = numbers(value(transform, "translation"), 3, "chunk transform, translation");
    for (int i = 0; i < 9; ++i) rotation_(i / 3, i % 3) = r[static_cast<std::size_t>(i)];
    shift_ = {t[0], t[1], t[2]};
    scale_ = number(transform, "scale", 1);
    if (reference.empty()) return;
    const bool local = reference.starts_with("LOCAL_CS") || reference.starts_with("ENGCRS");
    file_.world.axes = local ? CameraWorld::Axes::grid : CameraWorld::Axes::earth;
    if (local) file_.world.crs = "local";
  }

  void add_cameras(XmlNode parent) {
    for (XmlNode group : children(parent, "group")) add_cameras(group);
    for (XmlNode node : children(parent, "camera")) {
      CameraRecord record;
      record.image = value(node, "label");
      record.location = "camera " + value(node, "id");
      const auto sensor = sensors_.find(value(node, "sensor_id"));
      if (sensor != sensors_.end()) record.camera = sensor->second;
      const std::string transform = value(node, "transform");
      if (transform.empty() || value(node, "enabled") == "false" || value(node, "enabled") == "0")
        ++without_pose_;
      else
        record.world_from_camera = pose_of(numbers(transform, 16, record.location));
      if (record.world_from_camera && !record.camera)
        refuse(
            "its sensor has no usable calibration: frame and fisheye cameras with a focal length are needed",
            record.location);
      file_.images.push_back(std::move(record));
    }
  }

  Eigen::Isometry3d pose_of(const std::vector<double>& m) const {
    Eigen::Matrix4d chunk_from_camera;
    for (int i = 0; i < 16; ++i) chunk_from_camera(i / 4, i % 4) = m[static_cast<std::size_t>(i)];
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = rotation_ * chunk_from_camera.topLeftCorner<3, 3>();
    pose.translation() = scale_ * (rotation_ * chunk_from_camera.block<3, 1>(0, 3)) + shift_;
    return pose;
  }

  struct Destroy {
    void operator()(CPLXMLNode* node) const { CPLDestroyXMLNode(node); }
  };

  const std::string& path_;
  std::unique_ptr<CPLXMLNode, Destroy> document_;
  XmlNode chunk_ = nullptr;
  std::map<std::string, Camera> sensors_;
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();
  double scale_ = 1;
  std::size_t without_pose_ = 0;
  CameraFile file_;
};

}  // namespace

void register_camera_format_metashape(CameraFormats& formats);
void register_camera_format_metashape(CameraFormats& formats) {
  formats.add({.name = "metashape",
               .summary = "Agisoft Metashape: cameras.xml",
               .recognises =
                   [](const CameraSource& s) {
                     return s.head.find("<document") != s.head.npos && s.head.find("<chunk") != s.head.npos;
                   },
               .read = [](const CameraSource& s) { return MetashapeReader(s).read(); }});
}

}  // namespace waymark::importers
