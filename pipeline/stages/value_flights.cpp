// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <set>

#include "landmarks/landmark_type.hpp"
#include "landmarks/uid_index.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/forest/crown_table.hpp"
#include "pipeline/forest/find_trees.hpp"
#include "pipeline/fusion/detection_codec.hpp"
#include "pipeline/fusion/image_view_codec.hpp"
#include "pipeline/fusion/landmark_codec.hpp"
#include "pipeline/fusion/valuing.hpp"

namespace waymark {
namespace {

// A canopy model is a survey: it could have shown a tree where it knows the canopy's height.
struct ValueFlights {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr In<std::vector<Landmark>> merged{"merged"};
  static constexpr In<std::vector<Observation>> merged_evidence{"merged_evidence"};
  static constexpr In<CrownTable> seen_crowns{"seen_crowns"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr Out<std::vector<Observation>> evidence{"evidence"};
  static constexpr Out<CrownTable> crowns{"crowns"};
  static constexpr Out<std::vector<ImageView>> image_views{"image_views"};

  static StageSpec spec() {
    return {.name = "value_flights",
            .summary =
                "Values trees: how many canopy models show them of how many could have; names their crowns",
            .version = 4,
            .scope = Scope::map,
            .inputs = {canopies, merged, merged_evidence, seen_crowns},
            .outputs = {landmarks, evidence, crowns, image_views}};
  }

  static void run(const Options&, StageContext& unit) {
    TypeRegistry types;
    register_landmark_types(types);
    std::vector<Landmark> all = unit.take(merged);
    std::vector<Observation> seen = unit.take(merged_evidence);
    value_landmarks(all, seen, {}, nullptr, types, 1);
    const Canopies& surveys = unit.read(canopies);
    if (surveys.size() > 1) {
      for (Landmark& landmark : all) {
        landmark.quality.visible = std::max(landmark.quality.seen, covering(surveys, landmark));
        const int missed = landmark.quality.visible - landmark.quality.seen;
        landmark.confidence *= std::pow(kDoubtWhenMissed, missed);
      }
    }
    std::vector<ImageView> views;
    for (const auto& canopy : surveys) views.push_back(view_of(*canopy));
    unit.write(image_views, std::move(views));
    unit.write(crowns, named(unit.take_all(seen_crowns), seen, all));
    unit.count_out(static_cast<std::int64_t>(all.size()));
    unit.write(landmarks, std::move(all));
    unit.write(evidence, std::move(seen));
  }

  // A survey that should show a tree and does not takes this share of its confidence.
  static constexpr double kDoubtWhenMissed = 0.7;

  static int covering(const Canopies& surveys, const Landmark& landmark) {
    int count = 0;
    for (const auto& canopy : surveys) {
      const Georeference& where = canopy->geometry().where;
      const Window cell{std::llround(where.column(landmark.position.xyz.x())),
                        std::llround(where.row(landmark.position.xyz.y())), 1, 1};
      count += canopy->read(cell)(0, 0) != kNoCanopy;
    }
    return count;
  }

  // A canopy model is an orthophoto of heights: evidence names its pixels.
  static ImageView view_of(const CanopySource& canopy) {
    const GridGeometry& grid = canopy.geometry();
    const Georeference& where = grid.where;
    const double unit = where.crs.metres_per_unit();
    ImageView view;
    view.name = canopy.name();
    view.columns = grid.columns, view.rows = grid.rows;
    view.ortho = OrthoGrid{where.x0 * unit, where.y0 * unit, where.dx * unit, where.dy * unit};
    const double west = where.x(-0.5), east = where.x(static_cast<double>(grid.columns) - 0.5);
    const double north = where.y(-0.5), south = where.y(static_cast<double>(grid.rows) - 0.5);
    view.footprint = {{{west, south}, {east, south}, {east, north}, {west, north}, {west, south}}};
    const double cell = std::abs(where.dx * where.dy) * unit * unit;
    view.area = cell * static_cast<double>(grid.cells());
    view.gsd = std::sqrt(cell);
    return view;
  }

  // One crown per tree: of the first survey by name that shows it.
  static CrownTable named(std::vector<CrownTable> parts, const std::vector<Observation>& seen,
                          const std::vector<Landmark>& all) {
    struct Place {
      double x = 0, y = 0;
      std::uint32_t part = 0, row = 0;
    };
    std::map<std::string_view, std::vector<Place>> of_source;
    for (std::uint32_t part = 0; part < parts.size(); ++part)
      for (std::uint32_t row = 0; row < parts[part].size(); ++row) {
        const Eigen::Vector2d top = parts[part].top(row);
        of_source[parts[part].source(row)].push_back({top.x(), top.y(), part, row});
      }
    const auto by_place = [](const Place& place) { return std::pair(place.x, place.y); };
    for (auto& [_, places] : of_source) std::ranges::sort(places, {}, by_place);
    const UidIndex index(all);
    std::vector<const Place*> of_tree(all.size());
    for (const Observation& o : seen) {  // by source, then place: the first survey by name comes first
      if (!o.rejected.empty() || o.landmark_uid.empty()) continue;
      const auto tree = index.find(o.landmark_uid);
      const auto places = of_source.find(o.source);
      if (!tree || of_tree[*tree] || places == of_source.end()) continue;
      const std::pair at(o.position.xyz.x(), o.position.xyz.y());
      const auto place = std::ranges::lower_bound(places->second, at, {}, by_place);
      if (place != places->second.end() && by_place(*place) == at) of_tree[*tree] = &*place;
    }
    CrownTable crowns;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (const Place* place = of_tree[i]; place && parts[place->part].drawn(place->row))
        crowns.add(parts[place->part], place->row, all[i].uid);
    crowns.close();
    return crowns;
  }
};

}  // namespace

void register_stage_value_flights(Registry& registry);
void register_stage_value_flights(Registry& registry) {
  registry.add<ValueFlights>();
}

}  // namespace waymark
