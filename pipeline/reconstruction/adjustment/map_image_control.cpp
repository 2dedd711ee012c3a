// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/map_image_control.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "core/solve.hpp"
#include "pipeline/reconstruction/surface/parabola_vertex.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinPixels = 0.12, kMaxPixels = 1.6;  // size of pixels on the ground, in cells of the map
constexpr double kMinSine = 0.6;                       // of the elevation of the camera above the ground
constexpr double kSecondPeak = 0.06;            // by which the second maximum of a correlation must be lower
constexpr double kMarkSd = 0.35, kMapSd = 0.5;  // cells of the map
constexpr std::size_t kMinShifts = 12;

/// Shift of an image against the map at a point, in cells; x to the east, y to the north.
struct Shift {
  std::size_t point = 0, view = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero(), cells = Eigen::Vector2d::Zero();
};

std::optional<cv::Mat> map_pattern(const LevelImage& map, std::int64_t column, std::int64_t row, int half) {
  const int side = 2 * half + 1;
  cv::Mat out(side, side, CV_32F);
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const std::int64_t i = column + c - half, j = row + r - half;
      if (!map.brightness.contains(i, j) || std::isnan(map.brightness(i, j))) return std::nullopt;
      out.at<float>(r, c) = map.brightness(i, j);
    }
  return out;
}

// An image about a point of the ground, at the cells of the map.
std::optional<cv::Mat> rectified(const SurfaceView& view, const ImageLevel& image, double scale,
                                 const SurfaceGrid& grid, const CoarseHeights& ground, std::int64_t column,
                                 std::int64_t row, int half) {
  const int side = 2 * half + 1;
  cv::Mat out(side, side, CV_32F);
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) {
      const double x = grid.x(double(column + c - half)), y = grid.y(double(row + r - half));
      const double z = ground.at(x, y);
      if (!std::isfinite(z)) return std::nullopt;
      const auto pixel = project(view.view, {Eigen::Vector3d(x, y, z)});
      if (!pixel) return std::nullopt;
      const float value = bilinear(image.pixels, static_cast<float>((pixel->x() + 0.5) / scale - 0.5),
                                   static_cast<float>((pixel->y() + 0.5) / scale - 0.5));
      if (std::isnan(value)) return std::nullopt;
      out.at<float>(r, c) = value;
    }
  return out;
}

// Distinct maximum of a correlation about its middle, in cells.
std::optional<Eigen::Vector2d> distinct_peak(const cv::Mat& scores, double min_score) {
  double best = 0, second = 0;
  cv::Point at;
  cv::minMaxLoc(scores, nullptr, &best, nullptr, &at);
  if (!(best >= min_score) || at.x == 0 || at.y == 0 || at.x == scores.cols - 1 || at.y == scores.rows - 1)
    return std::nullopt;
  cv::Mat others = scores.clone();
  cv::circle(others, at, 4, -1, cv::FILLED);
  cv::minMaxLoc(others, nullptr, &second);
  if (!(second <= best - kSecondPeak)) return std::nullopt;
  const auto value = [&](int c, int r) { return scores.at<float>(at.y + r, at.x + c); };
  return Eigen::Vector2d(at.x - scores.cols / 2 + parabola_vertex(value(-1, 0), value(0, 0), value(1, 0)),
                         -(at.y - scores.rows / 2 + parabola_vertex(value(0, -1), value(0, 0), value(0, 1))));
}

/// Searches the patterns of a map in images.
class Matcher {
 public:
  Matcher(const LevelImage& map, const CoarseHeights& ground, const std::vector<SurfaceView>& views,
          ImageLevels& images, const MapImageMatching& matching)
      : map_(map), ground_(ground), views_(views), images_(images), matching_(matching) {}

  std::vector<std::size_t> views_of(const Eigen::Vector3d& point) const {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      const double size = ground_sample_distance(views_[v].view, point) / map_.grid.cell;
      const Eigen::Vector3d towards = (views_[v].view.centre().xyz - point).normalized();
      if (size > kMinPixels && size < kMaxPixels && towards.z() > kMinSine)
        found.emplace_back(std::abs(std::log(size)), v);
    }
    std::ranges::sort(found);
    std::vector<std::size_t> out;
    for (const auto& [distance, v] : found)
      if (out.size() < matching_.max_views) out.push_back(v);
    return out;
  }

  std::optional<Eigen::Vector2d> shift(std::size_t v, const Eigen::Vector3d& point, std::int64_t column,
                                       std::int64_t row) {
    const auto pattern = map_pattern(map_, column, row, matching_.half);
    if (!pattern) return std::nullopt;
    const double size = ground_sample_distance(views_[v].view, point);
    const int level = level_for(size, map_.grid.cell);
    const auto here = rectified(views_[v], *images_.get(v, level), double(1 << level), map_.grid, ground_,
                                column, row, matching_.half + matching_.reach);
    if (!here) return std::nullopt;
    cv::Mat scores;
    cv::matchTemplate(*here, *pattern, scores, cv::TM_CCOEFF_NORMED);
    return distinct_peak(scores, matching_.min_score);
  }

 private:
  const LevelImage& map_;
  const CoarseHeights& ground_;
  const std::vector<SurfaceView>& views_;
  ImageLevels& images_;
  const MapImageMatching& matching_;
};

