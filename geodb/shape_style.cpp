// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>

#include "geodb/shape_table.hpp"

namespace waymark {
namespace {

std::string rgba(const std::string& colour, double opacity) {
  unsigned value = 0x888888;
  if (colour.size() == 7) std::from_chars(colour.data() + 1, colour.data() + 7, value, 16);
  return fmt::format("{},{},{},{:.0f}", value >> 16 & 255, value >> 8 & 255, value & 255, 255 * opacity);
}

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
  const std::string width = fmt::format("{}", s.width), line = rgba(s.colour, 1);
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
  return {"fill", "SimpleFill",
          option("color", rgba(s.fill.empty() ? s.colour : s.fill, s.fill.empty() ? 0 : s.fill_opacity)) +
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

}  // namespace

std::string qml_shape_style(const ShapeLayer& layer) {
  const Symbol symbol = symbol_of(layer);
  const int geometry = layer.kind == ShapeKind::point ? 0 : layer.kind == ShapeKind::line ? 1 : 2;
  return fmt::format(R"(<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis version="3.22" styleCategories="Symbology|Labeling"{}>
  <renderer-v2 type="singleSymbol" forceraster="0" symbollevels="0" enableorderby="0">
    <symbols>
      <symbol type="{}" name="0" alpha="1" clip_to_extent="1" force_rhr="0">
        <layer class="{}" enabled="1" locked="0" pass="0">
          <Option type="Map">
{}          </Option>
        </layer>
      </symbol>
    </symbols>
  </renderer-v2>
{}  <layerGeometryType>{}</layerGeometryType>
</qgis>
)",
                     layer.style.label.empty() ? "" : " labelsEnabled=\"1\"", symbol.type, symbol.layer,
                     symbol.options, labels(layer), geometry);
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

}  // namespace waymark
