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
                              .add("map", &R::map)
                              .add("log", &R::log)
                              .add("output", &R::output)
                              .add("method", &R::method)
                              .add("sensor", &R::sensor)
                              .add("min_confidence", &R::min_confidence)
                              .add("seed", &R::seed)
                              .add("log_format", &log_format<R>)
                              .add("columns", &log_columns<R>)
                              .add("topic", &log_topics<R>)
                              .add("robot", &log_robot<R>)
                              .add("use_identities", &R::use_identities)
                              .add("start", &R::start)
                              .add("write_map", &R::write_map)
                              .add("update_map", &R::update_map)
                              .add("set", &R::set)
                              .add("dem", &R::dem)
                              .add("in_map_crs", &R::in_map_crs)
                              .add("layers", &R::layers)
                              .add("timing", &R::timing)
                              .add("live", &R::live)
                              .add("threads", &R::threads);
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
