// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>

#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/localization/localize.hpp"

namespace waymark::python {
namespace {

using localization::Track;
using localization::TrackRow;

/// Row of a track in a structured array, named as in TRACK.csv (interface of tracks).
struct Estimate {
  double t, x, y, z, roll, pitch, yaw, var_x, var_y, cov_xy, var_yaw;
  std::int64_t matched, rejected, wrong;
  bool lost;
  double cov_x_yaw, cov_y_yaw, nis;
  std::int64_t nis_rows;
};

Estimate estimate(const TrackRow& row) {
  const auto& pose = row.at.pose;
  const auto& c = row.at.covariance;
  return {row.t,    pose.x,  pose.y,  row.z,   row.roll,    row.pitch,    pose.yaw,
          c(0, 0),  c(1, 1), c(0, 1), c(2, 2), row.matched, row.rejected, row.wrong,
          row.lost, c(0, 2), c(1, 2), row.nis, row.nis_rows};
}

py::array_t<Estimate> estimates(const Track& track, std::size_t first) {
  py::array_t<Estimate> rows(static_cast<py::ssize_t>(track.rows.size() - first));
  Estimate* to = rows.mutable_data();
  for (std::size_t i = first; i < track.rows.size(); ++i) *to++ = estimate(track.rows[i]);
  return rows;
}

const Keywords<workflows::LocalizeRequest>& localize_keywords() {
  using R = workflows::LocalizeRequest;
  static const auto all = Keywords<R>()
                              .add(
                                  "map", [](R & r) -> auto& { return r.map; })
                              .add(
                                  "log", [](R & r) -> auto& { return r.log; })
                              .add(
                                  "output", [](R & r) -> auto& { return r.output; })
                              .add(
                                  "method", [](R & r) -> auto& { return r.method; })
                              .add(
                                  "sensor", [](R & r) -> auto& { return r.sensor; })
                              .add(
                                  "min_confidence", [](R & r) -> auto& { return r.min_confidence; })
                              .add(
                                  "seed", [](R & r) -> auto& { return r.seed; })
                              .add(
                                  "log_format", [](R & r) -> auto& { return r.log_format.format; })
                              .add(
                                  "columns", [](R & r) -> auto& { return r.log_format.columns; })
                              .add(
                                  "robot", [](R & r) -> auto& { return r.log_format.robot; })
                              .add(
                                  "use_identities", [](R & r) -> auto& { return r.use_identities; })
                              .add(
                                  "start", [](R & r) -> auto& { return r.start; })
                              .add(
                                  "write_map", [](R & r) -> auto& { return r.write_map; })
                              .add(
                                  "update_map", [](R & r) -> auto& { return r.update_map; })
                              .add(
                                  "set", [](R & r) -> auto& { return r.set; })
                              .add(
                                  "dem", [](R & r) -> auto& { return r.dem; })
                              .add(
                                  "in_map_crs", [](R & r) -> auto& { return r.in_map_crs; })
                              .add(
                                  "layers", [](R & r) -> auto& { return r.layers; })
                              .add(
                                  "timing", [](R & r) -> auto& { return r.timing; })
                              .add(
                                  "live", [](R & r) -> auto& { return r.live; })
                              .add(
                                  "threads", [](R & r) -> auto& { return r.threads; });
  return all;
}

/// Returns a watcher that hands new rows to watch(rows); the replay stops if that returns False.
localization::TrackWatcher row_watcher(const py::object& watch) {
  return [&watch, seen = std::size_t{0}](const Track& track) mutable {
    const py::gil_scoped_acquire gil;
    const bool go_on = !watch(estimates(track, seen)).is(py::bool_(false));
    seen = track.rows.size();
    if (!go_on) throw Stopped();
  };
}

py::tuple localize(const py::dict& keywords, const py::object& watch, py::object progress,
                   py::object message) {
  workflows::LocalizeRequest request = localize_keywords().request(keywords);
  request.watch = row_watcher(watch);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::LocalizeResult result = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::localize(request, callbacks);
  }();
  return py::make_tuple(estimates(result.track, 0), result.settings);
}

}  // namespace

void bind_localization(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(Estimate, t, x, y, z, roll, pitch, yaw, var_x, var_y, cov_xy, var_yaw, matched,
                       rejected, wrong, lost, cov_x_yaw, cov_y_yaw, nis, nis_rows);
  module.def("localize", &localize, py::arg("keywords"), py::arg("watch"), py::arg("progress"),
             py::arg("message"));
  module.def("localize_keywords", [] { return localize_keywords().defaults(); });
  module.def("localize_methods", &workflows::localize_methods);
  module.def(
      "localize_settings",
      [](const std::string& method) {
        return workflows::localize_settings({.map = "", .log = "", .method = method});
      },
      py::arg("method"));
}

}  // namespace waymark::python
