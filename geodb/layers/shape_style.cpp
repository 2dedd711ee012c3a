// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "geodb/layers/qml_colour.hpp"
#include "geodb/layers/shape_table.hpp"

namespace waymark::geodb {
namespace {

std::string option(const char* name, const std::string& value) {
  return fmt::format(R"(            <Option name="{}" value="{}" type="QString"/>)"
                     "\n",
                     name, value);
}

struct Symbol {
  const char *type, *layer;
  std::string options;
};

Symbol symbol_of(const ShapeLayer& layer) {
  const ShapeStyle& s = layer.style;
  const std::string width = fmt::format("{}", s.width), line = qml_colour(s.colour);
  switch (layer.kind) {
    case ShapeKind::point:
      return {"marker", "SimpleMarker",
              option("name", "circle") + option("color", line) + option("outline_color", "255,255,255,255") +
                  option("outline_width", "0.2") + option("size", "2.4") + option("size_unit", "MM")};
    case ShapeKind::line:
      return {"line", "SimpleLine",
              option("line_color", line) + option("line_width", width) + option("line_width_unit", "MM") +
                  option("joinstyle", "round")};
    case ShapeKind::polygon:
      break;
  }
  return {
      "fill", "SimpleFill",
      option("color", qml_colour(s.fill.empty() ? s.colour : s.fill, s.fill.empty() ? 0 : s.fill_opacity)) +
          option("style", s.fill.empty() ? "no" : "solid") + option("outline_color", line) +
          option("outline_width", width) + option("outline_width_unit", "MM")};
}

std::string labels(const ShapeLayer& layer) {
  if (layer.style.label.empty()) return "";
  return fmt::format(R"(  <labeling type="simple">
    <settings calloutType="simple">
      <text-style fieldName="{}" isExpression="0" fontFamily="Sans" namedStyle="Regular" fontSize="9" fontSizeUnit="Point" textColor="40,40,40,255" textOpacity="1">
        <text-buffer bufferDraw="1" bufferSize="0.8" bufferSizeUnits="MM" bufferColor="255,255,255,255" bufferOpacity="0.85" bufferNoFill="1"/>
      </text-style>
      <placement placement="{}" dist="1" distUnits="MM" priority="5"/>
      <rendering drawLabels="1" obstacle="1" displayAll="0" scaleVisibility="0"/>
    </settings>
  </labeling>
)",
                     layer.style.label,
                     layer.kind == ShapeKind::line    ? 2
                     : layer.kind == ShapeKind::point ? 6
                                                      : 0);
}

/// Mixes white and a colour "#rrggbb": 0 is nearly white, 1 the colour.
std::string shade(const std::string& colour, double fraction) {
  unsigned value = 0x888888;
  if (colour.size() == 7) std::from_chars(colour.data() + 1, colour.data() + 7, value, 16);
  const auto mix = [&](unsigned shift) {
    const double full = value >> shift & 255;
    return static_cast<unsigned>(std::lround(245 + (full - 245) * fraction));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", mix(16), mix(8), mix(0));
}

std::string qml_symbol_of(const ShapeLayer& layer, const std::string& name) {
  const Symbol symbol = symbol_of(layer);
  return fmt::format(R"(      <symbol type="{}" name="{}" alpha="1" clip_to_extent="1" force_rhr="0">
        <layer class="{}" enabled="1" locked="0" pass="0">
          <Option type="Map">
{}          </Option>
        </layer>
      </symbol>
)",
                     symbol.type, name, symbol.layer, symbol.options);
}

/// Returns the renderer: one symbol, or a class of shades for each interval of the graduated column.
std::string renderer(const ShapeLayer& layer) {
  const std::vector<double>& bounds = layer.style.classes;
  if (layer.style.graduated.empty() || bounds.size() < 2)
    return "  <renderer-v2 type=\"singleSymbol\" forceraster=\"0\" symbollevels=\"0\" enableorderby=\"0\">\n"
           "    <symbols>\n" +
           qml_symbol_of(layer, "0") + "    </symbols>\n  </renderer-v2>\n";
  std::string ranges, symbols;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    ShapeLayer one{.name = layer.name, .summary = {}, .kind = layer.kind, .style = layer.style};
    one.style.fill =
        shade(layer.style.fill, static_cast<double>(i + 1) / static_cast<double>(bounds.size() - 1));
    one.style.fill_opacity = 0.8;
    symbols += qml_symbol_of(one, std::to_string(i));
    ranges += fmt::format(
        "      <range symbol=\"{0}\" lower=\"{1}\" upper=\"{2}\" label=\"{1:.4g} to {2:.4g}\" "
        "render=\"true\"/>\n",
        i, bounds[i], bounds[i + 1]);
  }
  return fmt::format(
      "  <renderer-v2 type=\"graduatedSymbol\" attr=\"{}\" graduatedMethod=\"GraduatedColor\" "
      "forceraster=\"0\" "
      "symbollevels=\"0\" enableorderby=\"0\">\n    <ranges>\n{}    </ranges>\n    <symbols>\n{}    "
      "</symbols>\n"
      "  </renderer-v2>\n",
      layer.style.graduated, ranges, symbols);
}

