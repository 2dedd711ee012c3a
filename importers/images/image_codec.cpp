// SPDX-License-Identifier: Apache-2.0
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/json_text.hpp"
#include "importers/images/image_set.hpp"

namespace waymark::importers {
namespace {

using Json = nlohmann::json;

// Caches CRSs: a set has few of them, and making one costs a millisecond. Copies share the definition.
class CrsMaker {
 public:
  Crs operator()(const std::string& text) {
    const auto known = made_.find(text);
    return known != made_.end() ? known->second : made_.emplace(text, Crs::from_text(text)).first->second;
  }

 private:
  std::map<std::string, Crs> made_;
};

std::string text_of(const Crs& crs) {
  return crs.kind() == CrsKind::local ? "local" : crs.wkt2();
}

template <class Matrix>
Json json_of(const Eigen::MatrixBase<Matrix>& matrix) {
  Json all = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) all.push_back(matrix(r, c));
  return all;
}

template <class Matrix>
void read(const Json& json, Eigen::MatrixBase<Matrix>& into) {
  std::size_t i = 0;
  for (Eigen::Index r = 0; r < into.rows(); ++r)
    for (Eigen::Index c = 0; c < into.cols(); ++c) into(r, c) = json.at(i++).get<double>();
}

Json json_of(const PosedCamera& view) {
  const Camera& c = view.camera;
  Json json{{"size", {c.columns, c.rows}},
            {"focal", {c.fx, c.fy}},
            {"centre", {c.cx, c.cy}},
            {"skew", c.skew},
            {"fisheye", c.lens == Camera::Lens::fisheye},
            {"distortion", c.distortion},
            {"pose", json_of(view.grid_from_camera.transform.affine())},
            {"covariance", json_of(view.covariance)}};
  if (const auto& m = view.motion)
    json["motion"] = {{"shift", json_of(m->shift)}, {"turn", json_of(m->turn)}};
  return json;
}

PosedCamera view_of(const Json& json) {
  PosedCamera view;
  Camera& c = view.camera;
  c.columns = json.at("size").at(0);
  c.rows = json.at("size").at(1);
  c.fx = json.at("focal").at(0);
  c.fy = json.at("focal").at(1);
  c.cx = json.at("centre").at(0);
  c.cy = json.at("centre").at(1);
  c.skew = json.at("skew");
  c.lens = json.at("fisheye").get<bool>() ? Camera::Lens::fisheye : Camera::Lens::brown;
  c.distortion = json.at("distortion");
  Eigen::Matrix<double, 3, 4> pose;
  read(json.at("pose"), pose);
  view.grid_from_camera.transform.linear() = pose.leftCols<3>();
  view.grid_from_camera.transform.translation() = pose.col(3);
  read(json.at("covariance"), view.covariance);
  if (json.contains("motion")) {
    view.motion.emplace();
    read(json["motion"].at("shift"), view.motion->shift);
    read(json["motion"].at("turn"), view.motion->turn);
  }
  return view;
}

Json json_of(const ImageInfo& image) {
  Json json{
      {"name", image.name},        {"path", image.path},           {"size", {image.columns, image.rows}},
      {"crs", text_of(image.crs)}, {"saturated", image.saturated}, {"taken_utc", image.taken_utc}};
  if (image.view) json["view"] = json_of(*image.view);
  if (const auto& o = image.ortho) json["ortho"] = {o->x0, o->y0, o->dx, o->dy};
  if (const auto& s = image.sun) json["sun"] = {s->azimuth.value, s->elevation.value, s->sd.value};
  if (image.image_sun_angle) json["image_sun_angle"] = image.image_sun_angle->value;
  if (image.gsd) json["gsd"] = image.gsd->value;
  return json;
}

ImageInfo info_of(const Json& json, CrsMaker& crs) {
  ImageInfo image;
  image.name = json.at("name");
  image.path = json.at("path");
  image.columns = json.at("size").at(0);
  image.rows = json.at("size").at(1);
  image.crs = crs(json.at("crs"));
  image.saturated = json.at("saturated");
  image.taken_utc = json.at("taken_utc");
  if (json.contains("view")) image.view = view_of(json["view"]);
  if (json.contains("ortho")) {
    const Json& o = json["ortho"];
    image.ortho = Georeference{image.crs, o.at(0), o.at(1), o.at(2), o.at(3)};
  }
  if (json.contains("sun")) {
    const Json& s = json["sun"];
    image.sun = Sun{Degrees{s.at(0)}, Degrees{s.at(1)}, Degrees{s.at(2)}};
  }
  if (json.contains("image_sun_angle")) image.image_sun_angle = Degrees{json["image_sun_angle"]};
  if (json.contains("gsd")) image.gsd = Meters{json["gsd"]};
  return image;
}

}  // namespace

std::string to_json(const ImageInfo& image) {
  return json_of(image).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string encode_images(const ImageSet& images) {
  Json all = Json::array();
  for (const ImageHandle& image : images) {
    const auto* imported = dynamic_cast<const ImportedImage*>(image.get());
    if (!imported) throw std::logic_error("only images in files can be stored in a work folder");
    Json one = json_of(imported->info());
    one["band"] = imported->band();
    all.push_back(std::move(one));
  }
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

ImageSet decode_images(std::string_view bytes) {
  CrsMaker crs;
  std::vector<ImageInfo> images;
  int band = 0;
  for (const Json& one : Json::parse(checked_json(bytes, "images"))) {
    images.push_back(info_of(one, crs));
    band = one.at("band");
  }
  return image_set(images, band);
}

}  // namespace waymark::importers
