// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/match_planes.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace waymark::pipeline {
namespace {

constexpr float kNoMatch = std::numeric_limits<float>::quiet_NaN();
constexpr int kRounds = 3;             // of the weights of the views
constexpr float kMinVariance = 0.02f;  // of a normalized view; bounds its weight

// Brightness of a view on the surface, and its change with height.
struct SurfaceImage {
  Eigen::ArrayXXf value, slope;  // (column, row)
  float min_variance = 0;
};

SurfaceImage draw(const SurfaceView& view, const ImageLevel& image, double scale, const NodeSurface& surface,
                  const Window& wide, double step, double min_texture) {
  SurfaceImage out{Eigen::ArrayXXf(wide.columns, wide.rows), Eigen::ArrayXXf(wide.columns, wide.rows),
                   static_cast<float>(std::pow(min_texture * image.noise, 2))};
  const auto sample = [&](double x, double y, double h) {
    const auto p = project(view.view, {Eigen::Vector3d(x, y, h)});
    if (!p) return kNoMatch;
    return bilinear(image.pixels, static_cast<float>((p->x() + 0.5) / scale - 0.5),
                    static_cast<float>((p->y() + 0.5) / scale - 0.5));
  };
  for (std::int64_t r = 0; r < wide.rows; ++r)
    for (std::int64_t c = 0; c < wide.columns; ++c) {
      const double x = surface.grid.x(static_cast<double>(wide.column + c)),
                   y = surface.grid.y(static_cast<double>(wide.row + r));
      const auto h = static_cast<double>(surface.at(wide.column + c, wide.row + r));
      out.value(c, r) = out.slope(c, r) = 0;  // nodes without surface have no weight
      if (std::isnan(h)) continue;
      out.value(c, r) = sample(x, y, h);
      out.slope(c, r) = (sample(x, y, h + step) - sample(x, y, h - step)) / static_cast<float>(2 * step);
    }
  return out;
}

// Window of a view: normalized brightness, and its derivatives by height and slopes.
struct ViewWindow {
  std::vector<float> value;
  std::vector<Eigen::Vector3f> derivative;
  float weight = 1;
};

class WindowMatching {
 public:
  WindowMatching(const PlaneRules& rules, double node) : rules_(rules), side_(2 * rules.reach) {
    for (int j = 0; j < side_; ++j)
      for (int i = 0; i < side_; ++i) {
        const double x = i - rules.reach + 0.5, y = j - rules.reach + 0.5;
        taper_.push_back(static_cast<float>(std::exp(-0.5 * (x * x + y * y) / (rules.width * rules.width))));
        row_.emplace_back(1.0f, static_cast<float>(x * node), static_cast<float>(y * node));
      }
    full_ = 0;
    for (const float w : taper_) full_ += w;
    slope_weight_ = static_cast<float>(1 / (rules.slope_sd * rules.slope_sd));
  }

  // `column` and `row` are those of the first node of the window.
  PlaneMatch match(const std::vector<SurfaceImage>& images, const std::vector<std::uint8_t>& known,
                   Eigen::Index column, Eigen::Index row, Eigen::Index stride) {
    weight_ = taper_;
    total_ = 0;
    for (int j = 0; j < side_; ++j)
      for (int i = 0; i < side_; ++i) {
        float& w = weight_[static_cast<std::size_t>(j * side_ + i)];
        if (!known[static_cast<std::size_t>((row + j) * stride + column + i)]) w = 0;
        total_ += w;
      }
    if (!(total_ > 0.5f * full_)) return {kNoMatch, kNoMatch};
    std::size_t count = 0;
    windows_.resize(images.size());
    for (const SurfaceImage& image : images)
      if (cut(image, column, row, windows_[count])) ++count;
    if (count < 2) return {kNoMatch, kNoMatch};
    windows_.resize(count);
    return solve();
  }

 private:
  bool cut(const SurfaceImage& image, Eigen::Index column, Eigen::Index row, ViewWindow& out) const {
    const std::size_t nodes = weight_.size();
    out.value.resize(nodes);
    out.derivative.resize(nodes);
    out.weight = 1;
    float mean = 0;
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (int j = 0; j < side_; ++j)
      for (int i = 0; i < side_; ++i) {
        const auto n = static_cast<std::size_t>(j * side_ + i);
        out.value[n] = image.value(column + i, row + j);
        out.derivative[n] = image.slope(column + i, row + j) * row_[n];
        mean += weight_[n] * out.value[n];
        middle += weight_[n] * out.derivative[n];
      }
    mean /= total_;
    middle /= total_;
    float variance = 0;
    for (std::size_t n = 0; n < nodes; ++n) {
      out.value[n] -= mean;
      out.derivative[n] -= middle;
      variance += weight_[n] * out.value[n] * out.value[n];
    }
    variance /= total_;
    if (!(variance > image.min_variance) || !(variance > 0) || !middle.allFinite()) return false;
    const float scale = 1 / std::sqrt(variance);
    Eigen::Vector3f along = Eigen::Vector3f::Zero();
    for (std::size_t n = 0; n < nodes; ++n) {
      out.value[n] *= scale;
      out.derivative[n] *= scale;
      along += weight_[n] * out.value[n] * out.derivative[n];
    }
    along /= total_;
    for (std::size_t n = 0; n < nodes; ++n) out.derivative[n] -= out.value[n] * along;  // the gain is free
    return true;
  }

