// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/layer_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "core/escape_markup.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/layers/qml_colour.hpp"

namespace waymark::geodb {
namespace {

struct Marker {
  const char* qgis;
  const char* sld;
  bool filled;
  double size = 2.4, stroke = 0.2;  ///< millimetres; data may define the size
  bool is_stroke = false;           ///< the stroke is all that is seen of it
};

// Outline of the solid from above; a cone is the triangle that maps use for summits.
Marker marker_of(Solid solid) {
  switch (solid) {
    case Solid::point:
      return {"diamond", "square", true};
    case Solid::sphere:
      return {"circle", "circle", true};
    case Solid::cylinder:
      return {"hexagon", "circle", true};
    case Solid::cone:
      return {"triangle", "triangle", true};
    case Solid::bowl:
      return {.qgis = "circle", .sld = "circle", .filled = false, .stroke = 0.5, .is_stroke = true};
  }
  return {"circle", "circle", true};
}

/// How a type with a direction is drawn: a line along the wall, to scale where its length is known, else an
/// arrow.
struct Heading {
  std::string feature;  ///< direction or axis
  std::string length;   ///< feature that the line is as long as; empty: an arrow that shows where it points
  bool across = false;  ///< the direction is a normal of the line
};

std::optional<Heading> heading_of(const LandmarkType& type) {
  if (type.drawn_as != Solid::point || !type.body.feature.empty()) return std::nullopt;
  const auto angle =
      std::ranges::find_if(type.features, [](const FeatureSpec& f) { return is_angle(f.scale); });
  if (angle == type.features.end()) return std::nullopt;
  const bool across = angle->scale == Scale::direction;
  const auto has = [&](const char* name) {
    return std::ranges::find(type.features, name, &FeatureSpec::name) != type.features.end();
  };
  if (has("length")) return Heading{angle->name, "length", across};
  if (has("width") && !across) return Heading{angle->name, "width", across};
  return Heading{angle->name, "", across};
}

std::string property(std::string_view name, std::string_view expression) {
  return fmt::format(
      R"(<Option name="{}" type="Map"><Option name="active" value="true" type="bool"/>)"
      R"(<Option name="expression" value="{}" type="QString"/><Option name="type" value="3" type="int"/></Option>)",
      name, expression);
}

std::string properties(const std::string& inner) {
  return R"(<Option type="Map"><Option name="name" value="" type="QString"/>)"
         R"(<Option name="properties" type="Map">)" +
         inner + R"(</Option><Option name="type" value="collection" type="QString"/></Option>)";
}

/// Symbols that are outlines from above are drawn to scale where that is larger; triangles would hide others.
bool is_to_scale(const LandmarkType& type) {
  return type.body.feature == type.size_feature &&
         (type.drawn_as == Solid::bowl || type.drawn_as == Solid::cylinder || type.drawn_as == Solid::sphere);
}

/// Returns by what QGIS's scale is too large or small. On a map in degrees it counts the distance across the
/// pole of the Earth: its parallels shrink with the latitude, not with its cosine.
std::string scale_correction(const Crs& crs) {
  if (crs.kind() != CrsKind::geographic) return "";
  constexpr double kQgisRadius = 6.37e6;
  return fmt::format(
      " * if(@map_extent_width &lt;= 400 and abs(y(@map_extent_center)) &lt;= 90, "
      "{:.6g} * (1 - abs(y(@map_extent_center)) / 90), 1)",
      kQgisRadius / crs.body().equatorial_radius);
}

// Millimetres: 1.6 for a feature of 0, one more for each power of ten; or the body's diameter at the map's
// scale.
std::string size_expression(const LandmarkType& type, const Crs& crs) {
  const std::string size =
      fmt::format("1.6 + coalesce(log10(1 + max(0, &quot;{}&quot;)), 0)", type.size_feature);
  if (!is_to_scale(type)) return size;
  return fmt::format("max({}, coalesce({:.6g} * &quot;{}&quot; / @map_scale{}, 0))", size,
                     2000 * type.body.radius_per_value, type.body.feature, scale_correction(crs));
}

// Large numbers, e.g. elevations, have no decimals.
std::string label_expression(const std::string& feature) {
  return fmt::format("round(&quot;{0}&quot;, if(abs(&quot;{0}&quot;) &lt; 100, 1, 0))", feature);
}

/// Returns what data define of a marker with a heading: QGIS's lines and arrows point up and turn clockwise.
std::string heading_properties(const Heading& heading, const Crs& crs) {
  const std::string turned =
      property("angle", fmt::format("coalesce(degrees(&quot;{}&quot;), 0){}", heading.feature,
                                    heading.across && !heading.length.empty() ? " + 90" : ""));
  if (heading.length.empty()) return turned;
  return turned + property("size", fmt::format("max(2.4, coalesce(1000 * &quot;{}&quot; / @map_scale{}, 0))",
                                               heading.length, scale_correction(crs)));
}

Marker marker_of(const LandmarkType& type) {
  const auto heading = heading_of(type);
  if (!heading) return marker_of(type.drawn_as);
  if (heading->length.empty()) return {.qgis = "arrow", .sld = "square", .filled = true, .size = 3.6};
  return {.qgis = "line", .sld = "square", .filled = true, .stroke = 0.8, .is_stroke = true};
}

/// Returns what data define of the marker.
std::string marker_properties(const LandmarkType& type, const Crs& crs) {
  if (const auto heading = heading_of(type)) return heading_properties(*heading, crs);
  return type.size_feature.empty() ? "" : property("size", size_expression(type, crs));
}

std::string qml_symbol(const LandmarkType& type, const Crs& crs) {
  const Marker marker = marker_of(type);
  return fmt::format(R"(  <renderer-v2 type="singleSymbol" forceraster="0" symbollevels="0" enableorderby="0">
    <symbols>
      <symbol type="marker" name="0" alpha="1" clip_to_extent="1" force_rhr="0">
        <layer class="SimpleMarker" enabled="1" locked="0" pass="0">
          <Option type="Map">
            <Option name="name" value="{}" type="QString"/>
            <Option name="color" value="{}" type="QString"/>
            <Option name="outline_color" value="{}" type="QString"/>
            <Option name="outline_style" value="solid" type="QString"/>
            <Option name="outline_width" value="{}" type="QString"/>
            <Option name="outline_width_unit" value="MM" type="QString"/>
            <Option name="size" value="{}" type="QString"/>
            <Option name="size_unit" value="MM" type="QString"/>
            <Option name="scale_method" value="diameter" type="QString"/>
          </Option>
          <data_defined_properties>{}</data_defined_properties>
        </layer>
      </symbol>
    </symbols>
  </renderer-v2>
)",
                     marker.qgis, qml_colour(type.colour, marker.filled ? 1 : 0),
                     marker.is_stroke ? qml_colour(type.colour) : "255,255,255,255", marker.stroke,
                     marker.size, properties(marker_properties(type, crs)));
}

std::string qml_labels(const LandmarkType& type) {
  if (type.label_feature.empty()) return "";
  const std::string& rank = type.size_feature.empty() ? type.label_feature : type.size_feature;
  const std::string priority =
      property("Priority", fmt::format("min(10, 2.5 * coalesce(log10(1 + abs(&quot;{}&quot;)), 0))", rank));
  return fmt::format(R"(  <labeling type="simple">
    <settings calloutType="simple">
      <text-style fieldName="{}" isExpression="1" fontFamily="Sans" namedStyle="Regular" fontSize="8" fontSizeUnit="Point" textColor="40,40,40,255" textOpacity="1">
        <text-buffer bufferDraw="1" bufferSize="0.8" bufferSizeUnits="MM" bufferColor="255,255,255,255" bufferOpacity="0.85" bufferNoFill="1"/>
      </text-style>
      <placement placement="6" dist="1" distUnits="MM" offsetType="1" priority="5" predefinedPositionOrder="TR,TL,BR,BL,R,L,TSR,BSR"/>
      <rendering drawLabels="1" obstacle="1" obstacleFactor="1" displayAll="0" scaleVisibility="0"/>
      <dd_properties>{}</dd_properties>
    </settings>
  </labeling>
)",
                     label_expression(type.label_feature), properties(priority));
}

