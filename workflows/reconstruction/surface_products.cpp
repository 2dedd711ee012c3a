// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/surface_products.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "exporters/raster/cog_file.hpp"
#include "workflows/mapping/image_stages.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

Georeference map_reference(const Crs& crs, const pipeline::SurfaceGrid& grid) {
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  return {crs, grid.x(0) / unit, grid.y(0) / unit, grid.cell / unit, -grid.cell / unit};
}

Grid<float> as_floats(const Grid<std::uint8_t>& cells) {
  Grid<float> out(cells.columns(), cells.rows());
  std::ranges::transform(cells.cells(), out.cells().begin(),
                         [](std::uint8_t v) { return static_cast<float>(v); });
  return out;
}

// Path from the folder of the job, so that folder and images can be moved together; /vsi paths as they are.
std::string path_from(const fs::path& folder, const std::string& file) {
  if (file.starts_with("/vsi")) return file;
  return fs::absolute(file)
      .lexically_normal()
      .lexically_proximate(fs::absolute(folder).lexically_normal())
      .string();
}

}  // namespace

std::string reasons_text(const pipeline::SurfaceHeights& heights) {
  std::vector<std::pair<std::int64_t, int>> order;
  for (int i = 1; i < pipeline::kNoHeightReasons; ++i)
    if (heights.counts[static_cast<std::size_t>(i)] > 0)
      order.emplace_back(-heights.counts[static_cast<std::size_t>(i)], i);
  std::ranges::sort(order);
  std::string text;
  for (const auto& [count, reason] : order)
    text += fmt::format(
        "{}{} {:.1f} %", text.empty() ? "" : ", ",
        pipeline::reason_text(static_cast<pipeline::NoHeight>(reason)),
        -100 * static_cast<double>(count) / static_cast<double>(heights.grid.columns * heights.grid.rows));
  return text;
}

void write_dem(const fs::path& file, const pipeline::SurfaceHeights& dem, const Crs& crs) {
  std::map<std::string, std::string> reasons;
  for (int i = 0; i < pipeline::kNoHeightReasons; ++i)
    reasons[fmt::format("REASON_{}", i)] = pipeline::reason_text(static_cast<pipeline::NoHeight>(i));
  const Grid<float> views = as_floats(dem.views), reason = as_floats(dem.reason);
  exporters::write_cog(file,
                       {{"height", "m", &dem.height},
                        {"standard deviation of matching", "m", &dem.sd},
                        {"standard deviation of poses and lens", "m", &dem.systematic_sd},
                        {"views", "", &views},
                        {"convergence angle", "deg", &dem.angle},
                        {"score", "", &dem.score},
                        {"reason of no data", "", &reason}},
                       map_reference(crs, dem.grid), reasons);
}

void write_orthophoto(const fs::path& file, const pipeline::Orthophoto& ortho,
                      const std::vector<pipeline::SurfaceView>& views, const Crs& crs) {
  Grid<float> source(ortho.source.columns(), ortho.source.rows());
  std::ranges::transform(ortho.source.cells(), source.cells().begin(), [](std::uint16_t v) {
    return v == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(v);
  });
  std::map<std::string, std::string> names;
  for (std::size_t v = 0; v < views.size(); ++v) {
    names[fmt::format("SOURCE_{}", v + 1)] = views[v].name;
    names[fmt::format("GAIN_{}", v + 1)] = fmt::format("{:.4f}", ortho.gains[v]);
  }
  exporters::write_cog(file, {{"brightness", "", &ortho.brightness}, {"index of source", "", &source}},
                       map_reference(crs, ortho.grid), names);
}

std::string job_text(const PosedImages& posed, const pipeline::SurfaceHeights& dem, const fs::path& folder) {
  using JobJson = nlohmann::ordered_json;
  std::vector<float> sds;
  for (const float sd : dem.sd.cells())
    if (!std::isnan(sd)) sds.push_back(sd);
  std::ranges::nth_element(sds, sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2));
  JobJson load{{"stage", "load_dem"},
               {"files", {"dem.tif"}},
               {"band", 1},
               {"nodata", "unknown"},
               {"height_sd", static_cast<double>(sds[sds.size() / 2])}};
  if (posed.crs.kind() == CrsKind::local) load["crs"] = "local";
  JobJson files = JobJson::array();
  bool suns = true;
  for (const ImageHandle& image : posed.images) {
    files.push_back(path_from(folder, image->info().path));
    suns = suns && (image->info().sun || image->info().image_sun_angle);
  }
  JobJson stages = JobJson::array(
      {load, JobJson{{"stage", "load_images"}, {"files", files}, {"cameras", "cameras.json"}}});
  for (const std::string& stage : image_stages({.mountain_tops = true}, suns))
    stages.push_back({{"stage", stage}});
  return JobJson{{"name", "Map from pictures"}, {"stages", stages}}.dump(2) + "\n";
}

}  // namespace waymark::workflows