/// Returns the unit as names of columns spell it, e.g. "_m3_per_ha".
std::string unit_in_names(const std::string& unit) {
  const std::size_t slash = unit.find('/');
  if (slash == std::string::npos) return "_" + unit;
  return (unit.substr(0, slash) == "1" ? "" : "_" + unit.substr(0, slash)) + "_per_" + unit.substr(slash + 1);
}

/// Returns the heading of a column: "Volume, standard error (m3/ha)" of volume_m3_per_ha_se.
std::string column_title(const AttributeSpec& column) {
  std::string title = column.name;
  if (!column.unit.empty()) {
    const std::string unit = unit_in_names(column.unit);
    const std::size_t at = title.find(unit), end = at + unit.size();
    if (at != std::string::npos && at > 0 && (end == title.size() || title[end] == '_'))
      title.erase(at, unit.size());
  }
  if (title.ends_with("_se")) title.replace(title.size() - 3, 3, ", standard error");
  std::ranges::replace(title, '_', ' ');
  if (title[0] >= 'a' && title[0] <= 'z') title[0] = static_cast<char>(title[0] - 'a' + 'A');
  return column.unit.empty() ? title : title + " (" + column.unit + ")";
}

std::string aliases(const ShapeLayer& layer) {
  std::string lines = "  <aliases>\n    <alias index=\"0\" field=\"id\" name=\"Row\"/>\n";
  for (std::size_t i = 0; i < layer.columns.size(); ++i)
    lines += fmt::format("    <alias index=\"{}\" field=\"{}\" name=\"{}\"/>\n", i + 1, layer.columns[i].name,
                         column_title(layer.columns[i]));
  lines += "  </aliases>\n";
  const std::string& shown = !layer.style.label.empty() ? layer.style.label
                             : layer.columns.empty()    ? layer.style.label
                                                        : layer.columns[0].name;
  if (!shown.empty())
    lines += fmt::format("  <previewExpression>&quot;{}&quot;</previewExpression>\n", shown);
  return lines;
}

}  // namespace

std::string qml_shape_style(const ShapeLayer& layer) {
  const int geometry = layer.kind == ShapeKind::point ? 0 : layer.kind == ShapeKind::line ? 1 : 2;
  return fmt::format(
      "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
      "<qgis version=\"3.22\" "
      "styleCategories=\"Symbology|Labeling|Fields|Forms|LayerConfiguration\"{}>\n{}{}{}"
      "  <layerGeometryType>{}</layerGeometryType>\n</qgis>\n",
      layer.style.label.empty() ? "" : " labelsEnabled=\"1\"", renderer(layer), labels(layer), aliases(layer),
      geometry);
}

std::string sld_shape_style(const ShapeLayer& layer) {
  const ShapeStyle& s = layer.style;
  const std::string stroke = fmt::format(
      R"(<Stroke><SvgParameter name="stroke">{}</SvgParameter><SvgParameter name="stroke-width">{:.1f}</SvgParameter></Stroke>)",
      s.colour, s.width / 0.28);  // an SLD pixel is 0.28 mm
  std::string symbol;
  if (layer.kind == ShapeKind::line) {
    symbol = fmt::format("<LineSymbolizer>{}</LineSymbolizer>", stroke);
  } else if (layer.kind == ShapeKind::polygon) {
    const std::string fill = fmt::format(
        R"(<Fill><SvgParameter name="fill">{}</SvgParameter><SvgParameter name="fill-opacity">{}</SvgParameter></Fill>)",
        s.fill.empty() ? s.colour : s.fill, s.fill.empty() ? 0 : s.fill_opacity);
    symbol = fmt::format("<PolygonSymbolizer>{}{}</PolygonSymbolizer>", fill, stroke);
  } else {
    symbol = fmt::format(
        R"(<PointSymbolizer><Graphic><Mark><WellKnownName>circle</WellKnownName><Fill><SvgParameter name="fill">{}</SvgParameter></Fill></Mark><Size>8</Size></Graphic></PointSymbolizer>)",
        s.colour);
  }
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<StyledLayerDescriptor xmlns="http://www.opengis.net/sld" xmlns:ogc="http://www.opengis.net/ogc" version="1.1.0">
  <NamedLayer>
    <Name>{}</Name>
    <UserStyle>
      <FeatureTypeStyle>
        <Rule>
          {}
        </Rule>
      </FeatureTypeStyle>
    </UserStyle>
  </NamedLayer>
</StyledLayerDescriptor>
)",
                     layer.name, symbol);
}

}  // namespace waymark::geodb
