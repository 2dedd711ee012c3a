// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>

#include <stdexcept>

#include "workflows/callbacks.hpp"
namespace waymark::python {

/// Stops a workflow whose caller no longer wants its result. The engine passes a logic_error on; any other
/// exception would count as a failed unit.
struct Stopped : std::logic_error {
  Stopped() : logic_error("stopped by the caller") {}
};

/// Returns callbacks that hand progress(stage, done, total, rate) and message(kind, text) to Python. They
/// take the GIL, so a workflow runs without it. If `progress` returns False, the workflow stops.
workflows::Callbacks python_callbacks(pybind11::object progress, pybind11::object message);

}  // namespace waymark::python
