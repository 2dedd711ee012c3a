// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/raster_style.hpp"

#include <fmt/format.h>

namespace waymark::workflows {

std::string raster_style(const RasterStyle& style) {
  std::string items;
  for (const RasterStyle::Colour& c : style.colours)
    items += fmt::format("          <item alpha=\"255\" value=\"{}\" color=\"{}\" label=\"{}\"/>\n", c.value,
                         c.rgb, c.label);
  return fmt::format(R"(<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="{0}" opacity="0.7" alphaBand="-1" nodataColor=""
                    classificationMin="{1}" classificationMax="{2}">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" minimumValue="{1}" maximumValue="{2}" clip="0">
{3}        </colorrampshader>
      </rastershader>
    </rasterrenderer>
  </pipe>
</qgis>
)",
                     style.band, style.colours.front().value, style.colours.back().value, items);
}

}  // namespace waymark::workflows
