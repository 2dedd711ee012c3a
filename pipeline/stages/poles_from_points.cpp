// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "pipeline/buildings/building_landmarks.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/valuation/area_filter.hpp"
#include "pipeline/stages/one_survey.hpp"

namespace waymark::pipeline {
namespace {

struct PolesFromPoints {
  struct Options {
    PoleRules poles;
    double min_density = 15;
    Meters min_height{2.5}, max_width{0.8}, clearance{1}, survey_sd{0.1};

    void describe(OptionVisitor& option) {
      option("min_density", min_density,
             {.help = "First returns per m2 below which no poles are searched, with a warning",
              .min = 0,
              .max = 1000});
      option("min_pole_height", min_height, {.help = "Lowest pole kept", .min = 1.5, .max = 40});
      option("max_width", max_width, {.help = "Widest pole, with its lamp", .min = 0.2, .max = 3});
      option("clearance", clearance,
             {.help = "Distance from a pole to all else that is higher than 1 m", .min = 0.3, .max = 5});
      option("min_returns", poles.min_returns, {.help = "Fewest returns of a pole", .min = 3, .max = 1000});
      option("pole_survey_sd", survey_sd,
             {.help = "Horizontal standard deviation of the survey as a whole", .min = 0, .max = 10});
    }
  };
  static constexpr In<Canopies> canopies{"canopies"};
  static constexpr Out<std::vector<Landmark>> landmarks{"landmarks"};
  static constexpr Out<std::vector<Observation>> evidence{"evidence"};

  static StageSpec spec() {
    return {.name = "poles_from_points",
            .summary = "Finds poles in airborne laser points where their density allows it",
            .version = 1,
            .scope = Scope::tile,
            .inputs = {canopies},
            .outputs = {landmarks, evidence},
            .finds = {"pole"}};
  }

  static void check_inputs(const Options&, StageContext& unit) {
    if (unit.has(canopies)) require_one_survey(unit.read(canopies), "poles_from_points");
  }

  static void run(const Options& options, StageContext& unit) {
    const CanopySource& canopy = *unit.read(canopies).at(0);
    const double density = canopy.point_density();
    FoundPoles found;
    if (density >= options.min_density) {
      PoleRules rules = options.poles;
      rules.min_height = options.min_height.value, rules.max_width = options.max_width.value;
      rules.clearance = options.clearance.value;
      const Georeference& where = canopy.geometry().where;
      found = find_poles(canopy, tile_window(canopy.geometry(), canopy.geometry(), unit.tile().cells), rules);
      const auto outside = std::erase_if(found.poles, [&](const DetectedPole& p) {
        const Eigen::Vector2d at = p.at / where.crs.metres_per_unit();
        return !canopy.in_area(where.x0 + at.x(), where.y0 + at.y());
      });
      if (outside > 0) found.rejected[std::string(kOutsideArea)] += static_cast<std::int64_t>(outside);
    } else if (unit.tile().index == 0) {
      unit.warn(warning(density, options.min_density));
    }
    std::int64_t rejected = 0;
    for (const auto& [reason, count] : found.rejected) unit.reject(reason, count), rejected += count;
    unit.count_in(std::ssize(found.poles) + rejected);
    unit.count_out(std::ssize(found.poles));
    BuildingLandmarks made = pole_landmarks(found.poles, canopy, unit.types(), options.survey_sd.value);
    unit.write(landmarks, std::move(made.landmarks));
    unit.write(evidence, std::move(made.evidence));
  }

  static std::string warning(double density, double min_density) {
    if (!(density > 0))
      return "no poles are searched: a raster has one height per cell, and poles need laser points";
    return fmt::format(
        "no poles are searched: {:.2g} first returns per m2 are too few, since a pole of 0.15 m needs {:g} "
        "(--min-density)",
        density, min_density);
  }
};

}  // namespace

void register_stage_poles_from_points(Registry& registry);
void register_stage_poles_from_points(Registry& registry) {
  registry.add<PolesFromPoints>();
}

}  // namespace waymark::pipeline
