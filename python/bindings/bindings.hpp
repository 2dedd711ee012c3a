// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>
namespace waymark::python {

// Each adds the functions of one purpose to the module.

/// Adds the reading and querying of maps.
void bind_maps(pybind11::module_& module);
/// Adds the detectors of images.
void bind_detection(pybind11::module_& module);
/// Adds jobs, stages and simulations.
void bind_mapping(pybind11::module_& module);
/// Adds the reconstruction from images.
void bind_reconstruction(pybind11::module_& module);
/// Adds the localization of robots.
void bind_localization(pybind11::module_& module);
/// Adds routes and hazard maps.
void bind_planning(pybind11::module_& module);
/// Adds inventories of forests.
void bind_forest(pybind11::module_& module);
/// Adds web maps.
void bind_web(pybind11::module_& module);
/// Adds the comparison with truth.
void bind_evaluation(pybind11::module_& module);

}  // namespace waymark::python
