// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/map_markers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exporters/formatting.hpp"
#include "exporters/vector/export_columns.hpp"

namespace waymark::exporters {
namespace {

constexpr std::size_t kMaxMarkers = 2500;  // of a type; more hide each other and enlarge the file
constexpr std::size_t kMaxLabels = 40;
constexpr double kMinMarkerRadius = 2, kMaxMarkerRadius = 13;  // radius of a marker, drawing units
constexpr double kModest =
    4;  // smaller markers have a fainter outline, so that thousands do not hide the relief
constexpr double kMinCrowdedRadius = 1.2,
                 kCover = 0.06;  // crowded markers shrink until they cover this fraction of the map
constexpr double kLetter = 7.2, kLine = 13;  // of a label's text

struct Box {
  double left, top, right, bottom;
  bool meets(const Box& o) const {
    return left < o.right && o.left < right && top < o.bottom && o.top < bottom;
  }
};

struct Marker {
  const Landmark* landmark;
  double x, y, radius;
};

/// Returns the shape with radius 1 about the origin.
const char* shape_of(Solid solid) {
  switch (solid) {
    case Solid::cone:
      return "<path d='M0 -1L.95 .75H-.95Z'/>";
    case Solid::bowl:
      return "<circle r='1' fill-opacity='.12'/>";
    case Solid::cylinder:
      return "<path d='M-.8 -.8H.8V.8H-.8Z'/>";
    case Solid::sphere:
    case Solid::point:
      return "<circle r='.9'/>";
  }
  return "<circle r='.9'/>";
}

double radius_of(const Landmark& landmark, const LandmarkSection& section, const MapView& view) {
  const auto feature = find_feature(section.type, section.type.size_feature);
  const double value = value_of(landmark, feature);
  if (!(value > 0)) return kMinMarkerRadius;
  const double on_the_ground = section.type.body.radius_per_value * value / view.metres_per_unit();
  if (section.type.drawn_as == Solid::bowl && section.type.size_feature == section.type.body.feature)
    return std::max(kMinMarkerRadius, on_the_ground);
  const std::string& size = section.type.size_feature;
  const double largest = certified_value(section.type, section.landmarks.front(), size);
  const double certified = std::max(0.0, certified_value(section.type, landmark, size));
  if (!(largest > 0)) return kMinMarkerRadius;
  return kMinMarkerRadius + (kMaxMarkerRadius - kMinMarkerRadius) * std::sqrt(certified / largest);
}

std::vector<Marker> markers_of(const LandmarkSection& section, const MapView& view) {
  std::vector<Marker> markers;
  for (const Landmark& landmark : section.landmarks) {
    if (markers.size() == kMaxMarkers) break;
    const double x = view.x(view.unwrap(landmark.position.xyz.x())), y = view.y(landmark.position.xyz.y());
    if (x >= 0 && x <= view.width && y >= 0 && y <= view.height)
      markers.push_back({&landmark, x, y, radius_of(landmark, section, view)});
  }
  if (section.type.drawn_as == Solid::bowl) return markers;  // bowls stay true to scale
  double covered = 0;
  for (const Marker& m : markers) covered += 4 * m.radius * m.radius;
  const double shrink = std::sqrt(kCover * view.width * view.height / std::max(covered, 1.0));
  if (shrink < 1)
    for (Marker& m : markers) m.radius = std::max(kMinCrowdedRadius, shrink * m.radius);
  return markers;
}

std::string tooltip(const Landmark& landmark, const LandmarkType& type) {
  std::string text = landmark.uid;
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (const double value = value_of(landmark, i); std::isfinite(value))
      text += fmt::format("\n{} {}", type.features[i].name, number_format(type.features[i], value)(value));
  return escape_markup(text);
}

std::string label_text(const Landmark& landmark, const LandmarkType& type) {
  const auto feature = find_feature(type, type.label_feature);
  const double value = value_of(landmark, feature);
  return std::isfinite(value) ? number_format(type.features[*feature], value).number(value) : "";
}

/// Counts the letters of UTF-8 text.
double letters(const std::string& text) {
  return static_cast<double>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// Places labels where there is room: right, left, above or below the marker.
class Labels {
 public:
  /// Reserves the corners of the scale bar and the north arrow.
  explicit Labels(const MapView& view)
      : view_(view), taken_{{0, view.height - 56, 260, view.height}, {view.width - 70, 0, view.width, 70}} {}

  void add(const Marker& marker, const std::string& text) {
    if (text.empty() || count_ == kMaxLabels) return;
    const double width = kLetter * letters(text), r = marker.radius + 3;
    const double x = marker.x, y = marker.y;
    for (const Box& box : {Box{x + r, y - kLine / 2, x + r + width, y + kLine / 2},
                           Box{x - r - width, y - kLine / 2, x - r, y + kLine / 2},
                           Box{x - width / 2, y - r - kLine, x + width / 2, y - r},
                           Box{x - width / 2, y + r, x + width / 2, y + r + kLine}}) {
      if (!free(box)) continue;
      svg_ += fmt::format("<text x='{:.1f}' y='{:.1f}'>{}</text>", box.left, box.bottom - 2.5,
                          escape_markup(text));
      taken_.push_back(box);
      taken_.push_back({x - marker.radius, y - marker.radius, x + marker.radius, y + marker.radius});
      ++count_;
      return;
    }
  }
  const std::string& svg() const { return svg_; }

 private:
  bool free(const Box& box) const {
    const bool inside =
        box.left > 4 && box.right < view_.width - 4 && box.top > 4 && box.bottom < view_.height - 4;
    return inside &&
           std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) { return box.meets(other); });
  }

