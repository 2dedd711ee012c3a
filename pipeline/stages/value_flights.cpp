// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cmath>
#include <span>
#include <utility>

#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/forest/crown_names.hpp"
#include "pipeline/forest/crown_table.hpp"
#include "pipeline/fusion/valuation/landmark_valuation.hpp"
#include "pipeline/stages/valued_parts.hpp"

namespace waymark::pipeline {
namespace {

// Crown tables of tiles, which are read where they are needed.
class DrawnCrowns {
 public:
  using Reader = std::function<std::shared_ptr<const CrownTable>()>;

  // Reads each table once, for its extent.
  explicit DrawnCrowns(std::vector<Reader> tables) : tables_(std::move(tables)) {
    for (const Reader& read : tables_) {
      const auto table = read();
      Eigen::AlignedBox2d& extent = extents_.emplace_back();
      for (std::size_t row = 0; row < table->size(); ++row) extent.extend(table->top(row));
    }
  }

  // Returns the tables that may have crowns of these observations.
  std::vector<CrownTable> near(std::span<const Observation> observations) const {
    Eigen::AlignedBox2d wanted;
    for (const Observation& o : observations) wanted.extend(o.position.xyz.head<2>().eval());
    std::vector<CrownTable> tables;
    for (std::size_t i = 0; i < tables_.size(); ++i)
      if (extents_[i].intersects(wanted)) tables.push_back(*tables_[i]());
    return tables;
  }

 private:
  std::vector<Reader> tables_;
  std::vector<Eigen::AlignedBox2d> extents_;  // of the tops of each table
};

// A canopy model is a survey that could have shown a tree wherever the canopy's height is known.
struct ValueFlights {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr Stream<CrownTable> seen_crowns{"seen_crowns"};
  static constexpr Out<Parts<CrownTable>> crowns{"crowns"};

  static StageSpec spec() {
    return {.name = "value_flights",
            .summary =
                "Values trees by the canopy models that show them and that could have; assigns their crowns",
            .version = 5,
            .scope = Scope::map,
            .inputs = {canopies, ValuedParts::merged, ValuedParts::merged_evidence, seen_crowns},
            .outputs = {ValuedParts::landmarks, ValuedParts::evidence, ValuedParts::rejected, crowns}};
  }

  static void run(const Options&, StageContext& unit) {
    const TypeRegistry& types = unit.types();
    const Canopies& surveys = unit.read(canopies);
    const DrawnCrowns drawn(unit.readers(seen_crowns));
    PartsWriter<CrownTable> named(unit.make_scratch_file());
    ValuedParts::write(
        unit,
        [&](LandmarkList& all, ObservationList& seen) {
          value_landmarks(all, seen, {}, nullptr, types, 1);
          if (surveys.size() > 1) lower_confidence(all, surveys);
        },
        [&](double x, double y) { return surveys[0]->in_area(x, y); },
        [&](LandmarkList& all, ObservationList& seen) {
          named.add(name_crowns(drawn.near(seen), seen, all));
        });
    unit.write(crowns, named.parts());
  }

  // Of trees that some surveys should show but do not.
  static void lower_confidence(LandmarkList& all, const Canopies& surveys) {
    for (Landmark& landmark : all) {
      landmark.quality.visible = std::max(landmark.quality.seen, count_covering(surveys, landmark));
      landmark.confidence *= std::pow(kMissedFactor, landmark.quality.visible - landmark.quality.seen);
    }
  }

  // Factor on the confidence of a tree for each survey that should show it but does not.
  static constexpr double kMissedFactor = 0.7;

  static int count_covering(const Canopies& surveys, const Landmark& landmark) {
    int count = 0;
    for (const auto& canopy : surveys) {
      const Georeference& where = canopy->geometry().where;
      const Window cell{std::llround(where.column(landmark.position.xyz.x())),
                        std::llround(where.row(landmark.position.xyz.y())), 1, 1};
      count += canopy->read(cell)(0, 0) != kNoCanopy;
    }
    return count;
  }
};

}  // namespace

void register_stage_value_flights(Registry& registry);
void register_stage_value_flights(Registry& registry) {
  registry.add<ValueFlights>();
}

}  // namespace waymark::pipeline
