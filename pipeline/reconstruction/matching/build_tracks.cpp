// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/build_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace waymark::pipeline {
namespace {

// Places of all images, numbered through; features at one pixel share a place.
struct Places {
  std::vector<std::vector<std::size_t>> of_feature;  // by image
  std::vector<std::size_t> image;                    // by place
  std::vector<std::uint32_t> feature;                // by place: the first there
};

Places number_places(std::span<const ImageFeatures> images) {
  Places out;
  for (std::size_t i = 0; i < images.size(); ++i) {
    std::map<std::pair<double, double>, std::size_t> known;
    std::vector<std::size_t>& places = out.of_feature.emplace_back();
    for (std::size_t f = 0; f < images[i].features.size(); ++f) {
      const Eigen::Vector2d& pixel = images[i].features[f].pixel;
      const auto [at, is_new] = known.try_emplace({pixel.x(), pixel.y()}, out.image.size());
      if (is_new) {
        out.image.push_back(i);
        out.feature.push_back(static_cast<std::uint32_t>(f));
      }
      places.push_back(at->second);
    }
  }
  return out;
}

// Sets of places with at most one place per image.
class PlaceSets {
 public:
  explicit PlaceSets(const Places& places)
      : parent_(places.image.size()), members_(places.image.size()), places_(places) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    for (std::size_t i = 0; i < members_.size(); ++i) members_[i] = {i};
  }

  std::size_t root(std::size_t place) {
    while (parent_[place] != place) place = parent_[place] = parent_[parent_[place]];
    return place;
  }

  bool join(std::size_t a, std::size_t b) {
    a = root(a), b = root(b);
    if (a == b) return true;
    std::vector<std::size_t> both;
    std::ranges::merge(members_[a], members_[b], std::back_inserter(both));
    for (std::size_t i = 1; i < both.size(); ++i)  // places are numbered by image
      if (places_.image[both[i - 1]] == places_.image[both[i]]) return false;
    const std::size_t keep = std::min(a, b), drop = std::max(a, b);
    parent_[drop] = keep;
    members_[keep] = std::move(both);
    members_[drop].clear();
    return true;
  }

  const std::vector<std::size_t>& members(std::size_t place) const { return members_[place]; }

 private:
  std::vector<std::size_t> parent_;
  std::vector<std::vector<std::size_t>> members_;  // of roots, sorted
  const Places& places_;
};

}  // namespace

double mark_sd(double scale) {
  return std::hypot(0.3, 0.12 * scale);
}

Tracks build_tracks(std::span<const ImageFeatures> images, std::span<const VerifiedPair> pairs) {
  const Places places = number_places(images);
  PlaceSets sets(places);
  std::vector<const VerifiedPair*> order;
  for (const VerifiedPair& pair : pairs) order.push_back(&pair);
  std::ranges::sort(order, {}, [](const VerifiedPair* p) {
    return std::tuple(-static_cast<std::int64_t>(p->matches.size()), p->images.first, p->images.second);
  });
  Tracks out;
  for (const VerifiedPair* pair : order)
    for (const Match& m : pair->matches)
      if (!sets.join(places.of_feature[pair->images.first][m.first],
                     places.of_feature[pair->images.second][m.second]))
        ++out.conflicts;
  for (std::size_t place = 0; place < places.image.size(); ++place) {
    const std::vector<std::size_t>& members = sets.members(place);
    if (sets.root(place) != place || members.size() < 2) continue;
    TiePoint point;
    for (const std::size_t m : members) {
      const Feature& feature = images[places.image[m]].features[places.feature[m]];
      point.marks.push_back({.image = places.image[m], .pixel = feature.pixel, .sd = mark_sd(feature.scale)});
    }
    out.points.push_back(std::move(point));
  }
  return out;
}

}  // namespace waymark::pipeline
