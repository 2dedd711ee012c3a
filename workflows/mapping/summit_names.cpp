// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/summit_names.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "geodb/rtree/search_windows.hpp"

namespace waymark::workflows {
namespace {

/// A mountain top and a place near it.
struct NamePair {
  double distance = 0, prominence = 0;
  std::string uid;
  std::size_t place = 0;
};

/// Finds the places about a position.
class PlaceSearch {
 public:
  PlaceSearch(const Crs& crs, const importers::PlaceNames& names)
      : crs_(crs), distance_(crs), names_(&names), places_(names.places) {
    std::ranges::stable_sort(places_, {}, &importers::PlaceName::y);
  }

  void visit(double x, double y, const std::function<void(std::size_t place, double distance)>& take) const {
    const geodb::MapQuery::Near near{x, y, Meters{names_->max_distance}};
    for (const geodb::MapQuery::Box& box : geodb::search_windows(crs_, near))
      for (auto place = std::ranges::lower_bound(places_, box.min_y, {}, &importers::PlaceName::y);
           place != places_.end() && place->y <= box.max_y; ++place) {
        if (place->x < box.min_x || place->x > box.max_x) continue;
        const double apart = distance_(x, y, place->x, place->y);
        if (apart <= names_->max_distance) take(static_cast<std::size_t>(place - places_.begin()), apart);
      }
  }

  const std::string& name(std::size_t place) const { return places_[place].name; }

 private:
  Crs crs_;
  geodb::MapDistance distance_;
  const importers::PlaceNames* names_;
  std::vector<importers::PlaceName> places_;  ///< by y
};

std::unordered_map<std::string, std::string> pair_names(const geodb::MapContents& contents, TypeId type,
                                                        const importers::PlaceNames& names) {
  const PlaceSearch places(contents.crs, names);
  const std::size_t prominence = feature_index(contents.types[type], "prominence");
  std::vector<NamePair> pairs;
  const auto add = [&](const Landmark& top) {
    if (top.type != type) return;
    const double rank = top.features[prominence].known() ? top.features[prominence].value : 0;
    places.visit(top.position.xyz.x(), top.position.xyz.y(), [&](std::size_t place, double distance) {
      pairs.push_back({distance, rank, top.uid, place});
    });
  };
  for (const Landmark& top : contents.landmarks) add(top);
  for (std::size_t part = 0; part < contents.parts.count; ++part) {
    const auto tops = contents.parts.landmarks(part);
    for (const Landmark& top : *tops) add(top);
  }
  std::ranges::sort(pairs, [](const NamePair& a, const NamePair& b) {
    return std::tuple(a.distance, -a.prominence, std::string_view(a.uid), a.place) <
           std::tuple(b.distance, -b.prominence, std::string_view(b.uid), b.place);
  });
  std::unordered_map<std::string, std::string> name_of;
  std::vector<char> used(names.places.size());
  for (const NamePair& pair : pairs)
    if (!used[pair.place] && name_of.try_emplace(pair.uid, places.name(pair.place)).second)
      used[pair.place] = 1;
  return name_of;
}

// Returns the type whose landmarks have a prominence and a name.
std::optional<TypeId> type_with_name(const TypeRegistry& types) {
  for (TypeId type = 0; type < types.size(); ++type)
    if (std::ranges::count(types[type].attributes, "name", &AttributeSpec::name) > 0 &&
        std::ranges::count(types[type].features, "prominence", &FeatureSpec::name) > 0)
      return type;
  return {};
}

}  // namespace

void name_summits(geodb::MapContents& contents, const importers::PlaceNames& names) {
  const std::optional<TypeId> type_found = type_with_name(contents.types);
  if (names.places.empty() || !type_found) return;
  const TypeId type = *type_found;
  const std::size_t attribute = attribute_index(contents.types[type], "name");
  const auto name_of =
      std::make_shared<const std::unordered_map<std::string, std::string>>(pair_names(contents, type, names));
  const auto set_name = [name_of, type, attribute](Landmark& top) {
    if (top.type != type) return;
    if (const auto found = name_of->find(top.uid); found != name_of->end())
      top.attributes[attribute] = found->second;
  };
  for (Landmark& top : contents.landmarks) set_name(top);
  if (contents.parts.count == 0) return;
  contents.parts.landmarks = [set_name, read = contents.parts.landmarks](std::size_t part) {
    auto named = std::make_shared<std::vector<Landmark>>(*read(part));
    for (Landmark& top : *named) set_name(top);
    return std::shared_ptr<const std::vector<Landmark>>(std::move(named));
  };
}

}  // namespace waymark::workflows