  PlaneMatch solve() {
    const std::size_t nodes = weight_.size();
    Eigen::Vector3f plane = Eigen::Vector3f::Zero();
    float variance = 0;
    for (int round = 0; round < kRounds; ++round) {
      mean_.assign(nodes, 0);
      middle_.assign(nodes, Eigen::Vector3f::Zero());
      float all = 0;
      for (const ViewWindow& view : windows_) {
        all += view.weight;
        for (std::size_t n = 0; n < nodes; ++n) {
          mean_[n] += view.weight * view.value[n];
          middle_[n] += view.weight * view.derivative[n];
        }
      }
      for (std::size_t n = 0; n < nodes; ++n) {
        mean_[n] /= all;
        middle_[n] /= all;
      }
      Eigen::Matrix3f normal = Eigen::Matrix3f::Zero();
      Eigen::Vector3f right = Eigen::Vector3f::Zero();
      for (const ViewWindow& view : windows_)
        for (std::size_t n = 0; n < nodes; ++n) {
          const Eigen::Vector3f d = view.derivative[n] - middle_[n];
          const float w = view.weight * weight_[n];
          normal += w * d * d.transpose();
          right -= w * (view.value[n] - mean_[n]) * d;
        }
      // In the first round all weights are 1, a tenth of what they become.
      normal(1, 1) += (round == 0 ? 0.1f : 1.0f) * slope_weight_;
      normal(2, 2) += (round == 0 ? 0.1f : 1.0f) * slope_weight_;
      const Eigen::Matrix3f covariance = normal.inverse();
      plane = covariance * right;
      variance = covariance(0, 0);
      if (round + 1 < kRounds) weigh_views(plane, all);
    }
    if (!(variance > 0) || !std::isfinite(plane.x())) return {kNoMatch, kNoMatch};
    return {plane.x(), std::sqrt(variance)};
  }

  // Weights are 1 / variance of the residuals, less the part of the view in the mean.
  void weigh_views(const Eigen::Vector3f& plane, float all) {
    for (ViewWindow& view : windows_) {
      float sum = 0;
      for (std::size_t n = 0; n < weight_.size(); ++n) {
        const float e = view.value[n] - mean_[n] + (view.derivative[n] - middle_[n]).dot(plane);
        sum += weight_[n] * e * e;
      }
      view.weight = 1 / (sum / (total_ * (1 - view.weight / all)) + kMinVariance);
    }
  }

  const PlaneRules& rules_;
  int side_;
  std::vector<float> taper_, weight_, mean_;
  std::vector<Eigen::Vector3f> row_, middle_;
  float full_ = 0, total_ = 0, slope_weight_ = 0;
  std::vector<ViewWindow> windows_;
};

}  // namespace

std::vector<PlaneMatch> match_planes(const ComparedViews& views, const NodeSurface& surface,
                                     const Window& nodes, const PlaneRules& rules) {
  const std::int64_t margin = rules.reach - 1;
  const Window wide{nodes.column - margin, nodes.row - margin, nodes.columns + 2 * margin,
                    nodes.rows + 2 * margin};
  std::vector<std::uint8_t> known;
  double middle = 0, count = 0;
  for (std::int64_t r = wide.row; r < wide.end_row(); ++r)
    for (std::int64_t c = wide.column; c < wide.end_column(); ++c) {
      const auto h = static_cast<double>(surface.at(c, r));
      known.push_back(!std::isnan(h));
      if (known.back() && nodes.contains(c, r)) middle += h, ++count;
    }
  const auto cells = static_cast<std::size_t>(nodes.columns / 2 * (nodes.rows / 2));
  if (count == 0 || views.used.size() < 2 || !(views.angle > 0))
    return std::vector<PlaneMatch>(cells, {kNoMatch, kNoMatch});
  const Eigen::Vector3d spot(
      surface.grid.x(static_cast<double>(nodes.column) + static_cast<double>(nodes.columns) / 2),
      surface.grid.y(static_cast<double>(nodes.row) + static_cast<double>(nodes.rows) / 2), middle / count);
  const double pixel =
      surface.grid.cell / std::tan(views.angle);  // metres of height for a parallax of a node
  std::vector<SurfaceImage> images;
  for (const std::size_t v : views.used) {
    const int level = level_for(ground_sample_distance(views.all[v].view, spot), surface.grid.cell);
    images.push_back(draw(views.all[v], *views.images.get(v, level), static_cast<double>(1 << level), surface,
                          wide, 0.5 * pixel, rules.min_texture));
  }
  std::vector<PlaneMatch> found;
  found.reserve(cells);
  WindowMatching matching(rules, surface.grid.cell);
  for (std::int64_t r = 0; r + 1 < nodes.rows; r += 2)
    for (std::int64_t c = 0; c + 1 < nodes.columns; c += 2) {
      PlaneMatch match = matching.match(images, known, c, r, wide.columns);
      if (!(std::abs(static_cast<double>(match.shift)) <= rules.max_pixels * pixel))
        match = {kNoMatch, kNoMatch};
      found.push_back(match);
    }
  return found;
}

}  // namespace waymark::pipeline
