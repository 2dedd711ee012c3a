// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/point_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>

#include "core/error.hpp"
#include "importers/json_value.hpp"
#include "importers/logs/binary_number.hpp"

namespace waymark::importers {
namespace {

constexpr float kFarthestPoint = 1e4F;   // m; of any scanner
constexpr std::size_t kMaxPoints = 1e8;  // a scan has 1e5

[[noreturn]] void refuse_points(const std::filesystem::path& file, const std::string& problem,
                                const std::string& hint) {
  throw Error(ErrorCode::input, problem, file.string(), hint);
}

void keep(const Eigen::Vector3f& p, std::optional<float> intensity, const std::filesystem::path& file,
          localization::PointCloud& cloud) {
  if (!p.allFinite()) return;
  if (!(p.cwiseAbs().maxCoeff() < kFarthestPoint))
    refuse_points(
        file, fmt::format("a point is at {:g}, {:g}, {:g}: no metres from a scanner", p.x(), p.y(), p.z()),
        "points are in the scanner's own frame, x forward, y left, z up; KITTI's .bin has four float32 "
        "a point");
  cloud.points.push_back(p);
  if (intensity) cloud.intensities.push_back(*intensity);
}

localization::PointCloud read_kitti(const std::string& bytes, const std::filesystem::path& file) {
  constexpr std::size_t record = 4 * sizeof(float);
  if (bytes.empty() || bytes.size() % record != 0)
    refuse_points(
        file, fmt::format("{} bytes are no whole number of points", bytes.size()),
        "a KITTI scan has four little-endian float32 a point: x, y, z, intensity; copy the file again");
  static_assert(std::endian::native == std::endian::little);
  localization::PointCloud cloud;
  cloud.points.reserve(bytes.size() / record), cloud.intensities.reserve(bytes.size() / record);
  bool any_intensity = false;
  for (std::size_t at = 0; at < bytes.size(); at += record) {
    float values[4];
    std::memcpy(values, bytes.data() + at, sizeof values);
    keep({values[0], values[1], values[2]}, values[3], file, cloud);
    any_intensity = any_intensity || values[3] != 0;
  }
  if (!any_intensity) cloud.intensities.clear();  // written by a converter that had none
  return cloud;
}

struct PlyProperty {
  NumberType type;
  int axis = -1;  // 0 x, 1 y, 2 z, 3 intensity
};

struct PlyHeader {
  enum class Encoding { ascii, little, big } encoding = Encoding::ascii;
  std::size_t vertices = 0, body = 0;
  std::vector<PlyProperty> properties;  // of a vertex
};

/// A vertex of a PLY file, read property by property.
class PlyVertex {
 public:
  void set(const PlyProperty& property, float value) {
    if (property.axis >= 0 && property.axis < 3) at_(property.axis) = value;
    if (property.axis == 3) intensity_ = value;
  }
  void keep_in(localization::PointCloud& cloud, const std::filesystem::path& file) const {
    keep(at_, intensity_, file, cloud);
  }

