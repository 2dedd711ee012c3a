// SPDX-License-Identifier: Apache-2.0
// Exterior orientations as photogrammetry writes them: image, x, y, z, omega, phi, kappa, one line each;
// Pix4D, PATB, Metashape and national mapping agencies. Degrees.
//  - R = Rx(omega) Ry(phi) Rz(kappa) rotates camera axes into the grid's, with the camera's y up in the
//    image and z pointing back from the ground: our axes are its diag(1, -1, -1).
//  - x, y, z are in a projected CRS: that of a .prj beside the file, else camera_crs, else the map's.
//  - The interior orientation is in a separate file, named by `interior`.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "importers/cameras/camera_file.hpp"
#include "importers/cameras/interior_orientation.hpp"
#include "importers/json_value.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

struct Columns {
  std::size_t image = 0, x = 1, y = 2, z = 3, omega = 4, phi = 5, kappa = 6;
  std::optional<std::size_t> camera = {};
};

bool is_header(const TextRow& row) {
  double ignored = 0;
  return row.words.size() >= 7 && std::ranges::none_of(row.words, [&](const std::string& word) {
           return parse_number(word, ignored);
         });
}

Columns columns_of(const TextRow& header, const std::string& path) {
  std::map<std::string, std::size_t> at;
  for (std::size_t i = 0; i < header.words.size(); ++i) at[lower_case(header.words[i])] = i;
  const auto column = [&](std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (const auto found = at.find(name); found != at.end()) return found->second;
    refuse_line(path, header.line, fmt::format("the header names no column '{}'", *names.begin()),
                "columns: filename, x, y, z, omega, phi, kappa and, where there are several, camera");
  };
  Columns columns{.image = column({"filename", "image", "imagename", "label", "name"}),
                  .x = column({"x", "easting", "x/easting"}),
                  .y = column({"y", "northing", "y/northing"}),
                  .z = column({"z", "altitude", "height", "z/altitude"}),
                  .omega = column({"omega"}),
                  .phi = column({"phi"}),
                  .kappa = column({"kappa"})};
  if (at.contains("camera")) columns.camera = at.at("camera");
  return columns;
}

Eigen::Isometry3d world_from_camera(const TextRow& row, const Columns& columns, const std::string& path) {
  const auto angle = [&](std::size_t column, const char* name) {
    return number_at(row, column, path, name) * kRadiansPerDegree;
  };
  using Turn = Eigen::AngleAxisd;
  using Vector = Eigen::Vector3d;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Turn(angle(columns.omega, "omega"), Vector::UnitX()) *
                   Turn(angle(columns.phi, "phi"), Vector::UnitY()) *
                   Turn(angle(columns.kappa, "kappa"), Vector::UnitZ()))
                      .toRotationMatrix() *
                  Vector(1, -1, -1).asDiagonal();
  pose.translation() = Vector(number_at(row, columns.x, path, "x"), number_at(row, columns.y, path, "y"),
                              number_at(row, columns.z, path, "z"));
  return pose;
}

std::string crs_beside(const std::string& path) {
  const std::string prj = std::filesystem::path(path).replace_extension(".prj").string();
  std::error_code ignored;
  return std::filesystem::exists(prj, ignored) ? read_vsi_text(prj) : "";
}

CameraFile read_opk(const CameraSource& source) {
  if (source.interior.empty())
    throw Error(ErrorCode::input, "the file has camera poses, but no interior orientation", source.path,
                "name a file with the interior orientation in the option interior; "
                "docs/reference/camera_formats.md shows which");
  const auto lenses = read_interior(source.interior);
  const std::vector<TextRow> rows = text_rows(source.path);
  CameraFile file;
  file.world.axes = CameraWorld::Axes::grid;
  file.world.crs = crs_beside(source.path);
  Columns columns;
  for (const TextRow& row : rows) {
    if (&row == &rows[0] && is_header(row)) {
      columns = columns_of(row, source.path);
      continue;
    }
    CameraRecord record;
    record.image = row.words[std::min(columns.image, row.words.size() - 1)];
    record.location = fmt::format("line {}", row.line);
    record.world_from_camera = world_from_camera(row, columns, source.path);
    const std::string lens =
        columns.camera && *columns.camera < row.words.size() ? row.words[*columns.camera] : "";
    record.camera = interior_named(lenses, lens, source.interior);
    file.images.push_back(std::move(record));
  }
  return file;
}

// Recognises a header with the three angles, or a line of a name and six numbers.
bool recognises(const CameraSource& source) {
  if (source.head.find('{') != source.head.npos || source.head.find('<') != source.head.npos) return false;
  const std::string head = lower_case(source.head.substr(0, source.head.find('\n')));
  if (head.find("omega") != head.npos && head.find("kappa") != head.npos) return true;
  std::vector<std::string> words;
  for (std::size_t begin = head.find_first_not_of(" \t,;\r"); begin < head.size();) {
    const std::size_t end = std::min(head.find_first_of(" \t,;\r", begin), head.size());
    words.push_back(head.substr(begin, end - begin));
    begin = head.find_first_not_of(" \t,;\r", end);
  }
  double ignored = 0;
  return words.size() >= 7 && !parse_number(words[0], ignored) &&
         std::all_of(words.begin() + 1, words.begin() + 7,
                     [&](const std::string& word) { return parse_number(word, ignored); });
}

}  // namespace

void register_camera_format_opk(CameraFormats& formats);
void register_camera_format_opk(CameraFormats& formats) {
  formats.add({.name = "opk",
               .summary = "image, x, y, z, omega, phi, kappa (Pix4D, PATB, Metashape); needs interior",
               .recognises = recognises,
               .read = read_opk});
}

}  // namespace waymark::importers
