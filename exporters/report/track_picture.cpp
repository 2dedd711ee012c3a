// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/track_picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/principal_axes.hpp"
#include "exporters/formatting.hpp"
#include "exporters/report/map_view.hpp"

namespace waymark::exporters {
namespace {

constexpr double kEllipseScale = 10;
constexpr double kWidth = 900, kChart = 220, kBorder = 46;  // pixels
constexpr double kMaxEllipse = 90;                          // pixels; larger ones are drawn in true size
constexpr double kLetter = 6.8;                             // pixels, mean advance of a sans-serif of 12
constexpr double kMinError = 0.01;                          // metres, foot of the chart
constexpr std::array<const char*, 7> kColours{"#d95f02", "#1b6fb3", "#7b3294", "#1b9e77",
                                              "#c51b7d", "#8c6d31", "#444444"};

class Drawing {
 public:
  explicit Drawing(const TrackPicture& picture) : picture_(picture) {
    for (const localization::StampedPose& p : picture.truth) box_.extend(p.pose.at());
    for (const PictureTrack& t : picture.tracks)
      for (const localization::TrackRow& row : t.track.rows) box_.extend(row.at.pose.at());
    if (box_.isEmpty()) box_.extend(Eigen::Vector2d(0, 0));
    const double margin = 0.06 * std::max(10.0, box_.sizes().maxCoeff());
    box_.extend(Eigen::Vector2d(box_.min().array() - margin));
    box_.extend(Eigen::Vector2d(box_.max().array() + margin));
    scale_ = (kWidth - 2 * kBorder) / box_.sizes().x();
    // Limits the height, so that the page of a tall drive remains readable.
    scale_ = std::min(scale_, 700 / box_.sizes().y());
    height_ = scale_ * box_.sizes().y();
  }

  std::string page() {
    const double all = 30 + height_ + 30 + kChart + 50;
    svg_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 "
        "{0:.0f} "
        "{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
        "fill=\"#ffffff\"/>\n<text x=\"{2}\" y=\"20\" font-size=\"15\">{3}</text>\n",
        kWidth, all, kBorder, escape_markup(picture_.title));
    map();
    chart();
    return svg_ + "</svg>\n";
  }

 private:
  double x(double east) const { return kBorder + scale_ * (east - box_.min().x()); }
  double y(double north) const { return 30 + scale_ * (box_.max().y() - north); }
  static const char* colour(std::size_t i) { return kColours[i % kColours.size()]; }

