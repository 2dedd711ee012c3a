// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/point_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <cstring>
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

void keep(const Eigen::Vector3f& p, const std::filesystem::path& file, std::vector<Eigen::Vector3f>& points) {
  if (!p.allFinite()) return;
  if (!(p.cwiseAbs().maxCoeff() < kFarthestPoint))
    refuse_points(
        file, fmt::format("a point is at {:g}, {:g}, {:g}: no metres from a scanner", p.x(), p.y(), p.z()),
        "points are in the scanner's own frame, x forward, y left, z up; KITTI's .bin has four float32 "
        "a point");
  points.push_back(p);
}

std::vector<Eigen::Vector3f> read_kitti(const std::string& bytes, const std::filesystem::path& file) {
  constexpr std::size_t record = 4 * sizeof(float);
  if (bytes.empty() || bytes.size() % record != 0)
    refuse_points(
        file, fmt::format("{} bytes are no whole number of points", bytes.size()),
        "a KITTI scan has four little-endian float32 a point: x, y, z, intensity; copy the file again");
  static_assert(std::endian::native == std::endian::little);
  std::vector<Eigen::Vector3f> points;
  points.reserve(bytes.size() / record);
  for (std::size_t at = 0; at < bytes.size(); at += record) {
    float xyz[3];
    std::memcpy(xyz, bytes.data() + at, sizeof xyz);
    keep({xyz[0], xyz[1], xyz[2]}, file, points);
  }
  return points;
}

struct PlyProperty {
  NumberType type;
  int axis = -1;  // 0 x, 1 y, 2 z
};

struct PlyHeader {
  enum class Encoding { ascii, little, big } encoding = Encoding::ascii;
  std::size_t vertices = 0, body = 0;
  std::vector<PlyProperty> properties;  // of a vertex
};

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
  property.axis = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : -1;
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
  if (axes != 7 || !seen_format) refuse_points(file, "vertices lack x, y or z", "this is no scan");
  return header;
}

std::vector<Eigen::Vector3f> read_ply(const std::string& bytes, const std::filesystem::path& file) {
  const PlyHeader header = read_ply_header(bytes, file);
  if (header.vertices > kMaxPoints)
    refuse_points(file, fmt::format("{} vertices are too many for one scan", header.vertices),
                  "a scan is one turn of the scanner");
  std::vector<Eigen::Vector3f> points;
  std::size_t record = 0;
  for (const PlyProperty& property : header.properties) record += property.type.size;
  const auto cut = [&](std::size_t i) {
    refuse_points(file, fmt::format("the file ends after {} of {} vertices", i, header.vertices),
                  "copy it again");
  };
  if (header.encoding == PlyHeader::Encoding::ascii) {
    std::istringstream body(bytes.substr(header.body));
    for (std::size_t i = 0; i < header.vertices; ++i) {
      Eigen::Vector3f p = Eigen::Vector3f::Zero();
      for (const PlyProperty& property : header.properties) {
        std::string word;
        if (!(body >> word)) cut(i);
        if (property.axis >= 0) p(property.axis) = std::strtof(word.c_str(), nullptr);
      }
      keep(p, file, points);
    }
    return points;
  }
  if ((bytes.size() - header.body) / record < header.vertices) cut((bytes.size() - header.body) / record);
  const bool swap = header.encoding == PlyHeader::Encoding::big;
  points.reserve(header.vertices);
  for (std::size_t i = 0; i < header.vertices; ++i) {
    const char* from = bytes.data() + header.body + i * record;
    Eigen::Vector3f p = Eigen::Vector3f::Zero();
    for (const PlyProperty& property : header.properties) {
      if (property.axis >= 0)
        p(property.axis) = static_cast<float>(read_binary_number(from, property.type, swap));
      from += property.type.size;
    }
    keep(p, file, points);
  }
  return points;
}

}  // namespace

bool is_point_file(const std::filesystem::path& file) {
  return file.extension() == ".bin" || file.extension() == ".ply";
}

std::vector<Eigen::Vector3f> read_point_file(const std::filesystem::path& file) {
  const std::string bytes = read_vsi_text(file.string());
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return read_ply(bytes, file);
  if (file.extension() == ".bin") return read_kitti(bytes, file);
  refuse_points(file, "this is neither a KITTI scan (.bin) nor a PLY file", "convert it to one of them");
}

}  // namespace waymark::importers
