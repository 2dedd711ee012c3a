// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/scale_camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

// The corner of pixel (0, 0) is at -0.5 and stays there.
double scaled_coordinate(double place, double scale) {
  return (place + 0.5) * scale - 0.5;
}

}  // namespace

Camera scale_camera(const Camera& camera, std::int64_t columns, std::int64_t rows, const std::string& path,
                    std::vector<std::string>& warnings) {
  Camera fitted = camera;
  fitted.columns = columns;
  fitted.rows = rows;
  if (std::isnan(camera.cx)) {
    fitted.cx = static_cast<double>(columns - 1) / 2;
    fitted.cy = static_cast<double>(rows - 1) / 2;
  }
  if (camera.columns == 0 || (camera.columns == columns && camera.rows == rows)) return fitted;
  const double across = static_cast<double>(columns) / static_cast<double>(camera.columns);
  const double down = static_cast<double>(rows) / static_cast<double>(camera.rows);
  const double slack = 0.005 + 1.0 / static_cast<double>(std::min(columns, rows));
  if (!(std::abs(across / down - 1) < slack))
    throw Error(ErrorCode::input,
                fmt::format("the image measures {} x {}, its camera {} x {}: not the same picture", columns,
                            rows, camera.columns, camera.rows),
                path, "use the images the cameras were computed from; a cropped image needs its own camera");
  warnings.push_back(fmt::format("{} measures {} x {}, its camera {} x {}: the camera is scaled by {:.6g}",
                                 path, columns, rows, camera.columns, camera.rows, across));
  fitted.fx *= across;
  fitted.skew *= across;
  fitted.fy *= down;
  fitted.cx = scaled_coordinate(camera.cx, across);
  fitted.cy = scaled_coordinate(camera.cy, down);
  return fitted;
}

void check_camera(const Camera& camera, const std::string& file, const std::string& place,
                  std::vector<std::string>& warnings) {
  const std::string where = place.empty() ? file : file + ", " + place;
  const auto refuse = [&](const std::string& problem, const std::string& hint) {
    throw Error(ErrorCode::input, problem, where, hint);
  };
  if (!(camera.fx != 0 && camera.fy > 0))
    refuse(fmt::format("the focal length is {} x {} pixels", camera.fx, camera.fy),
           "it must be positive; fx is negative for a mirrored image");
  bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) && std::isfinite(camera.skew);
  finite = finite && (camera.columns == 0 || (std::isfinite(camera.cx) && std::isfinite(camera.cy)));
  for (const double k : camera.distortion) finite = finite && std::isfinite(k);
  if (!finite) refuse("a number of the camera is not finite", "correct the file");
  if (camera.columns == 0) return;
  if (camera.columns < 0 || camera.rows < 1)
    refuse(fmt::format("the image of the camera measures {} x {} pixels", camera.columns, camera.rows),
           "both must be positive");
  constexpr int kSamples = 16;
  int blind = 0;
  for (int r = 0; r <= kSamples; ++r)
    for (int c = 0; c <= kSamples; ++c) {
      const Eigen::Vector2d pixel(static_cast<double>(camera.columns - 1) * c / kSamples,
                                  static_cast<double>(camera.rows - 1) * r / kSamples);
      blind += !ray(camera, pixel);
    }
  const double fraction = blind / static_cast<double>((kSamples + 1) * (kSamples + 1));
  if (fraction > 0.25)
    refuse(fmt::format("the lens distortion does not invert in {:.0f} % of the image", 100 * fraction),
           "check the coefficients, their order, and whether they are for normalised or pixel coordinates");
  if (blind > 0)
    warnings.push_back(
        fmt::format("{}: the lens distortion does not invert in {:.1f} % of the image, at its "
                    "edge; detections there are not projected",
                    where, 100 * fraction));
}

}  // namespace waymark::importers