std::string title_of_type(std::string name) {
  std::ranges::replace(name, '_', ' ');
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

/// Returns a QGIS expression: the attribute `name` where the type has one, else "Mountain top 940 m", or the
/// uid of types without a label.
std::string display_expression(const LandmarkType& type) {
  const bool named = std::ranges::count(type.attributes, "name", &AttributeSpec::name) > 0;
  const std::string name = named ? "nullif(\"name\", ''), " : "";
  const auto feature = std::ranges::find(type.features, type.label_feature, &FeatureSpec::name);
  if (feature == type.features.end()) return "coalesce(" + name + "\"uid\")";
  return fmt::format("coalesce({3}'{0} ' || round(\"{1}\", if(abs(\"{1}\") < 100, 1, 0)) || '{2}', \"uid\")",
                     title_of_type(type.name), feature->name,
                     feature->unit.empty() ? "" : " " + feature->unit, name);
}

/// Returns the HTML that QGIS shows under the pointer: the display name, each known feature, and the
/// confidence.
std::string map_tip(const LandmarkType& type) {
  std::string rows;
  for (const FeatureSpec& f : type.features)
    rows += fmt::format(
        "[% if(\"{0}\" is null, '', '<br/>{1}: ' || round(\"{0}\", 2) || '{2}' || coalesce(' ± ' || "
        "round(\"{0}_sd\", 2), '')) %]",
        f.name, title_of_type(f.name), f.unit.empty() ? "" : " " + f.unit);
  return fmt::format(
      "<b>[% {} %]</b>{}<br/>Confidence: [% round(\"confidence\", 2) %], seen [% \"seen\" %] of [% "
      "\"visible\" %] "
      "times<br/>[% \"uid\" %]",
      display_expression(type), rows);
}

std::string qml_form(const LandmarkType& type) {
  std::string aliases;
  int index = 0;
  const LandmarkLayout layout(type, 0);
  for (const LandmarkColumn& column : layout.columns())
    if (column.name != "geom")
      aliases += fmt::format("    <alias index=\"{}\" field=\"{}\" name=\"{}\"/>\n", index++, column.name,
                             escape_markup(column.title));
  return fmt::format(
      "  <aliases>\n{}  </aliases>\n  <previewExpression>{}</previewExpression>\n  <mapTip>{}</mapTip>\n",
      aliases, escape_markup(display_expression(type)), escape_markup(map_tip(type)));
}

}  // namespace

