// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/image_section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "exporters/formatting.hpp"
#include "exporters/report/base64.hpp"
#include "exporters/report/image_picture.hpp"
#include "exporters/report/landmark_section.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLongest = 900;      // pixels of a picture
constexpr std::int64_t kDetail = 320;       // of the image, side of the detail
constexpr std::size_t kMaxOutlines = 4000;  // per picture; more would hide the image
constexpr double kMinOutlineRadius = 1.5;   // image pixels, of an outline without a size

/// Returns a colour by type that stands out from a grey image; the map's own colours are for paper.
const char* outline_colour(TypeId type) {
  constexpr std::array colours = {"#5ad1ff", "#ff9df2", "#ffd23f", "#7dff7a", "#ffa05a"};
  return colours[type % colours.size()];
}

/// Observations in one image.
struct ImageObservations {
  const geodb::ImageRecord* record = nullptr;
  std::vector<Observation> seen = {};  ///< with a pixel
  std::int64_t count = 0, used = 0;    ///< of those
};

/// Returns the `most` images with the most used observations, and their observations. Those of the other
/// images are counted only.
std::vector<ImageObservations> observed_images(const geodb::MapStore& map,
                                               const std::vector<geodb::ImageRecord>& images,
                                               std::size_t max_images) {
  std::map<std::string, ImageObservations> by_name;
  for (const geodb::ImageRecord& image : images) by_name[image.name].record = &image;
  map.visit_observations([&](Observation&& one) {
    const auto found = by_name.find(one.source);
    if (found == by_name.end() || !one.pixel) return;
    ++found->second.count;
    found->second.used += one.rejected.empty();
  });
  std::vector<ImageObservations> all;
  for (auto& [name, image] : by_name)
    if (image.count > 0) all.push_back(std::move(image));
  std::ranges::stable_sort(
      all, [](const ImageObservations& a, const ImageObservations& b) { return a.used > b.used; });
  all.resize(std::min(all.size(), max_images));
  map.visit_observations([&](Observation&& one) {
    const auto image = std::ranges::find_if(
        all, [&](const ImageObservations& shown) { return shown.record->name == one.source; });
    if (image != all.end() && one.pixel) image->seen.push_back(std::move(one));
  });
  return all;
}

}  // namespace

std::optional<std::string> find_image_file(const geodb::MapStore& map, const std::string& name) {
  const fs::path folder = map.path().parent_path();
  std::vector<std::string> candidates;
  for (const geodb::RunRecord& run : map.runs())
    for (const InputFile& input : run.inputs)
      if (fs::path(input.path).filename() == name) candidates.push_back(input.path);
  candidates.push_back((folder / name).string());
  candidates.push_back((folder / "images" / name).string());
  for (const std::string& path : candidates) {
    std::error_code missing;
    if (path.starts_with("/vsi") || fs::exists(path, missing)) return path;
  }
  return {};
}

