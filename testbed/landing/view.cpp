// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "testbed/render.hpp"

namespace waymark::testbed {
namespace {

constexpr int kSteps = 48;

// Ellipse with the area, centre and second moments of a closed polygon: exact for any affine image of an
// ellipse.
PixelEllipse ellipse_of(const std::vector<Eigen::Vector2d>& line) {
  const Eigen::Vector2d about = line.front();
  double area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d a = line[i] - about, b = line[(i + 1) % line.size()] - about;
    const double cross = a.x() * b.y() - b.x() * a.y();
    area += cross / 2;
    first += cross * (a + b) / 6;
    second += cross / 24 * ((a + b) * (a + b).transpose() + a * a.transpose() + b * b.transpose());
  }
  const Eigen::Vector2d middle = first / area;
  const Eigen::Matrix2d spread = second / area - middle * middle.transpose();
  const double mean = spread.trace() / 2, half = std::hypot((spread(0, 0) - spread(1, 1)) / 2, spread(0, 1));
  // The inscribed polygon has sin(a)/a of the area of the ellipse.
  const double grow = std::sqrt((2 * std::numbers::pi / kSteps) / std::sin(2 * std::numbers::pi / kSteps));
  return {.x = about.x() + middle.x(),
          .y = about.y() + middle.y(),
          .major = 4 * std::sqrt(mean + half) * grow,
          .minor = 4 * std::sqrt(std::max(0.0, mean - half)) * grow,
          .angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1))};
}

std::optional<Eigen::Vector2d> pixel_of(const View& view, const Eigen::Vector3d& point) {
  if (view.camera) return project(*view.camera, Point<GridFrame>{point});
  return Eigen::Vector2d((point.x() - view.x0) / view.gsd, (view.y0 - point.y()) / view.gsd);
}

std::optional<PixelEllipse> outline(const View& view, const Eigen::Vector3d& middle, double major,
                                    double minor, double from_north) {
  std::vector<Eigen::Vector2d> line;
  const double s = std::sin(from_north), c = std::cos(from_north);
  for (int k = 0; k < kSteps; ++k) {
    const double a = 2 * std::numbers::pi * k / kSteps, u = major / 2 * std::cos(a),
                 v = minor / 2 * std::sin(a);
    const auto pixel = pixel_of(view, middle + Eigen::Vector3d(s * u + c * v, c * u - s * v, 0));
    if (!pixel || !(pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() <= double(view.columns - 1) &&
                    pixel->y() <= double(view.rows - 1)))
      return std::nullopt;
    line.push_back(*pixel);
  }
  return ellipse_of(line);
}

}  // namespace

View map_view(const Scene& scene, double gsd, std::int64_t columns, std::int64_t rows) {
  return {.camera = {},
          .columns = columns,
          .rows = rows,
          .x0 = scene.ground.east - double(columns - 1) * gsd / 2,
          .y0 = scene.ground.north + double(rows - 1) * gsd / 2,
          .gsd = gsd};
}

View camera_view(PosedCamera camera, const CameraMotion& motion) {
  View view;
  view.motion = motion;
  view.columns = camera.camera.columns;
  view.rows = camera.camera.rows;
  view.camera = std::move(camera);
  return view;
}

std::optional<PixelEllipse> image_outline(const View& view, const TrueCrater& crater) {
  return outline(view, crater.position, crater.major, crater.minor, crater.orientation);
}

std::optional<PixelEllipse> image_outline(const View& view, const TrueRock& rock) {
  return outline(view, rock.position, rock.width, rock.width, 0);
}

double image_sun_angle(const View& view, const Sun& sun) {
  const Eigen::Vector3d light = sun_direction(sun).unit;
  if (!view.camera) return std::atan2(-light.y(), light.x());
  // Projects the horizontal direction of the sun where the optical axis meets level ground.
  const Eigen::Isometry3d& pose = view.camera->grid_from_camera.transform;
  const Eigen::Vector3d axis = pose.linear().col(2);
  const double range = axis.z() < -0.05 ? 100 / -axis.z() : 1000;
  const Eigen::Vector3d spot = pose.translation() + range * axis;
  const Eigen::Vector3d step = Eigen::Vector3d(light.x(), light.y(), 0).normalized();
  const auto from = pixel_of(view, spot), to = pixel_of(view, spot + step);
  if (!from || !to) return 0;
  return std::atan2(to->y() - from->y(), to->x() - from->x());
}

}  // namespace waymark::testbed