  template <class Places>
  void line(const Places& places, std::size_t count, const char* paint, double width) {
    const std::size_t step = std::max<std::size_t>(1, count / 1500);
    std::string points;
    for (std::size_t i = 0; i < count; i += step) {
      const Eigen::Vector2d at = places(i);
      fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f} ", x(at.x()), y(at.y()));
    }
    svg_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", points,
                        paint, width);
  }

  void map() {
    svg_ += fmt::format(
        "<clipPath id=\"map\"><rect x=\"{0}\" y=\"30\" width=\"{1:.1f}\" height=\"{2:.1f}\"/></clipPath>"
        "<g clip-path=\"url(#map)\"><rect x=\"{0}\" y=\"30\" width=\"{1:.1f}\" height=\"{2:.1f}\" "
        "fill=\"#f6f3ee\" stroke=\"#999\"/>\n",
        kBorder, scale_ * box_.sizes().x(), height_);
    for (const PictureDot& dot : picture_.map) {
      if (!box_.contains(dot.at)) continue;
      svg_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"{}\"/>\n", x(dot.at.x()),
                          y(dot.at.y()), std::clamp(scale_ * dot.radius, 1.0, 6.0), dot.colour);
    }
    for (const PictureDot& dot : picture_.mapped)
      if (box_.contains(dot.at))
        svg_ += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" fill=\"none\" stroke=\"{}\" "
            "stroke-width=\"1.3\"/>\n",
            x(dot.at.x()), y(dot.at.y()), dot.colour);
    line([&](std::size_t i) { return picture_.truth[i].pose.at(); }, picture_.truth.size(), "#000000", 3.5);
    for (std::size_t k = 0; k < picture_.tracks.size(); ++k) {
      const auto& rows = picture_.tracks[k].track.rows;
      line([&](std::size_t i) { return rows[i].at.pose.at(); }, rows.size(), colour(k), 1.4);
      ellipses(rows, colour(k));
    }
    const double bar = round_length(box_.sizes().x() / 4);
    svg_ += fmt::format(
        "<path d=\"M {0:.1f} {1:.1f} h {2:.1f}\" stroke=\"#000\" stroke-width=\"3\"/><text x=\"{0:.1f}\" "
        "y=\"{3:.1f}\">{4:g} "
        "m</text></g>\n",
        kBorder + 10, 30 + height_ - 12, scale_ * bar, 30 + height_ - 18, bar);
    legend();
  }

  void ellipses(const std::vector<localization::TrackRow>& rows, const char* paint) {
    const std::size_t step = std::max<std::size_t>(1, rows.size() / 14);
    for (std::size_t i = step; i < rows.size(); i += step) {
      const PrincipalAxes axes = principal_axes(rows[i].at.covariance.topLeftCorner<2, 2>());
      Eigen::Vector2d sd =
          Eigen::Vector2d(axes.major, axes.minor).cwiseMax(0).cwiseSqrt() * 3 * kEllipseScale * scale_;
      const bool as_it_is = !(sd.maxCoeff() < kMaxEllipse);
      if (as_it_is) sd /= kEllipseScale;
      if (!(sd.maxCoeff() < 10 * kWidth)) continue;
      const double turn = -axes.angle * 180 / std::numbers::pi;
      const Eigen::Vector2d at = rows[i].at.pose.at();
      svg_ += fmt::format(
          "<ellipse rx=\"{:.1f}\" ry=\"{:.1f}\" transform=\"translate({:.1f} {:.1f}) rotate({:.1f})\" "
          "fill=\"{}\" "
          "fill-opacity=\"{}\" stroke=\"{}\" stroke-width=\"0.8\"{}/>\n",
          sd.x(), sd.y(), x(at.x()), y(at.y()), turn, paint, as_it_is ? 0.03 : 0.1, paint,
          as_it_is ? " stroke-dasharray=\"4 3\"" : "");
    }
  }

  void legend() {
    struct Entry {
      std::string text;
      const char* paint;
      double width;
    };
    std::vector<Entry> entries{{"truth", "#000000", 3.5}};
    for (std::size_t k = 0; k < picture_.tracks.size(); ++k)
      entries.push_back({picture_.tracks[k].name + median_text(picture_.tracks[k].track), colour(k), 2});
    double box = 236;
    for (const Entry& e : entries) box = std::max(box, 44 + kLetter * static_cast<double>(e.text.size()));

    const double right = kBorder + scale_ * box_.sizes().x();
    const double left = right + 12 + box <= kWidth ? right + 12 : std::max(0.0, right - box - 6);
    svg_ += fmt::format(
        "<rect x=\"{}\" y=\"36\" width=\"{}\" height=\"{}\" fill=\"#ffffff\" fill-opacity=\"0.85\" "
        "stroke=\"#bbb\"/>\n",
        left, box, static_cast<double>(entries.size() + 1) * 17 + 6);
    double at = 52;
    for (const Entry& e : entries) {
      svg_ += fmt::format(
          "<path d=\"M {} {} h 24\" stroke=\"{}\" stroke-width=\"{}\"/><text x=\"{}\" y=\"{}\">{}</text>\n",
          left + 6, at - 4, e.paint, e.width, left + 36, at, escape_markup(e.text));
      at += 17;
    }
    svg_ += fmt::format(
        "<text x=\"{}\" y=\"{}\" font-size=\"10\">3 sigma: {:g} times as large; dashed: true size</text>\n",
        left + 6, at, kEllipseScale);
  }

  std::vector<std::pair<double, double>> errors(const localization::Track& track) const {
    std::vector<std::pair<double, double>> all;
    for (const localization::TrackRow& row : track.rows)
      if (const auto truth = localization::pose_at(picture_.truth, row.t, 1.5))
        all.emplace_back(row.t, (row.at.pose.at() - truth->at()).norm());
    return all;
  }

  std::string median_text(const localization::Track& track) const {
    auto all = errors(track);
    if (all.empty()) return "";
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::ranges::nth_element(all, middle, {}, &std::pair<double, double>::second);
    return fmt::format(", median {:.2f} m", middle->second);
  }

  void chart() {
    if (picture_.truth.size() < 2) return;
    const double top = 30 + height_ + 30, width = kWidth - 2 * kBorder;
    const double from = picture_.truth.front().t, span = picture_.truth.back().t - from;
    double largest = 1;
    for (const PictureTrack& t : picture_.tracks)
      for (const auto& [time, error] : errors(t.track)) largest = std::max(largest, error);
    const double decades = std::ceil(std::log10(largest / kMinError));
    const auto height = [&](double error) {
      return top + kChart * (1 - std::log10(std::max(error, kMinError) / kMinError) / decades);
    };
    for (double d = 0; d <= decades; ++d) {
      const double metres = kMinError * std::pow(10, d);
      svg_ += fmt::format(
          "<path d=\"M {0} {1:.1f} h {2}\" stroke=\"#ccc\"/><text x=\"{3}\" y=\"{4:.1f}\" "
          "text-anchor=\"end\">{5:g}</text>\n",
          kBorder, height(metres), width, kBorder - 5, height(metres) + 4, metres);
    }
    for (std::size_t k = 0; k < picture_.tracks.size(); ++k) {
      const auto all = errors(picture_.tracks[k].track);
      const std::size_t step = std::max<std::size_t>(1, all.size() / 1500);
      std::string points;
      for (std::size_t i = 0; i < all.size(); i += step)
        fmt::format_to(std::back_inserter(points), "{:.1f},{:.1f} ",
                       kBorder + width * (all[i].first - from) / span, height(all[i].second));
      svg_ += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"/>\n",
                          points, colour(k));
    }
    svg_ += fmt::format("<text x=\"{}\" y=\"{:.1f}\">position error, m, over {:.0f} s</text>\n", kBorder,
                        top + kChart + 20, span);
  }

  const TrackPicture& picture_;
  Eigen::AlignedBox2d box_;
  double scale_ = 1, height_ = 1;
  std::string svg_;
};

}  // namespace

std::string track_picture(const TrackPicture& picture) {
  return Drawing(picture).page();
}

}  // namespace waymark::exporters
