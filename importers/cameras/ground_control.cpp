// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/ground_control.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

constexpr const char* kLine = "each line holds: easting northing height column row image [name]";

// "WGS84 UTM 32N" becomes "EPSG:32632"; other texts stay.
std::string crs_of(const TextRow& row) {
  const auto& words = row.words;
  if (words.size() == 3 && lower_case(words[0]) == "wgs84" && lower_case(words[1]) == "utm" &&
      words[2].size() >= 2) {
    double zone = 0;
    const char side = words[2].back() == 'n' ? 'N' : words[2].back() == 's' ? 'S' : words[2].back();
    if (parse_number(std::string_view(words[2]).substr(0, words[2].size() - 1), zone) && zone >= 1 &&
        zone <= 60 && (side == 'N' || side == 'S'))
      return fmt::format("EPSG:{}", (side == 'N' ? 32600 : 32700) + static_cast<int>(zone));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

// Height, NaN if it says so.
double height_at(const TextRow& row, const std::string& path) {
  const bool unknown = row.words.size() > 2 && (row.words[2] == "NaN" || row.words[2] == "nan");
  return unknown ? std::numeric_limits<double>::quiet_NaN() : number_at(row, 2, path, "height");
}

bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.head<2>() == b.head<2>() && (a.z() == b.z() || (std::isnan(a.z()) && std::isnan(b.z())));
}

GroundControlPoint& point_of(GroundControl& all, const std::string& name, const Eigen::Vector3d& position,
                             const TextRow& row, const std::string& path) {
  const auto found = std::ranges::find_if(all.points, [&](const GroundControlPoint& p) {
    return name.empty() ? same(p.position, position) : p.name == name;
  });
  if (found == all.points.end()) {
    const std::string given = name.empty() ? fmt::format("point {}", all.points.size() + 1) : name;
    all.points.push_back({.name = given, .position = position, .check = is_check_name(given)});
    return all.points.back();
  }
  if (!same(found->position, position))
    refuse_line(path, row.line, fmt::format("the point '{}' has another position on an earlier line", name),
                "give each point its own name");
  return *found;
}

}  // namespace

bool is_check_name(const std::string& name) {
  return lower_case(name).starts_with("check");
}

GroundControl read_ground_control(const std::string& points, const std::string& marks) {
  if (!marks.empty()) return read_control_layer(points, marks);
  const std::string extension = std::filesystem::path(points).extension().string();
  if (extension != ".txt" && extension != ".lst")
    throw Error(ErrorCode::usage, "the marks of the control points are not given", points,
                "pass --marks FILE, a table with the columns point,image,column,row, or a gcp_list.txt");
  return read_gcp_list(points);
}

GroundControl read_gcp_list(const std::string& path) {
  const std::vector<TextRow> rows = text_rows(path);
  if (rows.size() < 2) throw Error(ErrorCode::input, "there are no control points", path, kLine);
  GroundControl all{.crs = crs_of(rows[0])};
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
    if (row->words.size() < 6)
      refuse_line(path, row->line, fmt::format("the line has {} words, not 6 or more", row->words.size()),
                  kLine);
    const Eigen::Vector3d position(number_at(*row, 0, path, "easting"), number_at(*row, 1, path, "northing"),
                                   height_at(*row, path));
    const std::string name = row->words.size() > 6 ? row->words[6] : "", &image = row->words[5];
    GroundControlPoint& point = point_of(all, name, position, *row, path);
    if (std::ranges::count(point.marks, image, &GroundControlMark::image) > 0)
      refuse_line(path, row->line,
                  fmt::format("the point '{}' has two marks in the image '{}'", point.name, image),
                  "remove one, or give each point its own name");
    point.marks.push_back(
        {.image = image, .pixel = {number_at(*row, 3, path, "column"), number_at(*row, 4, path, "row")}});
  }
  return all;
}

}  // namespace waymark::importers
