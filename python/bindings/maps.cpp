// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>

#include <cmath>

#include "apps/landmark_formats.hpp"
#include "exporters/vector/export_columns.hpp"
#include "geodb/map_store.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/query/query.hpp"

namespace waymark::python {
namespace {

using Kind = AttributeSpec::Kind;

const Keywords<workflows::QueryRequest>& query_keywords() {
  using R = workflows::QueryRequest;
  static const auto all = Keywords<R>()
                              .add("types", &R::types)
                              .add("bbox", &R::bbox)
                              .add("aoi", &R::aoi)
                              .add("near", &R::near)
                              .add("nearest", &R::nearest)
                              .add("min", &R::min_features)
                              .add("max", &R::max_features)
                              .add("crs", &R::crs)
                              .add("sensor", &R::sensor)
                              .add("min_confidence", &R::min_confidence)
                              .add("min_quality", &R::min_quality)
                              .add("largest", &R::largest)
                              .add("limit", &R::limit);
  return all;
}

/// Returns the kinds of the map's columns. Coordinates and the distance, which it lacks, are real.
Kind kind_of(const LandmarkType& type, const std::string& column) {
  for (const exporters::ExportColumn& one : exporters::export_columns(type))
    if (one.name == column) return one.kind;
  return Kind::real;
}

py::object real_array(const apps::RowColumn& column, const std::vector<Landmark>& landmarks) {
  py::array_t<double> values(static_cast<py::ssize_t>(landmarks.size()));
  double* to = values.mutable_data();
  for (const Landmark& landmark : landmarks) {
    const AttributeValue value = column.value(landmark);
    const auto* real = std::get_if<double>(&value);
    const auto* integer = std::get_if<std::int64_t>(&value);
    *to++ = real ? *real : integer ? static_cast<double>(*integer) : std::nan("");
  }
  return values;
}

py::object text_list(const apps::RowColumn& column, const std::vector<Landmark>& landmarks) {
  py::list values;
  for (const Landmark& landmark : landmarks) {
    const AttributeValue value = column.value(landmark);
    const auto* text = std::get_if<std::string>(&value);
    values.append(text ? *text : std::string());
  }
  return values;
}

/// Returns (name, kind, values) of each column of a type, as `waymark query --type TYPE --format csv` prints
/// them.
py::list columns_of(const workflows::QueryResult& found, const std::string& name, bool with_distance) {
  apps::RowContext context{.types = &found.types, .sensor = found.sensor.get()};
  if (with_distance)
    context.distance = [&](const Landmark& landmark) { return found.distances.at(landmark.uid); };
  const TypeId id = found.types.id(name);
  std::vector<Landmark> landmarks;
  for (const Landmark& landmark : found.landmarks)
    if (landmark.type == id) landmarks.push_back(landmark);
  py::list columns;
  for (const apps::RowColumn& column : apps::row_columns({name}, context)) {
    if (column.name == "type") continue;
    const Kind kind = kind_of(found.types[id], column.name);
    columns.append(
        py::make_tuple(column.name,
                       kind == Kind::text      ? "text"
                       : kind == Kind::integer ? "integer"
                                               : "real",
                       kind == Kind::text ? text_list(column, landmarks) : real_array(column, landmarks)));
  }
  return columns;
}

py::dict query_map(const std::string& path, const py::dict& keywords) {
  const workflows::QueryRequest request = query_keywords().request(keywords);
  const workflows::QueryResult found = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::query(path, request);
  }();
  py::dict types;
  for (const std::string& name : request.types.empty() ? found.types.names() : request.types)
    types[name.c_str()] = columns_of(found, name, !request.near.empty() || !request.nearest.empty());
  return py::dict(py::arg("types") = types, py::arg("crs") = found.crs.wkt2(),
                  py::arg("why_empty") = found.why_empty);
}

const char* scale_name(Scale scale) {
  return scale == Scale::ratio ? "ratio" : scale == Scale::interval ? "interval" : "axis";
}

py::dict describe_type(const LandmarkType& type, std::int64_t count) {
  py::list features, columns;
  for (const FeatureSpec& one : type.features)
    features.append(py::dict(py::arg("name") = one.name, py::arg("unit") = one.unit,
                             py::arg("scale") = scale_name(one.scale), py::arg("min") = one.min_value,
                             py::arg("max") = one.max_value, py::arg("summary") = one.summary));
  for (const exporters::ExportColumn& one : exporters::export_columns(type))
    columns.append(py::make_tuple(one.name, one.unit, one.summary));
  return py::dict(py::arg("name") = type.name, py::arg("summary") = type.summary, py::arg("count") = count,
                  py::arg("colour") = type.colour, py::arg("features") = features,
                  py::arg("columns") = columns);
}

py::dict describe_map(const std::string& path) {
  const geodb::MapStore map = [&] {
    const py::gil_scoped_release no_gil;
    return geodb::MapStore::open(path);
  }();
  py::list types;
  for (const std::string& name : map.types().names()) {
    const TypeId id = map.types().id(name);
    types.append(describe_type(map.types()[id], map.count(name)));
  }
  const Crs& crs = map.crs();
  return py::dict(py::arg("crs") = crs.wkt2(), py::arg("crs_id") = crs.id(),
                  py::arg("local") = crs.kind() == CrsKind::local,
                  py::arg("geographic") = crs.kind() == CrsKind::geographic,
                  py::arg("schema_version") = map.schema_version(), py::arg("types") = types);
}

}  // namespace

void bind_maps(py::module_& module) {
  module.def("describe_map", &describe_map, py::arg("path"));
  module.def("query", &query_map, py::arg("path"), py::arg("keywords"));
  module.def("query_keywords", [] { return query_keywords().defaults(); });
}

}  // namespace waymark::python
