// SPDX-License-Identifier: Apache-2.0
#include "published_adjustments.hpp"

#include <cmath>
#include <sstream>

#include "core/text_file.hpp"

namespace waymark::test {

std::filesystem::path reconstruction_data() {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/reconstruction";
}

std::vector<std::vector<double>> number_rows(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  std::istringstream in(read_text(path, "published adjustment"));
  for (std::string line; std::getline(in, line);) {
    for (char& c : line)
      if (c == ',' || c == '\t') c = ' ';
    std::istringstream words(line);
    std::vector<double> row;
    for (std::string word; words >> word;) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      row.push_back(*end == '\0' || std::string(end) == "jpg" ? value : std::nan(""));  // 8811.jpg is 8811
    }
    if (!row.empty() && !std::isnan(row[0])) rows.push_back(row);
  }
  return rows;
}

namespace {

Printed printed(const std::string& word) {
  const auto exponent = word.find_first_of("eE");
  const std::string mantissa = word.substr(0, exponent);
  const auto point = mantissa.find('.');
  const auto digits = point == std::string::npos ? 0.0 : static_cast<double>(mantissa.size() - point - 1);
  const double power = exponent == std::string::npos ? 0 : std::stod(word.substr(exponent + 1));
  return {std::stod(word), 0.5 * std::pow(10, power - digits)};
}

Eigen::Matrix3d flip() {
  return Eigen::Vector3d(1, -1, -1).asDiagonal();
}

}  // namespace

std::map<int, std::map<std::string, Printed>> read_report(const std::filesystem::path& path) {
  std::map<int, std::map<std::string, Printed>> out;
  std::istringstream in(read_text(path, "published adjustment"));
  int photo = 0;
  std::string name;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "Quality") break;
    if (first == "Photo")
      photo = std::stoi(second);
    else if (first == "Value:")
      out[photo][name] = printed(second);
    else if (first == "Deviation:")
      out[photo][name + " sd"] = printed(second);
    else if (!first.empty())
      name = first.back() == ':' ? first.substr(0, first.size() - 1) : first;
  }
  return out;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& opk) {
  return Eigen::AngleAxisd(opk[0], Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(opk[1], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(opk[2], Eigen::Vector3d::UnitZ()) * flip();
}

Eigen::Vector3d opk_of(const Eigen::Matrix3d& world_from_camera) {
  const Eigen::Matrix3d r = world_from_camera * flip();
  return {std::atan2(-r(1, 2), r(2, 2)), std::asin(r(0, 2)), std::atan2(-r(0, 1), r(0, 0))};
}

Eigen::Matrix3d opk_by_turn(const Eigen::Matrix3d& world_from_camera) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix3d out;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::AngleAxisd step(kStep, Eigen::Vector3d::Unit(axis));
    out.col(axis) =
        (opk_of(world_from_camera * step) - opk_of(world_from_camera * step.inverse())) / (2 * kStep);
  }
  return out;
}

}  // namespace waymark::test
