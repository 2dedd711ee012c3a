// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/reconstruct.hpp"

#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::ReconstructRequest>& reconstruct_keywords() {
  using R = workflows::ReconstructRequest;
  static const auto all = Keywords<R>()
                              .add("images", &R::images)
                              .add("folder", &R::folder)
                              .add("cameras", &R::cameras)
                              .add("camera_crs", &R::camera_crs)
                              .add("lens", &R::lens)
                              .add("readout_time", &R::readout_time)
                              .add("control", &R::control)
                              .add("marks", &R::marks)
                              .add("altimeter", &R::altimeter)
                              .add("map_image", &R::map_image)
                              .add("dem", &R::dem)
                              .add("crs", &R::crs)
                              .add("cell", &R::cell)
                              .add("aoi", &R::aoi)
                              .add("until", &R::until)
                              .add("map", &R::map)
                              .add("work", &R::work)
                              .add("threads", &R::threads);
  return all;
}

py::dict reconstruct(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::ReconstructRequest request = reconstruct_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::ReconstructResult made = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::reconstruct(request, callbacks);
  }();
  return py::dict(py::arg("images") = made.images, py::arg("failed") = made.failed,
                  py::arg("cells") = made.cells, py::arg("kept") = made.kept,
                  py::arg("exit_code") = made.exit_code());
}

}  // namespace

void bind_reconstruction(py::module_& module) {
  py::enum_<workflows::ReconstructUntil>(module, "ReconstructUntil")
      .value("poses", workflows::ReconstructUntil::poses)
      .value("dem", workflows::ReconstructUntil::dem)
      .value("ortho", workflows::ReconstructUntil::ortho);
  module.def("reconstruct", &reconstruct, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("reconstruct_keywords", [] { return reconstruct_keywords().defaults(); });
}

}  // namespace waymark::python
