// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/detection/detect.hpp"
#include "workflows/registries.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::DetectRequest>& detect_keywords() {
  using R = workflows::DetectRequest;
  static const auto all = Keywords<R>()
                              .add(
                                  "kind", [](R & r) -> auto& { return r.kind; })
                              .add(
                                  "image", [](R & r) -> auto& { return r.image; })
                              .add(
                                  "output", [](R & r) -> auto& { return r.output; })
                              .add(
                                  "method", [](R & r) -> auto& { return r.method; })
                              .add(
                                  "crs", [](R & r) -> auto& { return r.crs; })
                              .add(
                                  "sun_azimuth", [](R & r) -> auto& { return r.sun_azimuth; })
                              .add(
                                  "sun_elevation", [](R & r) -> auto& { return r.sun_elevation; })
                              .add(
                                  "image_sun_angle", [](R & r) -> auto& { return r.image_sun_angle; })
                              .add(
                                  "gsd", [](R & r) -> auto& { return r.gsd; })
                              .add(
                                  "min_diameter", [](R & r) -> auto& { return r.min_diameter; })
                              .add(
                                  "max_diameter", [](R & r) -> auto& { return r.max_diameter; })
                              .add(
                                  "min_confidence", [](R & r) -> auto& { return r.min_confidence; })
                              .add(
                                  "band", [](R & r) -> auto& { return r.band; })
                              .add(
                                  "piece", [](R & r) -> auto& { return r.piece; })
                              .add(
                                  "threads", [](R & r) -> auto& { return r.threads; });
  return all;
}

/// Returns the table of docs/reference/detection_table.md, and the estimated light.
py::tuple detect(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::DetectRequest request = detect_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  std::string table, light;
  {
    const py::gil_scoped_release no_gil;
    const workflows::DetectResult found = workflows::detect(request, callbacks);
    table = exporters::detections_to_csv(found.detections, workflows::all_types()[found.detections.type]);
    light = found.light;
  }
  return py::make_tuple(table, light);
}

}  // namespace

void bind_detection(py::module_& module) {
  module.def("detect", &detect, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("detect_keywords", [] { return detect_keywords().defaults(); });
}

}  // namespace waymark::python