namespace {

double radius_in_pixels(const Observation& one, const LandmarkType& type, const geodb::ImageRecord& image) {
  const auto feature = find_feature(type, type.body.feature);
  if (!feature || *feature >= one.features.size() || !one.features[*feature].known() || !image.gsd)
    return kMinOutlineRadius;
  const double radius = type.body.radius_per_value * one.features[*feature].value;
  return std::max(kMinOutlineRadius, radius / image.gsd->value);
}

/// Returns the square inside the image with the most used observations.
Window densest_window(const ImageObservations& image, const Window& extent) {
  std::map<std::pair<std::int64_t, std::int64_t>, int> counts;
  for (const Observation& one : image.seen)
    if (one.rejected.empty())
      ++counts[{std::llround(one.pixel->x()) / kDetail, std::llround(one.pixel->y()) / kDetail}];
  std::pair<std::int64_t, std::int64_t> best{0, 0};
  int highest = -1;
  for (const auto& [cell, count] : counts)
    if (count > highest) best = cell, highest = count;
  const std::int64_t columns = std::min(kDetail, extent.columns), rows = std::min(kDetail, extent.rows);
  return {std::clamp<std::int64_t>(best.first * kDetail, 0, extent.columns - columns),
          std::clamp<std::int64_t>(best.second * kDetail, 0, extent.rows - rows), columns, rows};
}

std::string outlines(const ImageObservations& image, const TypeRegistry& types, const Window& part) {
  std::string svg;
  std::size_t drawn = 0;
  for (const Observation& one : image.seen) {
    const LandmarkType& type = types[one.type];
    const double r = radius_in_pixels(one, type, *image.record);
    // pixel (0, 0) is the centre of the first pixel, the picture begins at its corner
    const double x = one.pixel->x() + 0.5 - static_cast<double>(part.column),
                 y = one.pixel->y() + 0.5 - static_cast<double>(part.row);
    if (x < -r || y < -r || x > static_cast<double>(part.columns) + r ||
        y > static_cast<double>(part.rows) + r)
      continue;
    if (++drawn > kMaxOutlines) break;
    const bool used = one.rejected.empty();
    svg += fmt::format(
        "<circle class='{}' cx='{:.1f}' cy='{:.1f}' r='{:.1f}' style='--type:{}'><title>{}</title></circle>",
        used ? "used" : "rejected", x, y, r, outline_colour(one.type),
        escape_markup(
            used ? fmt::format("{} {}\nconfidence {:.2f}", type.name, one.landmark_uid, one.confidence)
                 : fmt::format("{}, rejected: {}", type.name, one.rejected)));
  }
  return svg;
}

std::string picture_html(const ImageObservations& image, const TypeRegistry& types, const std::string& path,
                         const Window& part, const std::string& says) {
  const auto picture = image_picture(path, part, kLongest);
  if (!picture) return {};
  return fmt::format(
      "<figure class='image'><svg viewBox='0 0 {0} {1}' role='img' aria-label='{2}'><image width='{0}' "
      "height='{1}' href='data:image/jpeg;base64,{3}'/>{4}</svg><figcaption>{2}</figcaption></figure>\n",
      part.columns, part.rows, escape_markup(says), base64(picture->jpeg), outlines(image, types, part));
}

std::string counts_html(const ImageObservations& image, const TypeRegistry& types) {
  std::map<TypeId, std::int64_t> used;
  std::map<std::string, std::int64_t> rejected;
  for (const Observation& one : image.seen)
    one.rejected.empty() ? ++used[one.type] : ++rejected[one.rejected];
  std::string html;
  for (const auto& [type, count] : used)
    html += fmt::format("<span class='count' style='--type:{}'><i></i>{} {}</span>", outline_colour(type),
                        number_text(static_cast<double>(count)), escape_markup(types[type].name));
  for (const auto& [reason, count] : rejected)
    html += fmt::format("<span class='count rejected'><i></i>{} {}</span>",
                        number_text(static_cast<double>(count)), escape_markup(reason));
  return html;
}

std::string image_html(const geodb::MapStore& map, const ImageObservations& image) {
  std::string known;
  if (image.record->gsd) known += fmt::format("<span>{:.3g} m per pixel</span>", image.record->gsd->value);
  if (image.record->sun_elevation)
    known +=
        fmt::format("<span>sun {:.0f}\u00b0 above the ground</span>", image.record->sun_elevation->value);
  const std::string heading =
      fmt::format("<h3>{}</h3><p class='counts'>{}{}</p>\n", escape_markup(image.record->name),
                  counts_html(image, map.types()), known);
  const auto path = find_image_file(map, image.record->name);
  const auto extent = path ? image_extent(*path) : std::nullopt;
  if (!extent) return heading + "<p class='empty'>The image file is missing.</p>\n";
  std::string pictures = picture_html(image, map.types(), *path, *extent, "The whole image");
  if (std::max(extent->columns, extent->rows) > kDetail * 5 / 4) {
    const Window part = densest_window(image, *extent);
    pictures += picture_html(image, map.types(), *path, part,
                             fmt::format("Its busiest part: {} x {} pixels from column {}, row {}",
                                         part.columns, part.rows, part.column, part.row));
  }
  return heading + "<div class='pictures'>" + pictures + "</div>\n";
}

}  // namespace

std::string image_figures(const geodb::MapStore& map, std::int64_t max_images) {
  const auto records = map.images();
  if (records.empty() || max_images < 1) return {};
  const auto images = observed_images(map, records, static_cast<std::size_t>(max_images));
  if (images.empty()) return {};
  std::string html = "<p>";
  if (images.size() < records.size())
    html += fmt::format("{} of {} images, those with the most detections. ", images.size(),
                        number_text(static_cast<double>(records.size())));
  html += "Used observations are outlined, rejected ones dashed; the tooltip gives the reason.</p>\n";
  for (const ImageObservations& image : images) html += image_html(map, image);
  return html;
}

}  // namespace waymark::exporters