  const MapView& view_;
  std::vector<Box> taken_;
  std::string svg_;
  std::size_t count_ = 0;
};

}  // namespace

std::string landmark_attributes(const Landmark& landmark) {
  const auto quality = equal_weight_quality(landmark);
  return fmt::format("data-uid='{}' data-confidence='{:.3f}' data-quality='{}'", escape_markup(landmark.uid),
                     landmark.confidence, quality ? fmt::format("{:.3f}", *quality) : "");
}

MapMarkers draw_markers(const MapView& view, const std::vector<LandmarkSection>& sections) {
  MapMarkers result;
  Labels labels(view);
  for (const LandmarkSection& section : sections) {
    const std::vector<Marker> markers = markers_of(section, view);
    result.svg += fmt::format("<g class='marker {}' style='--type:{}'>",
                              section.type.drawn_as == Solid::bowl ? "ring" : "solid",
                              escape_markup(section.type.colour));
    for (auto m = markers.rbegin(); m != markers.rend(); ++m)  // the foremost on top
      result.svg +=
          fmt::format("<g{} {} transform='translate({:.1f} {:.1f}) scale({:.2f})'>{}<title>{}</title></g>",
                      m->radius < kModest ? " class='modest'" : "", landmark_attributes(*m->landmark), m->x,
                      m->y, m->radius, shape_of(section.type.drawn_as), tooltip(*m->landmark, section.type));
    result.svg += "</g>\n";
    for (const Marker& marker : markers) labels.add(marker, label_text(*marker.landmark, section.type));
    result.drawn += markers.size();
    result.total += static_cast<std::size_t>(section.count);
  }
  result.svg += "<g class='labels'>" + labels.svg() + "</g>\n";
  return result;
}

std::string svg_symbol(const LandmarkType& type, double size) {
  return fmt::format(
      "<svg class='symbol' viewBox='-1.3 -1.3 2.6 2.6' width='{0}' height='{0}' aria-hidden='true'>"
      "<g class='marker {1}' style='--type:{2}'>{3}</g></svg>",
      size, type.drawn_as == Solid::bowl ? "ring" : "solid", escape_markup(type.colour),
      shape_of(type.drawn_as));
}

}  // namespace waymark::exporters
