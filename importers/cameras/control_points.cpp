// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/control_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/error.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

constexpr const char* kColumns = "columns are frame_x, frame_y, frame_z, x, y, z or image, x, y, z";

using Columns = std::map<std::string, std::size_t>;

Eigen::Vector3d vector_at(const TextRow& row, const Columns& columns, const std::string& prefix,
                          const std::string& path) {
  Eigen::Vector3d value;
  for (int i = 0; i < 3; ++i) {
    const std::string name = prefix + std::string(1, static_cast<char>('x' + i));
    value[i] = number_at(row, columns.at(name), path, name.c_str());
  }
  return value;
}

Eigen::Vector3d centre_of(const TextRow& row, std::size_t column, const CameraFile& cameras,
                          const std::string& path) {
  const std::string name = column < row.words.size() ? row.words[column] : "";
  for (const CameraRecord& record : cameras.images) {
    const std::filesystem::path image(record.image);
    if ((record.image == name || image.stem() == name ||
         image.stem() == std::filesystem::path(name).stem()) &&
        record.world_from_camera)
      return record.world_from_camera->translation();
  }
  refuse_line(path, row.line, fmt::format("the camera file has no pose for the image '{}'", name),
              "name images as the camera file does");
}

Columns columns_of(const TextRow& header, const std::string& path) {
  Columns columns;
  for (std::size_t i = 0; i < header.words.size(); ++i) columns[header.words[i]] = i;
  const auto has = [&](std::initializer_list<const char*> names) {
    return std::ranges::all_of(names, [&](const char* name) { return columns.contains(name); });
  };
  if (!has({"x", "y", "z"}) || !(columns.contains("image") || has({"frame_x", "frame_y", "frame_z"})))
    refuse_line(path, header.line, "the header does not name the columns of control points", kColumns);
  return columns;
}

}  // namespace

Georeferencing read_control_points(const std::string& path, const CameraFile& cameras) {
  const std::vector<TextRow> rows = text_rows(path);
  if (rows.empty()) throw Error(ErrorCode::input, "there are no control points", path, kColumns);
  const Columns columns = columns_of(rows[0], path);
  std::vector<Eigen::Vector3d> frame, map;
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
    frame.push_back(columns.contains("image") ? centre_of(*row, columns.at("image"), cameras, path)
                                              : vector_at(*row, columns, "frame_", path));
    map.push_back(vector_at(*row, columns, "", path));
  }
  try {
    const Similarity found = estimate_similarity(frame, map);
    double largest = 0;
    for (std::size_t i = 0; i < frame.size(); ++i)
      largest = std::max(largest, (found * frame[i] - map[i]).norm());
    return {found, fmt::format("{} control points: scale {:.6g}, residual {:.3g} m rms, {:.3g} m at most",
                               frame.size(), found.scale, residual(found, frame, map), largest)};
  } catch (const Error& e) {
    throw Error(e.code(), e.problem(), path, e.hint());
  }
}

Similarity similarity_from_text(const std::string& text) {
  std::vector<double> v;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    std::string_view word = std::string_view(text).substr(begin, end - begin);
    while (word.starts_with(' ')) word.remove_prefix(1);
    while (word.ends_with(' ')) word.remove_suffix(1);
    if (!parse_number(word, v.emplace_back())) v.clear(), begin = text.size();
    begin = std::max(begin, end) + 1;
  }
  const Eigen::Quaterniond turn =
      v.size() == 8 ? Eigen::Quaterniond(v[1], v[2], v[3], v[4]) : Eigen::Quaterniond(0, 0, 0, 0);
  if (v.size() != 8 || !(v[0] > 0) || !(turn.norm() > 0))
    throw Error(ErrorCode::usage, "a similarity is 8 numbers: scale,qw,qx,qy,qz,x,y,z", text,
                "map = scale * rotation * frame + shift");
  return {.scale = v[0], .rotation = turn.normalized().toRotationMatrix(), .shift = {v[5], v[6], v[7]}};
}

}  // namespace waymark::importers
