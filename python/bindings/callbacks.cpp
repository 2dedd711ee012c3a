// SPDX-License-Identifier: Apache-2.0
#include "python/bindings/callbacks.hpp"

#include <memory>

namespace waymark::python {
namespace {

namespace py = pybind11;

/// A Python object that any thread may release.
using Shared = std::shared_ptr<py::object>;

Shared share(py::object object) {
  return Shared(new py::object(std::move(object)), [](py::object* held) {
    const py::gil_scoped_acquire gil;
    delete held;
  });
}

const char* kind_name(workflows::MessageKind kind) {
  switch (kind) {
    case workflows::MessageKind::detail:
      return "detail";
    case workflows::MessageKind::summary:
      return "summary";
    case workflows::MessageKind::warning:
      return "warning";
    case workflows::MessageKind::failure:
      return "failure";
    case workflows::MessageKind::result:
      break;
  }
  return "result";
}

}  // namespace

workflows::Callbacks python_callbacks(py::object progress, py::object message) {
  const Shared report = share(std::move(progress)), send = share(std::move(message));
  return {.progress =
              [report](const pipeline::Progress& at) {
                const py::gil_scoped_acquire gil;
                if ((*report)(at.stage, at.done, at.total, at.rate).is(py::bool_(false))) throw Stopped();
              },
          .message =
              [send](const workflows::Message& sent) {
                const py::gil_scoped_acquire gil;
                (*send)(kind_name(sent.kind), sent.text);
              }};
}

}  // namespace waymark::python
