// SPDX-License-Identifier: Apache-2.0
#include "workflows/evaluation/evaluate.hpp"

#include "apps/score_text.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"

namespace waymark::python {
namespace {

const Keywords<workflows::LandmarkEvaluation>& landmark_keywords() {
  using R = workflows::LandmarkEvaluation;
  static const auto all = Keywords<R>()
                              .add(
                                  "result", [](R & r) -> auto& { return r.result; })
                              .add(
                                  "truth", [](R & r) -> auto& { return r.truth; })
                              .add(
                                  "ignore", [](R & r) -> auto& { return r.ignore; })
                              .add(
                                  "type", [](R & r) -> auto& { return r.type; })
                              .add(
                                  "match_by", [](R & r) -> auto& { return r.match_by; })
                              .add(
                                  "max_distance", [](R & r) -> auto& { return r.max_distance; })
                              .add(
                                  "min_tolerance", [](R & r) -> auto& { return r.always_allowed_distance; })
                              .add(
                                  "min_diameter", [](R & r) -> auto& { return r.min_diameter; })
                              .add(
                                  "min_pixels", [](R & r) -> auto& { return r.min_pixels; })
                              .add(
                                  "size_edges", [](R & r) -> auto& { return r.size_edges; });
  return all;
}

const Keywords<workflows::TrackEvaluation>& track_keywords() {
  using R = workflows::TrackEvaluation;
  static const auto all = Keywords<R>()
                              .add(
                                  "track", [](R & r) -> auto& { return r.track; })
                              .add(
                                  "truth", [](R & r) -> auto& { return r.truth; })
                              .add(
                                  "align", [](R & r) -> auto& { return r.align; })
                              .add(
                                  "log_format", [](R & r) -> auto& { return r.log_format.format; })
                              .add(
                                  "columns", [](R & r) -> auto& { return r.log_format.columns; })
                              .add(
                                  "robot", [](R & r) -> auto& { return r.log_format.robot; })
                              .add(
                                  "max_gap", [](R & r) -> auto& { return r.max_gap; })
                              .add(
                                  "picture", [](R & r) -> auto& { return r.picture; })
                              .add(
                                  "map", [](R & r) -> auto& { return r.map; })
                              .add(
                                  "also", [](R & r) -> auto& { return r.also; });
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
std::string evaluate_track(const py::dict& keywords) {
  const workflows::TrackEvaluation request = track_keywords().request(keywords);
  const py::gil_scoped_release no_gil;
  return apps::track_score_as_json(workflows::evaluate(request), request.align);
}

}  // namespace

void bind_evaluation(py::module_& module) {
  module.def("evaluate_landmarks", &evaluate_landmarks, py::arg("keywords"), py::arg("progress"),
             py::arg("message"));
  module.def("evaluate_landmarks_keywords", [] { return landmark_keywords().defaults(); });
  module.def("evaluate_track", &evaluate_track, py::arg("keywords"));
  module.def("evaluate_track_keywords", [] { return track_keywords().defaults(); });
}

}  // namespace waymark::python
