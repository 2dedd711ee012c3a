// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/detection/image_detector.hpp"
#include "workflows/plug_in.hpp"
#include "workflows/registries.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::DetectRequest>& detect_keywords() {
  using R = workflows::DetectRequest;
  static auto all = Keywords<R>()
                        .add("kind", &R::kind)
                        .add("image", &R::image)
                        .add("output", &R::output)
                        .add("method", &R::method)
                        .add("crs", &R::crs)
                        .add("sun_azimuth", &R::sun_azimuth)
                        .add("sun_elevation", &R::sun_elevation)
                        .add("image_sun_angle", &R::image_sun_angle)
                        .add("gsd", &R::gsd)
                        .add("min_diameter", &R::min_diameter)
                        .add("max_diameter", &R::max_diameter)
                        .add("min_confidence", &R::min_confidence)
                        .add("aoi", &R::aoi)
                        .add("band", &R::band)
                        .add("tile_pixels", &R::piece)
                        .add("threads", &R::threads);
  // Settings of the detectors, those of plug-ins that were loaded since too.
  for (const workflows::ImageDetectorSpec& detector : workflows::image_detectors())
    for (const OptionRow& row : workflows::settings_of(detector))
      if (!all.has(row.name))
        all.add_text(row.name,
                     [name = row.name](R& request) -> std::string& { return request.settings[name]; });
  return all;
}

/// Returns the declarations of the detectors in images by name.
py::dict image_detectors() {
  py::dict all;
  for (const workflows::ImageDetectorSpec& one : workflows::image_detectors()) {
    py::dict methods, settings;
    for (const workflows::DetectionMethod& method : one.methods) methods[method.name.c_str()] = method.record;
    for (const OptionRow& row : workflows::settings_of(one)) settings[row.name.c_str()] = row.field.help;
    all[one.name.c_str()] = py::dict(py::arg("summary") = one.summary, py::arg("type") = one.type,
                                     py::arg("methods") = methods, py::arg("settings") = settings);
  }
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
  module.def("load_plug_in", &workflows::load_plug_in, py::arg("file"));
  module.def("image_detectors", &image_detectors);
  module.def("detect_keywords", [] { return detect_keywords().defaults(); });
}

}  // namespace waymark::python
