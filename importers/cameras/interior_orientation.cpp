// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/interior_orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

double positive(const JsonValue& value) {
  const double number = value.number();
  if (!(number > 0)) value.refuse(fmt::format("this must be positive, is {}", number));
  return number;
}

// "key: value" lines under headings, the subset of YAML in Orthority's files.
struct YamlSection {
  std::string name;
  std::size_t line = 0;
  std::map<std::string, std::string> values;
};

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\"'"), end = text.find_last_not_of(" \t\r\"'");
  return begin == text.npos ? "" : std::string(text.substr(begin, end - begin + 1));
}

std::vector<YamlSection> sections_of(const std::string& content) {
  std::vector<YamlSection> sections;
  std::size_t line = 0;
  for (std::size_t begin = 0; begin < content.size();) {
    const std::size_t end = std::min(content.find('\n', begin), content.size());
    std::string_view text = std::string_view(content).substr(begin, end - begin);
    begin = end + 1;
    ++line;
    text = text.substr(0, text.find('#'));
    const std::size_t colon = text.find(':');
    if (colon == text.npos) continue;
    const std::string key = trimmed(text.substr(0, colon)), value = trimmed(text.substr(colon + 1));
    if (text[0] != ' ' && text[0] != '\t')
      sections.push_back({key, line, {}});
    else if (!sections.empty())
      sections.back().values[key] = value;
  }
  return sections;
}

