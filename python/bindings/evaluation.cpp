// SPDX-License-Identifier: Apache-2.0
#include "workflows/evaluation/evaluate.hpp"

#include "apps/score_text.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/evaluation/track_study.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::LandmarkEvaluation>& landmark_keywords() {
  using R = workflows::LandmarkEvaluation;
  static const auto all = Keywords<R>()
                              .add("result", &R::result)
                              .add("truth", &R::truth)
                              .add("ignore", &R::ignore)
                              .add("type", &R::type)
                              .add("sensor", &R::sensor)
                              .add("by", &R::match_by)
                              .add("tolerance", &R::max_distance)
                              .add("min_tolerance", &R::always_allowed_distance)
                              .add("min_diameter", &R::min_diameter)
                              .add("min_pixels", &R::min_pixels)
                              .add("size_edges", &R::size_edges);
  return all;
}

const Keywords<workflows::TrackEvaluation>& track_keywords() {
  using R = workflows::TrackEvaluation;
  static const auto all = Keywords<R>()
                              .add("track", &R::track)
                              .add("truth", &R::truth)
                              .add("align", &R::align)
                              .add("log_format", &log_format<R>)
                              .add("columns", &log_columns<R>)
                              .add("robot", &log_robot<R>)
                              .add("max_gap", &R::max_gap)
                              .add("picture", &R::picture)
                              .add("map", &R::map)
                              .add("also", &R::also);
  return all;
}

/// Returns what `waymark evaluate landmarks --format json` prints.
std::string evaluate_landmarks(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::LandmarkEvaluation request = landmark_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const py::gil_scoped_release no_gil;
  return apps::scores_as_json(workflows::evaluate(request, callbacks));
}

/// Returns what `waymark evaluate track --format json` prints.
std::string evaluate_track(const py::dict& keywords, const std::vector<std::string>& more_drives) {
  const workflows::TrackEvaluation request = track_keywords().request(keywords);
  const py::gil_scoped_release no_gil;
  if (!more_drives.empty())
    return apps::track_study_as_json(workflows::evaluate_drives(request, more_drives), request.align);
  return apps::track_score_as_json(workflows::evaluate(request), request.align);
}

}  // namespace

void bind_evaluation(py::module_& module) {
  module.def("evaluate_landmarks", &evaluate_landmarks, py::arg("keywords"), py::arg("progress"),
             py::arg("message"));
  module.def("evaluate_landmarks_keywords", [] { return landmark_keywords().defaults(); });
  module.def("evaluate_track", &evaluate_track, py::arg("keywords"), py::arg("more_drives"));
  module.def("evaluate_track_keywords", [] { return track_keywords().defaults(); });
}

}  // namespace waymark::python