 private:
  Eigen::Vector3f at_ = Eigen::Vector3f::Zero();
  std::optional<float> intensity_;
};

bool is_intensity(const std::string& name) {
  return name == "intensity" || name == "reflectance" || name == "reflectivity" ||
         name == "scalar_Intensity" || name == "scalar_intensity";
}

PlyProperty ply_property(const std::string& type, const std::string& name,
                         const std::filesystem::path& file) {
  PlyProperty property;
  const auto is = [&](const char* old, const char* current) { return type == old || type == current; };
  if (is("float", "float32"))
    property.type = {4, true, true};
  else if (is("double", "float64"))
    property.type = {8, true, true};
  else if (is("char", "int8") || is("uchar", "uint8"))
    property.type = {1, false, type[0] != 'u'};
  else if (is("short", "int16") || is("ushort", "uint16"))
    property.type = {2, false, type[0] != 'u'};
  else if (is("int", "int32") || is("uint", "uint32"))
    property.type = {4, false, type[0] != 'u'};
  else
    refuse_points(file, fmt::format("vertices have a property '{}' of the type '{}'", name, type),
                  "lists and unknown types of vertices are not read; write plain numbers");
  property.axis = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : is_intensity(name) ? 3 : -1;
  return property;
}

PlyHeader read_ply_header(const std::string& bytes, const std::filesystem::path& file) {
  PlyHeader header;
  bool in_vertices = false, seen_format = false;
  std::size_t at = 0;
  for (;;) {
    const std::size_t end = bytes.find('\n', at);
    if (end == std::string::npos)
      refuse_points(file, "the header of the PLY file does not end", "copy it again");
    std::istringstream words(bytes.substr(at, end - at));
    at = end + 1;
    std::string word, type, name;
    words >> word;
    if (word == "end_header") break;
    if (word == "format") {
      words >> type;
      seen_format = true;
      if (type == "binary_little_endian")
        header.encoding = PlyHeader::Encoding::little;
      else if (type == "binary_big_endian")
        header.encoding = PlyHeader::Encoding::big;
      else if (type != "ascii")
        refuse_points(file, "there is no PLY format '" + type + "'", "it is ascii or binary");
    } else if (word == "element") {
      std::size_t count = 0;
      words >> type >> count;
      in_vertices = type == "vertex";
      if (in_vertices)
        header.vertices = count;
      else if (header.properties.empty() && count > 0)
        refuse_points(file, "the first element is '" + type + "', not 'vertex'", "write the vertices first");
    } else if (word == "property" && in_vertices) {
      words >> type >> name;
      header.properties.push_back(ply_property(type, name, file));
    }
  }
  header.body = at;
  int axes = 0;
  for (const PlyProperty& property : header.properties) axes |= property.axis >= 0 ? 1 << property.axis : 0;
  if ((axes & 7) != 7 || !seen_format) refuse_points(file, "vertices lack x, y or z", "this is no scan");
  return header;
}

localization::PointCloud read_ply(const std::string& bytes, const std::filesystem::path& file) {
  const PlyHeader header = read_ply_header(bytes, file);
  if (header.vertices > kMaxPoints)
    refuse_points(file, fmt::format("{} vertices are too many for one scan", header.vertices),
                  "a scan is one turn of the scanner");
  localization::PointCloud cloud;
  std::size_t record = 0;
  for (const PlyProperty& property : header.properties) record += property.type.size;
  const auto cut = [&](std::size_t i) {
    refuse_points(file, fmt::format("the file ends after {} of {} vertices", i, header.vertices),
                  "copy it again");
  };
  if (header.encoding == PlyHeader::Encoding::ascii) {
    std::istringstream body(bytes.substr(header.body));
    for (std::size_t i = 0; i < header.vertices; ++i) {
      PlyVertex vertex;
      for (const PlyProperty& property : header.properties) {
        std::string word;
        if (!(body >> word)) cut(i);
        vertex.set(property, std::strtof(word.c_str(), nullptr));
      }
      vertex.keep_in(cloud, file);
    }
    return cloud;
  }
  if ((bytes.size() - header.body) / record < header.vertices) cut((bytes.size() - header.body) / record);
  const bool swap = header.encoding == PlyHeader::Encoding::big;
  cloud.points.reserve(header.vertices);
  for (std::size_t i = 0; i < header.vertices; ++i) {
    const char* from = bytes.data() + header.body + i * record;
    PlyVertex vertex;
    for (const PlyProperty& property : header.properties) {
      vertex.set(property, static_cast<float>(read_binary_number(from, property.type, swap)));
      from += property.type.size;
    }
    vertex.keep_in(cloud, file);
  }
  return cloud;
}

}  // namespace

bool is_point_file(const std::filesystem::path& file) {
  return file.extension() == ".bin" || file.extension() == ".ply";
}

localization::PointCloud read_point_file(const std::filesystem::path& file) {
  const std::string bytes = read_vsi_text(file.string());
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return read_ply(bytes, file);
  if (file.extension() == ".bin") return read_kitti(bytes, file);
  refuse_points(file, "this is neither a KITTI scan (.bin) nor a PLY file", "convert it to one of them");
}

}  // namespace waymark::importers
