// SPDX-License-Identifier: Apache-2.0
#include "testbed/scene_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/random.hpp"
#include "testbed/landing/flight.hpp"
#include "testbed/noise.hpp"

namespace waymark::testbed {

using Json = nlohmann::ordered_json;

namespace {

// Landings begin at the start of 2030.
std::string time_of_landing(double seconds) {
  const auto milliseconds = std::llround(seconds * 1e3);
  const auto second = milliseconds / 1000;
  return fmt::format("2030-01-{:02}T{:02}:{:02}:{:02}.{:03}Z", 1 + second / 86400, second / 3600 % 24,
                     second / 60 % 60, second % 60, milliseconds % 1000);
}

}  // namespace

std::string camera_file(const Scenario& scenario, const std::vector<Shot>& shots, bool exact) {
  const Camera camera = camera_of(scenario.lens);
  const Sun& sun = scenario.exposure.sun;
  Json file{{"waymark_cameras", 1},
            {"frame", {{"axes", "grid"}, {"crs", scenario.crs}}},
            {"sun",
             {{"azimuth", std::fmod(sun.azimuth.value + 360, 360)},
              {"elevation", sun.elevation.value},
              {"sd", sun.sd.value}}}};
  file["cameras"]["lens"] = {
      {"columns", camera.columns},
      {"rows", camera.rows},
      {"fx", camera.fx},
      {"fy", camera.fy},
      {"cx", camera.cx},
      {"cy", camera.cy},
      {"lens", "brown"},
      {"distortion", std::vector<double>(camera.distortion.begin(), camera.distortion.begin() + 5)}};
  // Times matter where rows are taken one after the other.
  const double readout_time = scenario.exposure.readout_time;
  if (readout_time > 0) file["cameras"]["lens"]["readout_time"] = readout_time;
  Json& images = file["images"] = Json::array();
  for (const Shot& shot : shots) {
    const Eigen::Isometry3d& pose = (exact ? shot.view.grid_from_camera : shot.reported).transform;
    const Eigen::Matrix3d& r = pose.linear();
    Json image{{"name", shot.name}, {"camera", "lens"}};
    image["centre"] = {pose.translation().x(), pose.translation().y(), pose.translation().z()};
    image["rotation"] = {
        {r(0, 0), r(0, 1), r(0, 2)}, {r(1, 0), r(1, 1), r(1, 2)}, {r(2, 0), r(2, 1), r(2, 2)}};
    if (!exact) {
      image["rotation_sd"] = scenario.pose_errors.attitude_sd.value;
      image["position_sd"] = scenario.pose_errors.position_sd;
    }
    if (const auto m = true_camera(shot, readout_time).motion)  // what gyroscopes say is exact enough
      image["motion"] = {{"shift", {m->shift.x(), m->shift.y(), m->shift.z()}},
                         {"turn", {m->turn.x(), m->turn.y(), m->turn.z()}}};
    if (readout_time > 0 && shot.time) image["taken_utc"] = time_of_landing(*shot.time);
    images.push_back(std::move(image));
  }
  return file.dump(1) + "\n";
}

SimulatedDem simulate_dem(const DemModel& model, const Scene& scene, std::string_view errors) {
  const Terrain& ground = scene.terrain;
  const double cell = model.cell;
  const auto count = [&](std::int64_t nodes) {
    return static_cast<std::int64_t>(std::floor(double(nodes - 1) * ground.step_x() / cell)) + 1;
  };
  SimulatedDem dem{Grid<float>(count(ground.heights().columns()), count(ground.heights().rows())), 0, 0,
                   cell};
  // Centred, so that the remainder is split between both sides.
  dem.x0 = scene.ground.east - double(dem.heights.columns() - 1) * cell / 2;
  dem.y0 = scene.ground.north + double(dem.heights.rows() - 1) * cell / 2;
  const double length = std::max(model.correlation, 2 * cell);
  const auto seed = static_cast<std::uint32_t>(named_seed(scene.seed, errors));
  // A cell is the mean of the terrain within it, as in stereo matching.
  const int samples = std::max(1, static_cast<int>(std::lround(cell / ground.step_x())));
  for (std::int64_t j = 0; j < dem.heights.rows(); ++j)
    for (std::int64_t i = 0; i < dem.heights.columns(); ++i) {
      const double x = dem.x0 + double(i) * cell, y = dem.y0 - double(j) * cell;
      double sum = 0;
      int seen = 0;
      for (int b = 0; b < samples; ++b)
        for (int a = 0; a < samples; ++a)
          if (const auto h = ground.height(x + ((a + 0.5) / samples - 0.5) * cell,
                                           y + ((b + 0.5) / samples - 0.5) * cell))
            sum += *h, ++seen;
      const double error =
          model.height_sd *
          gradient_noise((x - scene.ground.east) / length, (y - scene.ground.north) / length, seed).value;
      dem.heights(i, j) = seen > 0 ? static_cast<float>(sum / seen + error) : std::nanf("");
    }
  return dem;
}

}  // namespace waymark::testbed
