// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>

#include <limits>

#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/planning/hazards.hpp"
#include "workflows/planning/route.hpp"

namespace waymark::python {
namespace {

/// Station of a route in a structured array; positions in the map's CRS. Clearance and tilt are NaN without
/// a DEM and on unknown terrain.
struct Station {
  double x, y, distance, yaw, sd;
  std::int64_t landmarks;
  double clearance, tilt;
};

const Keywords<workflows::RouteRequest>& route_keywords() {
  using R = workflows::RouteRequest;
  static const auto all = Keywords<R>()
                              .add("map", &R::map)
                              .add("start", &R::from)
                              .add("goal", &R::to)
                              .add("output", &R::output)
                              .add("via", &R::via)
                              .add("hazards", &R::hazards)
                              .add("aoi", &R::aoi)
                              .add("sensor", &R::sensor)
                              .add("range", &R::range)
                              .add("view", &R::view)
                              .add("limit_sigma", &R::limit_sigma)
                              .add("keep_landmarks", &R::keep_landmarks)
                              .add("weight", &R::weight)
                              .add("by_quality", &R::by_quality)
                              .add("cell", &R::cell)
                              .add("start_sd", &R::start_sd)
                              .add("least_sigma", &R::min_sigma)
                              .add("odometry", &R::odometry)
                              .add("speed", &R::speed)
                              .add("sensor_height", &R::sensor_height)
                              .add("identities_known", &R::identities_known)
                              .add("worlds", &R::worlds)
                              .add("alternatives", &R::alternatives)
                              .add("seed", &R::seed)
                              .add("dem", &R::dem)
                              .add("vehicle", &R::vehicle);
  return all;
}

const Keywords<workflows::HazardMapRequest>& hazard_keywords() {
  using R = workflows::HazardMapRequest;
  static const auto all = Keywords<R>()
                              .add("input", &R::input)
                              .add("output", &R::output)
                              .add("dem", &R::dem)
                              .add("vehicle", &R::vehicle)
                              .add("polygons", &R::polygons)
                              .add("nav2", &R::nav2)
                              .add("height_sd", &R::height_sd)
                              .add("height_correlation", &R::height_correlation)
                              .add("rock_cover", &R::rock_cover)
                              .add("detection_limit", &R::detection_limit)
                              .add("uncertain", &R::min_uncertain)
                              .add("hazard", &R::min_hazard)
                              .add("landing_ellipse", &R::landing_ellipse)
                              .add("sun", &R::sun)
                              .add("horizon_reach", &R::horizon_reach)
                              .add("aoi", &R::aoi)
                              .add("crs", &R::crs)
                              .add("tile_cells", &R::tile_cells)
                              .add("threads", &R::threads);
  return all;
}

py::dict as_dict(const workflows::PlannedRoute& route) {
  py::array_t<Station> stations(static_cast<py::ssize_t>(route.stations.size()));
  Station* to = stations.mutable_data();
  py::list important;
  for (const workflows::RouteStation& one : route.stations) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    *to++ = {one.at.x(),
             one.at.y(),
             one.distance,
             one.yaw,
             one.sd,
             one.landmarks,
             one.clearance ? one.clearance->belly : kUnknown,
             one.clearance ? one.clearance->tilt : kUnknown};
    important.append(one.important);
  }
  return py::dict(py::arg("length") = route.length, py::arg("worst_sd") = route.worst_sd,
                  py::arg("final_sd") = route.final_sd,
                  py::arg("without_landmarks") = route.without_landmarks, py::arg("outside") = route.outside,
                  py::arg("worlds_mean") = route.worlds_mean,
                  py::arg("worlds_worst_tenth") = route.worlds_worst_tenth, py::arg("stations") = stations,
                  py::arg("important") = important);
}

py::dict route(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::RouteRequest request = route_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::RouteResult planned = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::plan_route(request, callbacks);
  }();
  py::list routes;
  for (const workflows::PlannedRoute& one : planned.routes) routes.append(as_dict(one));
  return py::dict(py::arg("routes") = routes, py::arg("shortest") = as_dict(planned.shortest),
                  py::arg("lower_bound") = planned.lower_bound);
}

/// Returns the numbers that `waymark hazards --format json` prints.
py::dict hazards(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::HazardMapRequest request = hazard_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::HazardMapResult made = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::make_hazard_map(request, callbacks);
  }();
  const planning::UndetectedRocks& rocks = made.undetected;
  const auto if_known = [&](double value) -> py::object {
    if (!rocks.known) return py::none();
    return py::float_(value);
  };
  py::dict cells;
  const std::vector<std::string> classes = workflows::hazard_class_names();
  for (std::size_t i = 0; i < classes.size(); ++i) cells[classes[i].c_str()] = made.cells.at(i);
  return py::dict(py::arg("cells") = cells, py::arg("objects") = made.objects,
                  py::arg("detected_diameter_m") = rocks.detected_diameter,
                  py::arg("rock_cover") = if_known(rocks.cover.k),
                  py::arg("rock_cover_sd") = if_known(rocks.cover.sd),
                  py::arg("undetected_per_km") = if_known(1000 * made.undetected_per_metre.value),
                  py::arg("undetected_per_km_sd") = if_known(1000 * made.undetected_per_metre.sd));
}

}  // namespace

void bind_planning(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(Station, x, y, distance, yaw, sd, landmarks, clearance, tilt);
  module.def("route", &route, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("route_keywords", [] { return route_keywords().defaults(); });
  module.def("hazards", &hazards, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("hazards_keywords", [] { return hazard_keywords().defaults(); });
}

}  // namespace waymark::python
