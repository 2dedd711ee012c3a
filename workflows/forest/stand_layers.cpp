// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "workflows/forest/stand_figures.hpp"

namespace waymark::workflows {
namespace {

using Kind = AttributeSpec::Kind;

AttributeValue number(double value) {
  return std::isfinite(value) ? AttributeValue(value) : AttributeValue();
}

/// A figure as a column: value times `factor` in `unit`.
struct FigureColumn {
  const char *name, *unit, *summary;
  double factor;
  pipeline::Estimate (*of)(const StandResult&);
};

// Of detected and undetected trees.
constexpr FigureColumn kFigures[] = {
    {"stems_per_ha", "1/ha", "Trees per hectare, undetected ones included", 1,
     [](const StandResult& r) { return r.complete.stems; }},
    {"basal_area_m2_per_ha", "m2/ha", "Stem cross-sections at 1.3 m per hectare", 1,
     [](const StandResult& r) { return r.complete.basal_area; }},
    {"volume_m3_per_ha", "m3/ha", "Stem volume per hectare", 1,
     [](const StandResult& r) { return r.complete.volume; }},
    {"biomass_t_per_ha", "t/ha", "Dry mass per hectare; NULL without a table that gives it", 1,
     [](const StandResult& r) { return r.complete.mass; }},
    {"lorey_height_m", "m", "Mean height weighted by basal area", 1,
     [](const StandResult& r) { return r.complete.lorey_height; }},
    {"dominant_height_m", "m", "Mean height of the 100 thickest per hectare", 1,
     [](const StandResult& r) { return r.complete.dominant_height; }},
    {"mean_height_m", "m", "Mean height", 1, [](const StandResult& r) { return r.complete.mean_height; }},
    {"quadratic_mean_diameter_cm", "cm", "Diameter of the tree of mean basal area", 100,
     [](const StandResult& r) { return r.complete.quadratic_mean_diameter; }},
    {"mean_diameter_cm", "cm", "Mean diameter", 100,
     [](const StandResult& r) { return r.complete.mean_diameter; }},
    {"cover", "", "Share of the ground under crowns, 0 to 1", 1,
     [](const StandResult& r) { return r.cover; }},
};

// Of detected trees only; their errors do not include the others.
constexpr FigureColumn kDetected[] = {
    {"stems_per_ha_detected", "1/ha", "Detected trees per hectare", 1,
     [](const StandResult& r) { return r.figures.stems; }},
    {"basal_area_m2_per_ha_detected", "m2/ha", "Stem cross-sections of detected trees", 1,
     [](const StandResult& r) { return r.figures.basal_area; }},
    {"volume_m3_per_ha_detected", "m3/ha", "Stem volume of detected trees", 1,
     [](const StandResult& r) { return r.figures.volume; }},
    {"lorey_height_m_detected", "m", "Mean height of detected trees, weighted by basal area", 1,
     [](const StandResult& r) { return r.figures.lorey_height; }},
};

std::string class_name(const pipeline::DiameterClass& c) {
  return fmt::format("stems_per_ha_d{:03.0f}", 100 * c.from);
}

std::vector<pipeline::DiameterClass> all_classes(const std::vector<StandResult>& results) {
  std::vector<pipeline::DiameterClass> all;
  for (const StandResult& result : results)
    if (result.complete.classes.size() > all.size()) all = result.complete.classes;
  return all;
}

/// Returns the bounds of at most five classes with about as many values each; empty if the values do not
/// differ.
std::vector<double> class_bounds(std::vector<double> values) {
  constexpr std::size_t kClasses = 5;
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  std::ranges::sort(values);
  std::vector<double> bounds;
  for (std::size_t i = 0; !values.empty() && i <= kClasses; ++i)
    if (const double bound = values[(values.size() - 1) * i / kClasses];
        bounds.empty() || bound > bounds.back())
      bounds.push_back(bound);
  return bounds.size() > 1 ? bounds : std::vector<double>();
}

void push(geodb::Shape& row, const pipeline::Estimate& estimate, double factor) {
  row.values.push_back(number(estimate.value * factor));
  row.values.push_back(number(estimate.se * factor));
}

}  // namespace

geodb::ShapeLayer stand_layer(const std::vector<StandResult>& results) {
  geodb::ShapeLayer layer{
      .name = "stand",
      .summary = "Stands with the figures of their trees",
      .kind = geodb::ShapeKind::polygon,
      .columns = {{"stand", "", Kind::text, "Name"},
                  {"species", "", Kind::text, "As the stands give it"},
                  {"area_ha", "ha", Kind::real, "Area"},
                  {"trees", "", Kind::integer, "Trees counted in it"},
                  {"trees_without_diameter", "", Kind::integer, "Of these: in stems and heights only"}},
      .style = {.colour = "#5d4037", .fill = "#a5d6a7", .width = 0.5, .label = "stand"}};
  for (const FigureColumn& figure : kFigures) {
    layer.columns.push_back({figure.name, figure.unit, Kind::real, figure.summary});
    layer.columns.push_back({std::string(figure.name) + "_se", figure.unit, Kind::real,
                             "Standard error of " + std::string(figure.name)});
  }
  for (const FigureColumn& figure : kDetected) {
    layer.columns.push_back({figure.name, figure.unit, Kind::real, figure.summary});
    layer.columns.push_back({std::string(figure.name) + "_se", figure.unit, Kind::real,
                             "Standard error of " + std::string(figure.name)});
  }
  const std::vector<pipeline::DiameterClass> classes = all_classes(results);
  for (const pipeline::DiameterClass& c : classes) {
    layer.columns.push_back(
        {class_name(c), "1/ha", Kind::real,
         fmt::format("Trees per hectare of {:.0f} to {:.0f} cm", 100 * c.from, 100 * c.to)});
    layer.columns.push_back(
        {class_name(c) + "_se", "1/ha", Kind::real, "Standard error of " + class_name(c)});
  }
  for (const StandResult& r : results) {
    geodb::Shape row{.parts = r.stand.outline, .values = {}};
    row.values = {r.stand.name, r.stand.species.empty() ? AttributeValue() : AttributeValue(r.stand.species),
                  number(r.figures.hectares), std::int64_t{r.figures.trees},
                  std::int64_t{r.figures.without_diameter}};
    for (const FigureColumn& figure : kFigures) push(row, figure.of(r), figure.factor);
    for (const FigureColumn& figure : kDetected) push(row, figure.of(r), figure.factor);
    for (std::size_t i = 0; i < classes.size(); ++i)
      push(row, i < r.complete.classes.size() ? r.complete.classes[i].stems : pipeline::Estimate{0, 0}, 1);
    layer.rows.push_back(std::move(row));
  }
  std::vector<double> volumes;
  for (const StandResult& r : results) volumes.push_back(r.complete.volume.value);
  layer.style.graduated = "volume_m3_per_ha";
  layer.style.classes = class_bounds(std::move(volumes));
  return layer;
}

geodb::ShapeLayer tree_layer(const StandBatches& stands, const StandTables& tables) {
  geodb::ShapeLayer layer{
      .name = "stand_tree",
      .summary = "Trees of the stands: a row for each stand a tree is counted in",
      .kind = geodb::ShapeKind::point,
      .columns = {{"stand", "", Kind::text, "Name of the stand"},
                  {"uid", "", Kind::text, "The tree in layer tree"},
                  {"height_m", "m", Kind::real, "Height"},
                  {"diameter_cm", "cm", Kind::real, "Stem diameter at 1.3 m"},
                  {"diameter_cm_se", "cm", Kind::real, "Its standard error"},
                  {"crown_diameter_m", "m", Kind::real, "Mean width of the crown"},
                  {"basal_area_m2", "m2", Kind::real, "Cross-section at 1.3 m"},
                  {"volume_m3", "m3", Kind::real, "Stem volume"},
                  {"biomass_kg", "kg", Kind::real, "Dry mass; NULL without a table that gives it"},
                  {"confidence", "", Kind::real, "Probability that it is a tree"}},
      .style = {.colour = "#2e7d32"}};
  layer.generator = [&](const auto& take) {
    stands.visit([&](const MapTrees& map, const NamedStand& stand) {
      const StandStems stems = stand_stems(map, stand, tables);
      for (const std::size_t member : pipeline::trees_in_stand(stems.trees, stand.polygon)) {
        const pipeline::StandTree& t = stems.trees[member];
        const std::size_t i = stems.near[member];
        const double crown = map.crowns[i].diameter;
        take({{{.outer = {t.position / map.unit}}},
              {stand.name, map.uids[i], number(t.height), number(100 * t.diameter),
               std::isnan(t.diameter) ? AttributeValue() : number(100 * t.diameter_sd),
               crown > 0 ? number(crown) : AttributeValue(),
               number(std::acos(-1.0) / 4 * t.diameter * t.diameter), number(t.volume), number(t.mass),
               t.confidence}});
      }
    });
  };
  return layer;
}

}  // namespace waymark::workflows