// "[640, 1152]" or "120.".
std::vector<double> numbers_in(std::string text, const YamlSection& at, const std::string& path) {
  std::ranges::replace_if(
      text, [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  std::vector<double> numbers;
  for (std::size_t begin = text.find_first_not_of(' '); begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (!parse_number(std::string_view(text).substr(begin, end - begin), numbers.emplace_back()))
      refuse_line(path, at.line, fmt::format("'{}' is no number", text.substr(begin, end - begin)));
    begin = text.find_first_not_of(' ', end);
  }
  return numbers;
}

Camera camera_from_yaml(const YamlSection& s, const std::string& path) {
  const auto values = [&](const char* key, std::size_t min_count) {
    const auto found = s.values.find(key);
    auto numbers = found == s.values.end() ? std::vector<double>{} : numbers_in(found->second, s, path);
    if (numbers.size() < min_count)
      refuse_line(path, s.line, fmt::format("camera '{}' needs {} of {} number(s)", s.name, key, min_count));
    return numbers;
  };
  const auto value = [&](const char* key) {
    const auto found = values(key, 0);
    return found.empty() ? 0 : found[0];
  };
  const auto size = values("im_size", 2), sensor = values("sensor_size", 2), focal = values("focal_len", 1);
  if (!(size[0] >= 1 && size[1] >= 1 && sensor[0] > 0 && sensor[1] > 0))
    refuse_line(path, s.line, fmt::format("camera '{}' has no size", s.name));
  Camera camera;
  camera.columns = static_cast<std::int64_t>(size[0]);
  camera.rows = static_cast<std::int64_t>(size[1]);
  camera.fx = focal[0] / sensor[0] * size[0];
  camera.fy = focal.back() / sensor[1] * size[1];
  const double longest = std::max(size[0], size[1]);
  camera.cx = value("cx") * longest + size[0] / 2 - 0.5;
  camera.cy = value("cy") * longest + size[1] / 2 - 0.5;
  const auto kind = s.values.find("type");
  const std::string lens = kind == s.values.end() ? "pinhole" : kind->second;
  if (lens == "fisheye") {
    camera.lens = Camera::Lens::fisheye;
    camera.distortion = {value("k1"), value("k2"), value("k3"), value("k4")};
  } else if (lens == "brown" || lens == "opencv") {
    camera.distortion = {value("k1"), value("k2"), value("p1"), value("p2"),
                         value("k3"), value("k4"), value("k5"), value("k6")};
  } else if (lens != "pinhole") {
    refuse_line(path, s.line, fmt::format("camera '{}' has a lens of type '{}'", s.name, lens),
                "types: pinhole, brown, opencv, fisheye");
  }
  return camera;
}

std::map<std::string, Camera> from_yaml(const std::string& path) {
  std::map<std::string, Camera> all;
  for (const YamlSection& section : sections_of(read_vsi_text(path)))
    if (section.values.contains("focal_len")) {
      const auto name = section.values.find("name");
      all[name == section.values.end() ? section.name : name->second] = camera_from_yaml(section, path);
    }
  return all;
}

void add_cameras(const JsonValue& cameras, std::map<std::string, Camera>& all) {
  for (const std::string& name : cameras.keys())
    all[name] = cameras[name].has("projection_type") ? camera_from_opensfm(cameras[name])
                                                     : camera_from_json(cameras[name]);
}

std::map<std::string, Camera> from_json(const std::string& path) {
  const JsonValue root = JsonValue::from_file(path, {"points", "shots", "images"});
  std::map<std::string, Camera> all;
  if (root.is_array())
    for (std::size_t i = 0; i < root.size(); ++i) add_cameras(root[i]["cameras"], all);
  else
    add_cameras(root.has("cameras") ? root["cameras"] : root, all);
  return all;
}

}  // namespace

Camera camera_from_json(const JsonValue& json) {
  json.expect_only({"columns", "rows", "fx", "fy", "cx", "cy", "skew", "lens", "distortion", "readout_time"});
  Camera camera;
  camera.columns = json["columns"].integer();
  camera.rows = json["rows"].integer();
  if (camera.columns < 1 || camera.rows < 1)
    json.refuse(fmt::format("an image of {} x {} pixels", camera.columns, camera.rows),
                "columns and rows are 1 or more");
  camera.fx = positive(json["fx"]);
  camera.fy = positive(json["fy"]);
  camera.cx = json["cx"].number();
  camera.cy = json["cy"].number();
  camera.skew = json.number("skew", 0);
  const std::string lens = json.has("lens") ? json["lens"].text() : "brown";
  if (lens != "brown" && lens != "fisheye")
    json["lens"].refuse(fmt::format("'{}' is no lens", lens), "lenses: brown, fisheye");
  camera.lens = lens == "fisheye" ? Camera::Lens::fisheye : Camera::Lens::brown;
  if (!json.has("distortion")) return camera;
  const auto numbers = json["distortion"].numbers();
  const std::size_t max_count = camera.lens == Camera::Lens::fisheye ? 4 : 8;
  if (numbers.size() > max_count)
    json["distortion"].refuse(
        fmt::format("{} coefficients, a {} lens has {}", numbers.size(), lens, max_count),
        "brown: k1 k2 p1 p2 k3 k4 k5 k6; fisheye: k1 k2 k3 k4");
  std::copy(numbers.begin(), numbers.end(), camera.distortion.begin());
  return camera;
}

double readout_time_from_json(const JsonValue& json) {
  const double time = json.number("readout_time", 0);
  if (!(time >= 0 && time <= 10))
    json["readout_time"].refuse(fmt::format("a readout time of {} s", time),
                                "seconds from the first row to the last, 0 (global shutter) to 10");
  return time;
}

Camera camera_from_opensfm(const JsonValue& json) {
  const std::string kind = json["projection_type"].text();
  Camera camera;
  camera.columns = json["width"].integer();
  camera.rows = json["height"].integer();
  if (camera.columns < 1 || camera.rows < 1)
    json.refuse(fmt::format("an image of {} x {} pixels", camera.columns, camera.rows));
  const auto width = static_cast<double>(camera.columns), height = static_cast<double>(camera.rows);
  const double size = std::max(width, height);
  const bool one_focal = json.has("focal");
  const double ratio = one_focal ? json.number("aspect_ratio", 1) : 1;
  const double focal_x = one_focal ? json["focal"].number() : json["focal_x"].number();
  const double focal_y = one_focal ? focal_x * ratio : json["focal_y"].number();
  camera.fx = focal_x * size;
  camera.fy = focal_y * size;
  camera.cx = json.number("c_x", 0) * size + width / 2 - 0.5;
  camera.cy = json.number("c_y", 0) * size + height / 2 - 0.5;
  const auto k = [&](const char* name) { return json.number(name, 0); };
  auto& d = camera.distortion;
  if (kind == "perspective" || kind == "simple_radial" || kind == "radial") {
    d[0] = k("k1");
    d[1] = k("k2");
  } else if (kind == "brown") {
    d = {k("k1"), k("k2"), k("p1"), k("p2"), k("k3")};
  } else if (kind == "fisheye" || kind == "fisheye_opencv") {
    camera.lens = Camera::Lens::fisheye;
    d = {k("k1"), k("k2"), k("k3"), k("k4")};
  } else {
    json["projection_type"].refuse(fmt::format("images in '{}' projection cannot be used", kind),
                                   "perspective, simple_radial, radial, brown, fisheye and fisheye_opencv "
                                   "can; others must be resampled");
  }
  return camera;
}

std::map<std::string, Camera> read_interior(const std::string& path) {
  const std::string head = read_vsi_head(path);
  const std::size_t start = head.find_first_not_of(" \t\r\n");
  const bool json = start != head.npos && (head[start] == '{' || head[start] == '[');
  auto all = json ? from_json(path) : from_yaml(path);
  if (all.empty())
    throw Error(ErrorCode::input, "the file has no interior orientation of a camera", path,
                "docs/reference/camera_formats.md shows what can be read");
  return all;
}

Camera interior_named(const std::map<std::string, Camera>& all, const std::string& name,
                      const std::string& path) {
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  if (all.size() == 1) return all.begin()->second;
  throw Error(ErrorCode::input, fmt::format("none of the {} cameras is named '{}'", all.size(), name), path,
              fmt::format("one of them: {}", all.begin()->first));
}

}  // namespace waymark::importers
