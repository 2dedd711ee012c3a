// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/hazard_style.hpp"

#include <fmt/format.h>

#include "planning/hazard_map.hpp"

namespace waymark::workflows {

std::string hazard_style() {
  struct Colour {
    double probability;
    const char *rgb, *label;
  };
  constexpr Colour colours[] = {{0, "#1a9641", "0"},
                                {0.05, "#a6d96a", "0.05"},
                                {0.2, "#ffffbf", "0.2"},
                                {0.5, "#fdae61", "0.5"},
                                {1, "#d7191c", "1"}};
  std::string items;
  for (const Colour& c : colours)
    items += fmt::format("          <item alpha=\"255\" value=\"{}\" color=\"{}\" label=\"{}\"/>\n",
                         c.probability, c.rgb, c.label);
  return fmt::format(R"(<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="{}" opacity="0.7" alphaBand="-1" nodataColor=""
                    classificationMin="0" classificationMax="1">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" minimumValue="0" maximumValue="1" clip="0">
{}        </colorrampshader>
      </rastershader>
    </rasterrenderer>
  </pipe>
</qgis>
)",
                     static_cast<int>(planning::HazardBand::probability) + 1, items);
}

}  // namespace waymark::workflows
