// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/map_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "exporters/formatting.hpp"
#include "exporters/report/base64.hpp"
#include "exporters/report/map_markers.hpp"
#include "exporters/report/map_view.hpp"
#include "exporters/report/relief_picture.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

/// Margin around the frame for coordinates: left, top, right, bottom.
constexpr double kLeft = 78, kTop = 8, kRight = 26, kBottom = 34;

std::string tint_legend(const HypsometricTint& tint) {
  std::string stops;
  constexpr int steps = 24;
  for (int i = 0; i <= steps; ++i) {
    const Colour c = tint(tint.lowest + (tint.highest - tint.lowest) * i / steps);
    stops += fmt::format("{}rgb({} {} {})", i == 0 ? "" : ",", c.red, c.green, c.blue);
  }
  return fmt::format(
      "<span class='ramp'>{}&nbsp;m <i style='background:linear-gradient(90deg,{})'></i> {}&nbsp;m</span>",
      number_text(tint.lowest), stops, number_text(tint.highest));
}

std::string legend(const std::vector<LandmarkSection>& sections, const MapMarkers& markers,
                   const std::string& ramp) {
  std::string items;
  for (const LandmarkSection& section : sections) {
    if (section.count == 0) continue;
    const std::string sized =
        section.type.size_feature.empty() ? "" : ", larger with " + section.type.size_feature;
    items += fmt::format("<span>{}{}{}</span>", svg_symbol(section.type, 16),
                         escape_markup(title_of(section.type.name)), escape_markup(title_of(sized)));
  }
  if (markers.drawn < markers.total)
    items += fmt::format("<span>the foremost {} of {} are drawn</span>",
                         number_text(static_cast<double>(markers.drawn)),
                         number_text(static_cast<double>(markers.total)));
  return items + ramp;
}

}  // namespace

std::vector<std::string> relief_names(const geodb::MapStore& map) {
  if (map.has_dem_coverage()) return {"GPKG:" + map.path().string() + ":dem"};
  std::vector<std::string> names, images;
  for (const geodb::ImageRecord& image : map.images()) images.push_back(image.name);
  for (const geodb::RunRecord& run : map.runs())
    for (const InputFile& input : run.inputs) {
      if (std::ranges::count(images, fs::path(input.path).filename().string()) > 0) continue;  // no heights
      const fs::path beside = map.path().parent_path() / fs::path(input.path).filename();
      std::error_code missing;
      const bool there = input.path.starts_with("/vsi") || fs::exists(input.path, missing);
      const std::string name = there ? input.path : beside.string();
      // The recorded size includes associated files, such as the sources of a VRT.
      const bool another = !name.starts_with("/vsi") && fs::file_size(name, missing) > input.bytes;
      if (!another && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  return names;
}

std::string map_figure(const geodb::MapStore& map, const std::vector<LandmarkSection>& sections,
                       std::int64_t relief_pixels) {
  const auto landmarks = extent_of(sections, map.crs());
  const double near_x = landmarks ? landmarks->west + landmarks->width() / 2 : 0;
  const auto relief = read_relief(relief_names(map), map.crs(), near_x, relief_pixels);
  if (!relief && !landmarks) return "<p class='empty'>This map has no landmarks yet.</p>";

  const MapView view = view_of(map.crs(), relief ? relief->extent : *landmarks);
  std::string picture, ramp;
  if (relief) {
    const HypsometricTint tint = hypsometric_tint(*relief, map.crs().body());
    picture = fmt::format(
        "<image width='{:.2f}' height='{:.2f}' preserveAspectRatio='none' "
        "href='data:image/png;base64,{}'/>",
        view.width, view.height, base64(encode_png(shade(*relief, tint))));
    ramp = tint_legend(tint);
  }
  const MapMarkers markers = draw_markers(view, sections);
  return fmt::format(
      "<figure class='map'><svg viewBox='{:.1f} {:.1f} {:.1f} {:.1f}' role='img' aria-label='Map of the "
      "landmarks'>"
      "<rect class='ground' width='{:.2f}' height='{:.2f}'/>{}{}{}{}{}"
      "<rect class='frame' width='{:.2f}' height='{:.2f}'/></svg>"
      "<figcaption class='legend'>{}</figcaption></figure>\n",
      -kLeft, -kTop, view.width + kLeft + kRight, view.height + kTop + kBottom, view.width, view.height,
      picture, svg_graticule(view), markers.svg, svg_scale_bar(view), svg_north_arrow(view), view.width,
      view.height, legend(sections, markers, ramp));
}

}  // namespace waymark::exporters
