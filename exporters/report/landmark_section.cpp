// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/landmark_section.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/landmark.hpp"
#include "exporters/vector/export_columns.hpp"
#include "geodb/map_store.hpp"

namespace waymark::exporters {
namespace {

struct Ranked {
  double rank = 0;
  Landmark landmark;

  bool operator<(const Ranked& other) const {
    return rank != other.rank ? rank > other.rank : landmark.uid < other.landmark.uid;
  }
};

/// Keeps the foremost landmarks; holds up to twice as many.
class Foremost {
 public:
  explicit Foremost(std::size_t limit) : limit_(std::max<std::size_t>(limit, 1)) {}

  void add(double rank, Landmark&& landmark) {
    found_.push_back(
        {std::isnan(rank) ? -std::numeric_limits<double>::infinity() : rank, std::move(landmark)});
    if (found_.size() >= 2 * limit_) prune();
  }

  std::vector<Landmark> take() {
    prune();
    std::vector<Landmark> landmarks;
    landmarks.reserve(found_.size());
    for (Ranked& one : found_) landmarks.push_back(std::move(one.landmark));
    return landmarks;
  }

 private:
  void prune() {
    std::ranges::sort(found_, std::less{});
    if (found_.size() > limit_)
      found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(limit_), found_.end());
  }

  std::size_t limit_;
  std::vector<Ranked> found_;
};

void add_observed(ObservationMeans& means, const Landmark& landmark) {
  const Quality& quality = landmark.quality;
  means.several += quality.seen > 1;
  means.seen.add(quality.seen);
  means.visible.add(quality.visible);
  means.multiplicity.add(multiplicity_confidence(quality.seen, quality.visible));
  for (const auto& confidence : quality.feature_confidences) means.spread.add(confidence);
  means.quality.add(equal_weight_quality(landmark));
  means.confidence.add(landmark.confidence);
}

}  // namespace

void Mean::add(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return;
  sum_ += *value;
  ++count_;
}

std::optional<double> Mean::value() const {
  return count_ > 0 ? std::optional(sum_ / static_cast<double>(count_)) : std::nullopt;
}

LandmarkSection landmark_section(const LandmarkType& type, const LandmarkVisit& visit,
                                 std::size_t max_ranked) {
  LandmarkSection section{.type = type, .values = std::vector<std::vector<double>>(type.features.size())};
  Foremost foremost(max_ranked);
  const bool sized = find_feature(type, type.size_feature).has_value();
  visit([&](Landmark&& landmark) {
    ++section.count;
    const double x = landmark.position.xyz.x(), y = landmark.position.xyz.y();
    const auto extend = [y](std::optional<Extent>& extent, double at) {
      extent = extent ? extent->united({at, y, at, y}) : Extent{at, y, at, y};
    };
    extend(section.extent, x);
    extend(section.eastern_extent, x - 360 * std::floor(x / 360));
    for (std::size_t i = 0; i < section.values.size(); ++i)
      if (const double value = value_of(landmark, i); std::isfinite(value))
        section.values[i].push_back(value);
    add_observed(section.observed, landmark);
    const double rank = sized ? certified_value(type, landmark, type.size_feature) : landmark.confidence;
    foremost.add(rank, std::move(landmark));
  });
  section.landmarks = foremost.take();
  return section;
}

std::vector<LandmarkSection> landmark_sections(const geodb::MapStore& map, std::size_t max_ranked) {
  std::vector<LandmarkSection> sections;
  for (const LandmarkType& type : map.types())
    sections.push_back(landmark_section(
        type, [&](const auto& take) { map.visit(type.name, take); },
        std::max(max_ranked, LandmarkSection::kMaxRanked)));
  return sections;
}

std::optional<std::size_t> find_feature(const LandmarkType& type, const std::string& name) {
  for (std::size_t i = 0; i < type.features.size(); ++i)
    if (type.features[i].name == name) return i;
  return {};
}

double value_of(const Landmark& landmark, std::optional<std::size_t> feature) {
  const bool known = feature && *feature < landmark.features.size() && landmark.features[*feature].known();
  return known ? landmark.features[*feature].value : std::numeric_limits<double>::quiet_NaN();
}

std::optional<std::size_t> lower_bound_of(const LandmarkType& type, const std::string& feature) {
  for (std::size_t i = 0; i < type.attributes.size(); ++i)
    if (type.attributes[i].name == feature + "_low") return i;
  return {};
}

double certified_value(const LandmarkType& type, const Landmark& landmark, const std::string& feature) {
  const double value = value_of(landmark, find_feature(type, feature));
  const auto bound = lower_bound_of(type, feature);
  const double* low = bound && *bound < landmark.attributes.size()
                          ? std::get_if<double>(&landmark.attributes[*bound])
                          : nullptr;
  return low != nullptr && *low < value ? *low : value;
}

}  // namespace waymark::exporters
