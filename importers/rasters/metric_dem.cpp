// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/metric_dem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "importers/images/image.hpp"
#include "importers/tables/area_of_interest.hpp"

namespace waymark::importers {
namespace {

constexpr double kMaxExtent = 6;  // degrees on the ground: scale is true to 0.2 % there

class MetricDem final : public ImportedDem {
 public:
  explicit MetricDem(std::shared_ptr<const ImportedDem> source) : source_(std::move(source)) {
    const GridGeometry& from = source_->geometry();
    const double column = static_cast<double>(from.columns - 1) / 2,
                 row = static_cast<double>(from.rows - 1) / 2;
    const double lon = from.where.x(column), lat = from.where.y(row);
    const double tall = static_cast<double>(from.rows) * -from.where.dy;
    const double wide =
        static_cast<double>(from.columns) * from.where.dx * std::cos(lat * 3.141592653589793 / 180);
    if (!(wide <= kMaxExtent && tall <= kMaxExtent))
      throw Error(ErrorCode::input,
                  fmt::format("a DEM of {:.3g} x {:.3g} degrees is too wide for a projection to metres",
                              static_cast<double>(from.columns) * from.where.dx, tall),
                  source_->files().empty() ? "" : source_->files().front(),
                  "cut out the area of the images: gdal_translate -projwin LON0 LAT0 LON1 LAT1");
    where_.crs = Crs::from_text(local_projection(from.where.crs, lon, lat));
    const CrsTransform to_metres(from.where.crs, where_.crs);
    const auto middle = to_metres(lon, lat), east = to_metres(lon + from.where.dx, lat),
               north = to_metres(lon, lat - from.where.dy);
    const double step = std::min(std::hypot(east.x - middle.x, east.y - middle.y),
                                 std::hypot(north.x - middle.x, north.y - middle.y));
    double low_x = middle.x, high_x = middle.x, low_y = middle.y, high_y = middle.y;
    constexpr int kSteps = 32;
    for (int i = 0; i <= kSteps; ++i)
      for (const auto& [u, v] : {std::pair{i, 0}, {i, kSteps}, {0, i}, {kSteps, i}}) {
        const auto p = to_metres(from.where.x(2 * column * u / kSteps), from.where.y(2 * row * v / kSteps));
        low_x = std::min(low_x, p.x), high_x = std::max(high_x, p.x);
        low_y = std::min(low_y, p.y), high_y = std::max(high_y, p.y);
      }
    where_.dx = step, where_.dy = -step;
    where_.x0 = low_x, where_.y0 = high_y;
    geometry_ = {.columns = static_cast<std::int64_t>(std::floor((high_x - low_x) / step)) + 1,
                 .rows = static_cast<std::int64_t>(std::floor((high_y - low_y) / step)) + 1,
                 .where = where_};
    if (const std::string& area = source_->import().area; !area.empty())
      area_ = read_area_of_interest(area, where_.crs);
    warnings_ = source_->warnings();
    warnings_.push_back(fmt::format("the DEM is in degrees; it is used in metres: {}",
                                    local_projection(from.where.crs, lon, lat)));
  }

  const GridGeometry& geometry() const override { return geometry_; }
  NodataPolicy nodata_policy() const override { return source_->nodata_policy(); }
  bool in_area(double x, double y) const override { return !area_ || area_->contains(x, y); }
  double height_sd() const override { return source_->height_sd(); }
  std::vector<std::string> files() const override { return source_->files(); }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  bool has_square_blocks() const override { return source_->has_square_blocks(); }
  const DemImport& import() const override { return source_->import(); }

  HeightWindow read(const Window& window) const override {
    HeightWindow cells(window.columns, window.rows, kNoHeight);
    if (window.cells() == 0) return cells;
    const GridGeometry& from = source_->geometry();
    std::vector<double> x, y;
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c) {
        x.push_back(where_.x(static_cast<double>(window.column + c)));
        y.push_back(where_.y(static_cast<double>(window.row + r)));
      }
    CrsTransform(where_.crs, from.where.crs).apply(x, y);
    const double last_column = static_cast<double>(from.columns - 1),
                 last_row = static_cast<double>(from.rows - 1);
    double low_column = last_column, high_column = 0, low_row = last_row, high_row = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = is_near_grid(from.where.column(x[i]), last_column);
      y[i] = is_near_grid(from.where.row(y[i]), last_row);
      if (!std::isfinite(x[i] + y[i])) continue;
      low_column = std::min(low_column, x[i]), high_column = std::max(high_column, x[i]);
      low_row = std::min(low_row, y[i]), high_row = std::max(high_row, y[i]);
    }
    if (low_column > high_column || low_row > high_row) return cells;
    const Window around{
        .column = static_cast<std::int64_t>(low_column),
        .row = static_cast<std::int64_t>(low_row),
        .columns = static_cast<std::int64_t>(high_column) - static_cast<std::int64_t>(low_column) + 2,
        .rows = static_cast<std::int64_t>(high_row) - static_cast<std::int64_t>(low_row) + 2};
    const HeightWindow heights = source_->read(around);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::isfinite(x[i] + y[i]))
        cells.cells()[i] = between(heights, x[i] - static_cast<double>(around.column),
                                   y[i] - static_cast<double>(around.row));
    return cells;
  }

 private:
  // A position up to half a cell outside counts as on the border.
  static double is_near_grid(double place, double last) {
    return place >= -0.5 && place <= last + 0.5 ? std::clamp(place, 0.0, last) : std::nan("");
  }

  static double between(const HeightWindow& heights, double column, double row) {
    const auto c = static_cast<std::int64_t>(column), r = static_cast<std::int64_t>(row);
    const double u = column - static_cast<double>(c), v = row - static_cast<double>(r);
    double sum = 0;
    for (const int dr : {0, 1})
      for (const int dc : {0, 1}) {
        const double weight = (dc ? u : 1 - u) * (dr ? v : 1 - v);
        if (weight == 0) continue;
        const double height = heights(c + dc, r + dr);
        if (height == kNoHeight) return kNoHeight;
        sum += weight * height;
      }
    return sum;
  }

  std::shared_ptr<const ImportedDem> source_;
  Georeference where_;
  GridGeometry geometry_;
  std::optional<Area> area_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::shared_ptr<const ImportedDem> project_to_metres(std::shared_ptr<const ImportedDem> dem) {
  if (dem->geometry().where.crs.kind() != CrsKind::geographic) return dem;
  return std::make_shared<const MetricDem>(std::move(dem));
}

}  // namespace waymark::importers
