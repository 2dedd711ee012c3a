// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/shape_json.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/forest/inventory.hpp"
#include "workflows/forest/stand_figures.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::InventoryRequest>& inventory_keywords() {
  using R = workflows::InventoryRequest;
  static const auto all = Keywords<R>()
                              .add("map", &R::map)
                              .add("output", &R::output)
                              .add("stands", &R::stands)
                              .add("stands_layer", &R::stands_layer)
                              .add("aoi", &R::aoi)
                              .add("grid", &R::grid)
                              .add("allometry", &R::allometry)
                              .add("volume", &R::volume)
                              .add("recall", &R::recall)
                              .add("max_trees", &R::max_trees)
                              .add("class_width", &R::class_width)
                              .add("report", &R::report);
  return all;
}

/// Returns the rows that `waymark inventory --format json` prints, as JSON, and the stands that were left
/// out.
py::tuple inventory(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::InventoryRequest request = inventory_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  std::vector<std::string> failed;
  const std::string rows = [&] {
    const py::gil_scoped_release no_gil;
    workflows::InventoryResult counted = workflows::inventory(request, callbacks);
    failed = std::move(counted.failed);
    return exporters::layer_to_json(workflows::stand_layer(counted.stands));
  }();
  return py::make_tuple(rows, failed);
}

}  // namespace

void bind_forest(py::module_& module) {
  module.def("inventory", &inventory, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("inventory_keywords", [] { return inventory_keywords().defaults(); });
}

}  // namespace waymark::python