using Trend = Eigen::Matrix<double, 2, 3>;

Trend fitted_trend(const std::vector<Shift>& shifts, const std::vector<std::size_t>& chosen) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(chosen.size()), 3);
  Eigen::VectorXd x(a.rows()), y(a.rows());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Shift& s = shifts[chosen[static_cast<std::size_t>(i)]];
    a.row(i) << s.at.x(), s.at.y(), 1;
    x[i] = s.cells.x(), y[i] = s.cells.y();
  }
  Trend out;
  out.row(0) = solve_least_squares(a, x).transpose();
  out.row(1) = solve_least_squares(a, y).transpose();
  return out;
}

std::vector<std::size_t> following(const std::vector<Shift>& shifts, const Trend& trend, double within) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < shifts.size(); ++i)
    if ((shifts[i].cells - trend * shifts[i].at.homogeneous()).norm() <= within) out.push_back(i);
  return out;
}

// Shifts that follow one affine trend: the largest set about a shift that is tried as constant, then refined.
std::vector<std::size_t> following_one_trend(const std::vector<Shift>& shifts, double within) {
  std::vector<std::size_t> best;
  for (const Shift& one : shifts) {
    Trend constant = Trend::Zero();
    constant.col(2) = one.cells;
    if (auto near = following(shifts, constant, 2 * within); near.size() > best.size())
      best = std::move(near);
  }
  for (int round = 0; round < 4 && best.size() >= 6; ++round)
    best = following(shifts, fitted_trend(shifts, best), within);
  return best;
}

}  // namespace

MapImageControl control_of_map_image(const LevelImage& map, const CoarseHeights& ground,
                                     const std::vector<SurfaceView>& views,
                                     const std::vector<std::size_t>& image_of_view, ImageLevels& images,
                                     const MapImageMatching& matching) {
  Matcher matcher(map, ground, views, images, matching);
  const double width = double(ground.grid.columns) * ground.grid.cell,
               height = double(ground.grid.rows) * ground.grid.cell;
  const double step = std::max(width, height) / matching.across;
  const Eigen::Vector2d middle(ground.grid.west + width / 2, ground.grid.north - height / 2);
  struct Node {
    std::int64_t column = 0, row = 0;
  };
  std::vector<Node> nodes;
  for (double y = ground.grid.north - step / 2; y > ground.grid.north - height; y -= step)
    for (double x = ground.grid.west + step / 2; x < ground.grid.west + width; x += step)
      if (const Node n{std::llround(map.grid.column(x)), std::llround(map.grid.row(y))};
          map.brightness.contains(n.column, n.row))
        nodes.push_back(n);
  std::vector<std::vector<Shift>> by_node(nodes.size());
  std::vector<std::size_t> tried(nodes.size(), 0);
  const auto ground_point = [&](double x, double y) { return Eigen::Vector3d(x, y, ground.at(x, y)); };
  tbb::parallel_for(std::size_t{0}, nodes.size(), [&](std::size_t i) {
    const Eigen::Vector3d point =
        ground_point(map.grid.x(double(nodes[i].column)), map.grid.y(double(nodes[i].row)));
    if (!point.allFinite()) return;
    for (const std::size_t v : matcher.views_of(point)) {
      ++tried[i];
      if (const auto cells = matcher.shift(v, point, nodes[i].column, nodes[i].row))
        by_node[i].push_back({.point = i,
                              .view = v,
                              .at = (point.head<2>() - middle) / std::max(width, height),
                              .cells = *cells});
    }
  });
  MapImageControl out;
  std::vector<Shift> shifts;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    out.tried += tried[i];
    shifts.insert(shifts.end(), by_node[i].begin(), by_node[i].end());
  }
  out.matched = shifts.size();
  const std::vector<std::size_t> kept = following_one_trend(shifts, matching.agreement);
  out.agreeing = kept.size();
  if (kept.size() < kMinShifts || 2 * kept.size() < shifts.size()) return out;
  std::optional<std::size_t> last;
  for (const std::size_t i : kept) {
    const Shift& s = shifts[i];
    const double x = map.grid.x(double(nodes[s.point].column)), y = map.grid.y(double(nodes[s.point].row));
    const Eigen::Vector3d shown =
        ground_point(x + s.cells.x() * map.grid.cell, y + s.cells.y() * map.grid.cell);
    const auto pixel = shown.allFinite() ? project(views[s.view].view, {shown}) : std::nullopt;
    if (!pixel) continue;
    if (last != s.point) {
      const double sd = kMapSd * map.grid.cell;
      out.points.push_back({.name = fmt::format("map {} {}", nodes[s.point].column, nodes[s.point].row),
                            .position = ground_point(x, y),
                            .sd = Eigen::Vector3d(sd, sd, 0)});
      last = s.point;
    }
    const double size = ground_sample_distance(views[s.view].view, shown);
    out.points.back().marks.push_back({.image = image_of_view[s.view],
                                       .pixel = *pixel,
                                       .sd = std::max(0.3, kMarkSd * map.grid.cell / size)});
  }
  return out;
}

}  // namespace waymark::pipeline
