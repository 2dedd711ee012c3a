// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/viewing/web_map.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::WebMapRequest>& web_keywords() {
  using R = workflows::WebMapRequest;
  static const auto all = Keywords<R>()
                              .add("map", &R::map)
                              .add("output", &R::output)
                              .add("aoi", &R::aoi)
                              .add("types", &R::types)
                              .add("min_confidence", &R::min_confidence)
                              .add("dem", &R::dem)
                              .add("terrain_pixels", &R::terrain_pixels)
                              .add("max_zoom", &R::max_zoom)
                              .add("assets", &R::assets)
                              .add("title", &R::title)
                              .add("threads", &R::threads);
  return all;
}

py::dict web(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::WebMapRequest request = web_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::WebMapResult made = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::make_web_map(request, callbacks);
  }();
  return py::dict(py::arg("landmarks") = made.landmarks, py::arg("outside") = made.outside,
                  py::arg("max_zoom") = made.max_zoom, py::arg("landmark_tiles") = made.landmark_tiles,
                  py::arg("terrain_tiles") = made.terrain_tiles, py::arg("areas") = made.shapes,
                  py::arg("area_tiles") = made.shape_tiles, py::arg("has_library") = made.has_library);
}

}  // namespace

void bind_web(py::module_& module) {
  module.def("web", &web, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("web_keywords", [] { return web_keywords().defaults(); });
}

}  // namespace waymark::python
