// SPDX-License-Identifier: Apache-2.0
#include "core/error.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "workflows/provenance.hpp"

namespace waymark::python {
namespace {

namespace py = pybind11;

/// Raises the Python exception of an error, which waymark/errors.py chooses by its code.
void raise(const Error& error) {
  const char* code = error.code() == ErrorCode::usage    ? "usage"
                     : error.code() == ErrorCode::input  ? "input"
                     : error.code() == ErrorCode::output ? "output"
                                                         : "environment";
  const py::object made = py::module_::import("waymark.errors")
                              .attr("from_parts")(code, error.problem(), error.where(), error.hint());
  PyErr_SetObject(py::type::of(made).ptr(), made.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Error& error) {
    raise(error);
  } catch (const Stopped& stopped) {
    PyErr_SetString(PyExc_KeyboardInterrupt, stopped.what());
  }
}

}  // namespace

PYBIND11_MODULE(_waymark, module) {
  module.doc() = "The workflows of Waymark; use the package waymark";
  py::register_exception_translator(translate);
  module.attr("version") = workflows::program_version();
  bind_maps(module);
  bind_detection(module);
  bind_mapping(module);
  bind_reconstruction(module);
  bind_localization(module);
  bind_planning(module);
  bind_forest(module);
  bind_web(module);
  bind_evaluation(module);
}

}  // namespace waymark::python