std::string qml_style(const LandmarkType& type, const Crs& crs) {
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n"
         "<qgis version=\"3.22\" "
         "styleCategories=\"Symbology|Labeling|Fields|Forms|MapTips|LayerConfiguration\"" +
         std::string(type.label_feature.empty() ? "" : " labelsEnabled=\"1\"") + ">\n" +
         qml_symbol(type, crs) + qml_labels(type) + qml_form(type) +
         "  <layerGeometryType>0</layerGeometryType>\n</qgis>\n";
}

std::string sld_style(const LandmarkType& type) {
  const Marker marker = marker_of(type.drawn_as);
  std::string label;
  if (!type.label_feature.empty())
    label = fmt::format(R"(
          <TextSymbolizer>
            <Label><ogc:PropertyName>{}</ogc:PropertyName></Label>
            <Font><SvgParameter name="font-size">11</SvgParameter></Font>
            <Halo><Radius>1</Radius></Halo>
          </TextSymbolizer>)",
                        type.label_feature);
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<StyledLayerDescriptor xmlns="http://www.opengis.net/sld" xmlns:ogc="http://www.opengis.net/ogc" version="1.1.0">
  <NamedLayer>
    <Name>{0}</Name>
    <UserStyle>
      <FeatureTypeStyle>
        <Rule>
          <PointSymbolizer>
            <Graphic>
              <Mark>
                <WellKnownName>{1}</WellKnownName>
                <Fill><SvgParameter name="fill">{2}</SvgParameter><SvgParameter name="fill-opacity">{3}</SvgParameter></Fill>
                <Stroke><SvgParameter name="stroke">{4}</SvgParameter></Stroke>
              </Mark>
              <Size>9</Size>
            </Graphic>
          </PointSymbolizer>{5}
        </Rule>
      </FeatureTypeStyle>
    </UserStyle>
  </NamedLayer>
</StyledLayerDescriptor>
)",
                     type.name, marker.sld, type.colour, marker.filled ? 1 : 0,
                     marker.filled ? "#ffffff" : type.colour, label);
}

}  // namespace waymark::geodb
