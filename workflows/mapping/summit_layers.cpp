// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/summit_layers.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "geodb/rtree/landmark_order.hpp"

namespace waymark::workflows {
namespace {

constexpr std::size_t kSummitsAtOnce = 100'000;

std::optional<std::size_t> find_attribute(const LandmarkType& type, std::string_view name) {
  const auto found = std::ranges::find(type.attributes, name, &AttributeSpec::name);
  if (found == type.attributes.end()) return {};
  return static_cast<std::size_t>(found - type.attributes.begin());
}

template <class T>
const T* attribute_of(const Landmark& landmark, std::size_t i) {
  return i < landmark.attributes.size() ? std::get_if<T>(&landmark.attributes[i]) : nullptr;
}

/// Attributes of a type with key saddles.
struct SaddleAttributes {
  std::size_t x = 0, y = 0, elevation = 0, parent = 0;
};

std::optional<SaddleAttributes> saddle_attributes(const LandmarkType& type) {
  const auto x = find_attribute(type, "saddle_x"), y = find_attribute(type, "saddle_y");
  const auto elevation = find_attribute(type, "saddle_elevation"),
             parent = find_attribute(type, "parent_uid");
  if (!x || !y || !elevation || !parent) return {};
  return SaddleAttributes{*x, *y, *elevation, *parent};
}

/// Positions of summits by a 64-bit hash of their uids: a strings' index would take four times the memory.
/// Two of a million summits share a hash with a probability of 3e-8.
class PositionIndex {
 public:
  void add(std::string_view uid, const Eigen::Vector2d& position) {
    entries_.push_back({std::hash<std::string_view>{}(uid), position.x(), position.y()});
  }
  void sort() { std::ranges::sort(entries_, {}, &Entry::key); }
  std::optional<Eigen::Vector2d> find(std::string_view uid) const {
    const std::uint64_t key = std::hash<std::string_view>{}(uid);
    const auto found = std::ranges::lower_bound(entries_, key, {}, &Entry::key);
    if (found == entries_.end() || found->key != key) return {};
    return Eigen::Vector2d(found->x, found->y);
  }

 private:
  struct Entry {
    std::uint64_t key = 0;
    double x = 0, y = 0;
  };
  std::vector<Entry> entries_;
};

/// The summits of one type, to be visited in the order of the map.
class Summits {
 public:
  Summits(const geodb::MapContents& contents, TypeId type, const SaddleAttributes& attributes)
      : type_(type), attributes_(attributes) {
    contents_.types = contents.types;
    contents_.crs = contents.crs;
    contents_.parts = contents.parts;
    std::ranges::copy_if(contents.landmarks, std::back_inserter(contents_.landmarks),
                         [&](const Landmark& l) { return l.type == type; });
    visit_unordered([&](const Landmark& summit) {
      const Eigen::Vector2d position = summit.position.xyz.head<2>();
      extent_.add(position.x(), position.y());
      positions_.add(summit.uid, position);
      has_saddles_ = has_saddles_ || saddle(summit);
    });
    positions_.sort();
    if (has_saddles_)
      visit_unordered([&](const Landmark& summit) { has_parents_ = has_parents_ || parent(summit); });
  }

  bool has_saddles() const { return has_saddles_; }
  bool has_parents() const { return has_parents_; }

  std::optional<Eigen::Vector2d> saddle(const Landmark& summit) const {
    const double* x = attribute_of<double>(summit, attributes_.x);
    const double* y = attribute_of<double>(summit, attributes_.y);
    return x && y ? std::optional(Eigen::Vector2d(*x, *y)) : std::nullopt;
  }
  AttributeValue saddle_elevation(const Landmark& summit) const {
    const double* height = attribute_of<double>(summit, attributes_.elevation);
    return height ? AttributeValue(*height) : AttributeValue();
  }
  /// Returns the position of the parent, or `std::nullopt` if it is not in the map.
  std::optional<Eigen::Vector2d> parent(const Landmark& summit) const {
    const std::string* uid = parent_uid(summit);
    return uid ? positions_.find(*uid) : std::nullopt;
  }
  const std::string* parent_uid(const Landmark& summit) const {
    return attribute_of<std::string>(summit, attributes_.parent);
  }

  void visit(const std::function<void(const Landmark&)>& take) const {
    const geodb::LandmarkOrder order(contents_, type_, extent_, kSummitsAtOnce);
    order.visit([&](const Landmark& summit, std::int64_t) { take(summit); });
  }

 private:
  void visit_unordered(const auto& take) const {
    for (const Landmark& summit : contents_.landmarks) take(summit);
    for (std::size_t part = 0; part < contents_.parts.count; ++part) {
      const auto landmarks = contents_.parts.landmarks(part);
      for (const Landmark& summit : *landmarks)
        if (summit.type == type_) take(summit);
    }
  }

  geodb::MapContents contents_;
  TypeId type_;
  SaddleAttributes attributes_;
  geodb::Envelope extent_;
  PositionIndex positions_;
  bool has_saddles_ = false, has_parents_ = false;
};

geodb::ShapeLayer saddle_layer(std::shared_ptr<const Summits> summits) {
  using Kind = AttributeSpec::Kind;
  return {.name = "saddle",
          .summary = "Key saddles: the lowest point on the highest path from a summit to higher terrain",
          .kind = geodb::ShapeKind::point,
          .columns = {{"uid", "", Kind::text, "The summit, in layer mountain_top"},
                      {"elevation", "m", Kind::real, "Elevation of the saddle"}},
          .style = {.colour = "#8d6e63"},
          .generator = [summits](const auto& take) {
            summits->visit([&](const Landmark& summit) {
              if (const auto saddle = summits->saddle(summit))
                take({{{.outer = {*saddle}}}, {summit.uid, summits->saddle_elevation(summit)}});
            });
          }};
}

geodb::ShapeLayer parent_layer(std::shared_ptr<const Summits> summits) {
  using Kind = AttributeSpec::Kind;
  return {.name = "parent_line",
          .summary = "Lines from summits to their parents, the summits beyond their key saddles",
          .kind = geodb::ShapeKind::line,
          .columns = {{"uid", "", Kind::text, "The summit, in layer mountain_top"},
                      {"parent_uid", "", Kind::text, "Its parent"}},
          .style = {.colour = "#a1887f", .width = 0.15},
          .generator = [summits](const auto& take) {
            summits->visit([&](const Landmark& summit) {
              if (const auto parent = summits->parent(summit))
                take({{{.outer = {summit.position.xyz.head<2>(), *parent}}},
                      {summit.uid, *summits->parent_uid(summit)}});
            });
          }};
}

}  // namespace

std::vector<geodb::ShapeLayer> summit_layers(const geodb::MapContents& contents) {
  std::vector<geodb::ShapeLayer> layers;
  for (TypeId type = 0; type < contents.types.size(); ++type) {
    const auto attributes = saddle_attributes(contents.types[type]);
    if (!attributes) continue;
    const auto summits = std::make_shared<const Summits>(contents, type, *attributes);
    if (!summits->has_saddles()) continue;
    layers.push_back(saddle_layer(summits));
    if (summits->has_parents()) layers.push_back(parent_layer(summits));
    break;
  }
  return layers;
}

}  // namespace waymark::workflows
