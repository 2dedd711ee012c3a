// SPDX-License-Identifier: Apache-2.0
#include <pybind11/numpy.h>

#include <algorithm>

#include "core/error.hpp"
#include "exporters/raster/raster_file.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/stage_pages.hpp"
#include "python/bindings/bindings.hpp"
#include "python/bindings/callbacks.hpp"
#include "python/bindings/keywords.hpp"
#include "workflows/mapping/image_stages.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/mapping/merge_maps.hpp"
#include "workflows/registries.hpp"
#include "workflows/simulation/simulate.hpp"

namespace waymark::python {
namespace {

// The options of the engine in a request.
template <auto kMember>
auto& engine(workflows::MapRequest& request) {
  return request.run.*kMember;
}

const Keywords<workflows::MapRequest>& run_keywords() {
  using R = workflows::MapRequest;
  using E = pipeline::RunOptions;
  static const auto all = Keywords<R>()
                              .add("output", &R::map)
                              .add("work", &engine<&E::work>)
                              .add("stage", &engine<&E::stage>)
                              .add("rerun_from", &engine<&E::rerun_from>)
                              .add("unit", &engine<&E::unit>)
                              .add("check", &R::check)
                              .add("with_dem", &R::with_dem)
                              .add("sensor", &R::sensor)
                              .add("threads", &engine<&E::threads>);
  return all;
}

const Keywords<workflows::CanopyFiles>& canopy_keywords() {
  using R = workflows::CanopyFiles;
  static const auto all = Keywords<R>()
                              .add("chm", &R::chm)
                              .add("dsm", &R::dsm)
                              .add("dtm", &R::dtm)
                              .add("las", &R::las)
                              .add("flights", &R::flights)
                              .add("crowns", &R::crowns);
  return all;
}

const Keywords<workflows::ImageFiles>& image_keywords() {
  using R = workflows::ImageFiles;
  static const auto all = Keywords<R>()
                              .add("images", &R::images)
                              .add("cameras", &R::cameras)
                              .add("dem", &R::dem)
                              .add("crs", &R::crs)
                              .add("height_sd", &R::height_sd);
  return all;
}

const Keywords<workflows::SimulateRequest>& simulate_keywords() {
  using R = workflows::SimulateRequest;
  static const auto all = Keywords<R>()
                              .add("scenario", &R::scenario)
                              .add("folder", &R::folder)
                              .add("seed", &R::seed)
                              .add("drive_seed", &R::drive_seed)
                              .add("drive_only", &R::drive_only);
  return all;
}

/// Returns (report as JSON, landmarks by type, whether the map was written, exit code).
py::tuple run(const std::string& job_file, const std::string& folder,
              const std::vector<std::string>& settings, const py::dict& keywords, py::object progress,
              py::object message) {
  const workflows::MapRequest request = run_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::MapResult made = [&] {
    const py::gil_scoped_release no_gil;
    pipeline::Job job = workflows::load_job(job_file, settings);
    if (!folder.empty()) job.pipeline.base_folder = folder;
    return workflows::make_map(job, request, callbacks);
  }();
  return py::make_tuple(pipeline::report_as_json(made.report), made.landmarks, made.written,
                        made.exit_code());
}

/// Returns the job of a shortcut ("peaks", "craters", "trees" or "buildings", with poles and trees) as JSON
/// with every option filled in.
std::string shortcut_job(const std::string& command, const std::vector<std::string>& files,
                         const py::dict& canopy) {
  pipeline::Pipeline stages(workflows::all_stages());
  if (command == "peaks") workflows::add_mountain_top_stages(stages, files);
  if (command == "craters") workflows::add_crater_stages(stages, files);
  if (command == "trees") workflows::add_tree_stages(stages, canopy_keywords().request(canopy));
  if (command == "buildings")
    workflows::add_building_stages(stages, canopy_keywords().request(canopy), {.poles = true, .trees = true});
  return pipeline::job_as_json(command, stages);
}

using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Writes a 2-D array as a GeoTIFF. `place` is x and y of the first cell's centre and the steps to the next
/// column and row; an empty CRS is a local one.
void write_raster(const std::string& path, const FloatArray& cells, const std::array<double, 4>& place,
                  const std::string& crs) {
  Grid<float> grid(cells.shape(1), cells.shape(0));
  std::copy_n(cells.data(), cells.size(), grid.row(0).data());
  const Georeference where{.crs = crs.empty() ? Crs::local() : Crs::from_text(crs),
                           .x0 = place[0],
                           .y0 = place[1],
                           .dx = place[2],
                           .dy = place[3]};
  const py::gil_scoped_release no_gil;
  exporters::write_raster(path, grid, where);
}

/// Returns the job of `waymark images` likewise; `find` is a list such as "rocks,craters".
std::string image_job(const py::dict& keywords, const std::string& find) {
  pipeline::Pipeline stages(workflows::all_stages());
  workflows::add_image_stages(stages, image_keywords().request(keywords), workflows::parse_image_finds(find));
  return pipeline::job_as_json("images", stages);
}

std::string stages_as_json() {
  std::string text;
  const pipeline::Registry& stages = workflows::all_stages();
  for (const std::string& name : stages.names())
    text += (text.empty() ? "{\"" : ",\"") + name + "\":" + pipeline::stage_as_json(stages.at(name));
  return text + "}";
}

py::dict simulate(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::SimulateRequest request = simulate_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::SimulateResult made = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::simulate(request, callbacks);
  }();
  return py::dict(py::arg("images") = made.images, py::arg("rocks") = made.rocks,
                  py::arg("craters") = made.craters, py::arg("trees") = made.trees);
}

const Keywords<workflows::MergeRequest>& merge_keywords() {
  using R = workflows::MergeRequest;
  static const auto all = Keywords<R>()
                              .add("maps", &R::maps)
                              .add("output", &R::result)
                              .add("aoi", &R::aoi)
                              .add("changes", &R::changes)
                              .add("max_move", &R::max_move);
  return all;
}

py::dict merge(const py::dict& keywords, py::object progress, py::object message) {
  const workflows::MergeRequest request = merge_keywords().request(keywords);
  const workflows::Callbacks callbacks = python_callbacks(std::move(progress), std::move(message));
  const workflows::MergeResult made = [&] {
    const py::gil_scoped_release no_gil;
    return workflows::merge_maps(request, callbacks);
  }();
  py::dict counts(py::arg("landmarks") = made.landmarks, py::arg("fused") = made.fused,
                  py::arg("identical") = made.identical);
  if (!request.changes) return counts;
  for (const auto& [name, count] : {std::pair{"gone", made.gone},
                                    {"new", made.appeared},
                                    {"moved", made.moved},
                                    {"unchanged", made.unchanged},
                                    {"not_covered", made.not_covered}})
    counts[name] = count;
  return counts;
}

}  // namespace

void bind_mapping(py::module_& module) {
  module.def("run", &run, py::arg("job_file"), py::arg("folder"), py::arg("settings"), py::arg("keywords"),
             py::arg("progress"), py::arg("message"));
  module.def("run_keywords", [] { return run_keywords().defaults(); });
  module.def("shortcut_job", &shortcut_job, py::arg("command"), py::arg("files"), py::arg("canopy"));
  module.def("image_job", &image_job, py::arg("keywords"), py::arg("find"));
  module.def("images_keywords", [] { return image_keywords().defaults(); });
  module.def("canopy_keywords", [] { return canopy_keywords().defaults(); });
  module.def("write_raster", &write_raster, py::arg("path"), py::arg("cells"), py::arg("place"),
             py::arg("crs"));
  module.def("stages_as_json", &stages_as_json);
  module.def("simulate", &simulate, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("merge", &merge, py::arg("keywords"), py::arg("progress"), py::arg("message"));
  module.def("merge_keywords", [] { return merge_keywords().defaults(); });
  module.def("simulate_keywords", [] { return simulate_keywords().defaults(); });
}

}  // namespace waymark::python
