// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rock_training_data.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/rocks/find_shadow_rocks.hpp"

namespace waymark::workflows {
namespace {

bool clear_of_border(const Pixels& pixels, double x, double y, double diameter, double reach,
                     double sun_angle) {
  const double margin = 0.5 * diameter + 2;
  for (const double t : {0.0, reach + 0.5 * diameter}) {
    const double u = x - t * std::cos(sun_angle), v = y - t * std::sin(sun_angle);
    if (u < margin || v < margin || u > static_cast<double>(pixels.columns() - 1) - margin ||
        v > static_cast<double>(pixels.rows() - 1) - margin)
      return false;
  }
  return true;
}

constexpr std::size_t kMaxPerImage = 400;  // examples

/// Scene with random sun, relief, dunes, craters, haze, blur, noise and rocks.
RockScene random_scene(int number) {
  Random random(static_cast<std::uint64_t>(number), "fit");
  RockScene scene;
  scene.columns = scene.rows = 256;
  scene.seed = static_cast<std::uint64_t>(number) + 100000;
  scene.shape = RockScene::Shape::mixed;
  scene.incidence = {random.uniform(28, 76)};
  scene.sun_angle = {random.uniform(0, 360)};
  scene.cover = random.log_uniform(0.004, 0.08);
  scene.min_diameter = 1;
  scene.max_diameter = random.log_uniform(5, 40);
  scene.log_uniform = random.bernoulli(0.4);
  scene.min_height = 0.25;
  scene.max_height = 0.8;
  scene.slope = {random.uniform(0, 15)};
  scene.downhill = {random.uniform(0, 360)};
  if (random.bernoulli(0.55)) {
    scene.dunes = random.log_uniform(0.2, 2.5);
    scene.dune_length = random.log_uniform(6, 40);
  }
  if (random.bernoulli(0.55)) scene.craters = random.log_uniform(0.03, 0.4);
  scene.roughness = random.log_uniform(0.01, 0.15);
  scene.albedo = random.log_uniform(0.01, 0.08);
  scene.skylight = random.uniform(0.01, 0.3);
  scene.haze = random.bernoulli(0.3) ? random.uniform(0.1, 0.4) : random.uniform(0, 0.1);
  scene.blur = random.uniform(0.3, 1.2);
  scene.noise = random.log_uniform(0.002, 0.04);
  scene.sunlit = random.uniform(60, 160);
  scene.lunar = random.bernoulli(0.6);
  scene.quantise = random.bernoulli(0.7);
  return scene;
}

/// Large rocks of one shape, or of all, under a sun 13 to 28 degrees high; the rest at random.
RockScene low_sun_scene(int number) {
  Random random(static_cast<std::uint64_t>(number), "low sun");
  RockScene scene = random_scene(number + 10000);
  using Shape = RockScene::Shape;
  constexpr Shape kShapes[] = {Shape::ellipsoid, Shape::irregular, Shape::cylinder, Shape::mixed};
  scene.shape = kShapes[number % 4];
  scene.incidence = {random.uniform(62, 77)};
  scene.cover = random.uniform(0.02, 0.08);
  scene.min_diameter = random.log_uniform(1.5, 6);
  scene.max_diameter = random.uniform(12, 40);
  scene.log_uniform = true;
  return scene;
}

SyntheticView scene_view(const RockScene& scene) {
  return {render(scene), to_radians(scene.sun_angle).value, to_radians(Degrees{90 - scene.incidence.value})};
}

struct RockImageSource {
  enum class Kind { view, scene, low_sun, oblique } kind;
  int index;                         // of the image
  int number;                        // seed of the choice of examples
  bool first = true, second = true;  // sets that receive the examples
};

std::vector<RockImageSource> image_sources(int views) {
  using From = RockImageSource::Kind;
  const auto share = [views](int count) { return (count * views + kRockViews - 1) / kRockViews; };
  std::vector<RockImageSource> all;
  for (int k = 0; k < views; ++k) all.push_back({From::view, k, k});
  // Scenes are fewer, so each is used twice, with different knowledge of the sun.
  for (int j = 0; j < 2; ++j)
    for (int k = 0; k < share(45); ++k) all.push_back({From::scene, k, k + 1000 * j, k != 18});
  for (int j = 0; j < 2; ++j)
    for (int k = 0; k < share(24); ++k) all.push_back({From::low_sun, k, k + 1000 * j});
  for (int k = 0; k < share(150); ++k) all.push_back({From::oblique, k, k + 100000});
  for (int k = 0; k < share(150); ++k) all.push_back({From::oblique, k, k + 101000, true, false});
  for (int k = share(150); k < share(330); ++k) all.push_back({From::oblique, k, k + 100000, false, true});
  return all;
}

SyntheticView render_source(const RockImageSource& source) {
  switch (source.kind) {
    case RockImageSource::Kind::view:
      return synthetic_view(source.index);
    case RockImageSource::Kind::scene:
      return scene_view(random_scene(source.index));
    case RockImageSource::Kind::low_sun:
      return scene_view(low_sun_scene(source.index));
    case RockImageSource::Kind::oblique:
      break;
  }
  return leaning_view(source.index);
}

}  // namespace

RockMatch match_rocks(const RockImage& image, const std::vector<Detection>& found, double sun_angle) {
  RockMatch match{std::vector<int>(image.rocks.size(), -1), std::vector<int>(found.size(), -1), {}, {}};
  for (std::size_t i = 0; i < image.rocks.size(); ++i) {
    const auto& rock = image.rocks[i];
    double best = std::max(0.75 * rock.diameter, 2.0);
    int who = -1;
    for (std::size_t j = 0; j < found.size(); ++j) {
      if (match.rock_of[j] >= 0) continue;
      const double d = std::hypot(found[j].outline.x - rock.x, found[j].outline.y - rock.y);
      if (d <= best) {
        best = d;
        who = static_cast<int>(j);
      }
    }
    match.detection_of[i] = who;
    if (who >= 0) match.rock_of[static_cast<std::size_t>(who)] = static_cast<int>(i);
    match.rock_counts.push_back(
        clear_of_border(image.pixels, rock.x, rock.y, rock.diameter, rock.reach, sun_angle));
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    const auto& d = found[j];
    const bool clear = clear_of_border(image.pixels, d.outline.x, d.outline.y, d.outline.diameter(),
                                       d.shadow_reach ? d.shadow_reach->value : 0, sun_angle);
    const int rock = match.rock_of[j];
    match.detection_counts.push_back(clear &&
                                     (rock < 0 || match.rock_counts[static_cast<std::size_t>(rock)]));
  }
  return match;
}

std::vector<pipeline::RockExample> rock_examples(const SyntheticView& view, int number,
                                                 std::size_t max_count) {
  const RockImage& image = view.image;
  // The name seeds the shipped network, so it stays although a word of it is not used any more.
  Random random(static_cast<std::uint64_t>(number),
                "what the detector is to"
                "ld");
  pipeline::RockSearch search;
  search.displacement = view.displacement;
  const double sun = view.sun_angle;
  const double assumed_sun = sun + (random.bernoulli(0.5) ? random.normal(0, 0.06) : 0);
  if (random.bernoulli(0.6)) search.sun_elevation = view.elevation;
  const auto judged = pipeline::score_scales(image.pixels, search, Radians{assumed_sun}).spots;
  std::vector<pipeline::RockExample> samples;
  std::vector<Detection> spots;
  for (const pipeline::ScoredRock& one : judged) {
    Detection spot;
    spot.outline.x = one.scale * (one.position().x() + 0.5) - 0.5;
    spot.outline.y = one.scale * (one.position().y() + 0.5) - 0.5;
    spot.outline.major = spot.outline.minor = 2 * one.scale * one.rock.size.radius;
    spot.shadow_reach = MeasuredValue{one.scale * one.rock.size.reach, 1};
    spots.push_back(spot);
  }
  const RockMatch match = match_rocks(image, spots, sun);
  const pipeline::LightFrame light = pipeline::LightFrame::of(Radians{assumed_sun});
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const double diameter = spots[i].outline.diameter();
    const TrueRockInImage* nearest = nullptr;
    double best = 1;  // fraction of the matching radius
    for (const auto& rock : image.rocks) {
      const double d = std::hypot(rock.x - spots[i].outline.x, rock.y - spots[i].outline.y) /
                       std::max(0.75 * rock.diameter, 2.0);
      if (d < best) {
        best = d;
        nearest = &rock;
      }
    }
    // A rock found again at a coarser scale is no false alarm, since duplicates are removed later.
    const bool alike = nearest != nullptr && diameter > 0.45 * nearest->diameter - 0.5 &&
                       diameter < 2.2 * nearest->diameter + 0.8;
    const bool rock = alike && (match.rock_of[i] >= 0 || judged[i].scale > 1);
    const double margin = 3;
    if (!rock && (spots[i].outline.x < margin || spots[i].outline.y < margin ||
                  spots[i].outline.x > static_cast<double>(image.pixels.columns() - 1) - margin ||
                  spots[i].outline.y > static_cast<double>(image.pixels.rows() - 1) - margin))
      continue;  // its rock may stand outside
    pipeline::RockExample sample{.rock = rock, .evidence = judged[i].evidence};
    if (rock) {
      const pipeline::RockSize& size = judged[i].rock.size;
      const double unit = judged[i].scale * pipeline::position_unit(size.radius);
      const double dx = nearest->x - spots[i].outline.x, dy = nearest->y - spots[i].outline.y;
      sample.log_radius = std::clamp(std::log(nearest->diameter / diameter), -1.2, 1.2);
      sample.log_reach = std::clamp(std::log(nearest->reach / (judged[i].scale * size.reach)), -1.4, 1.4);
      sample.along = light.along(dx, dy) / unit;
      sample.across = light.across(dx, dy) / unit;
    }
    samples.push_back(sample);
  }
  for (std::size_t i = 0; i < samples.size() && i < max_count; ++i)
    std::swap(samples[i], samples[i + random.uniform_index(samples.size() - i)]);
  if (samples.size() > max_count) samples.resize(max_count);
  return samples;
}

RockTrainingSets make_rock_examples(int views, int threads, const pipeline::ProgressListener& progress) {
  const std::vector<RockImageSource> sources = image_sources(views);
  std::vector<std::vector<pipeline::RockExample>> examples(sources.size());
  pipeline::ProgressMeter meter(progress, "render rocks", static_cast<std::int64_t>(sources.size()));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, sources.size(), [&](std::size_t i) {
      examples[i] = rock_examples(render_source(sources[i]), sources[i].number, kMaxPerImage);
      meter.add(1);
    });
  });
  meter.finish();
  RockTrainingSets sets;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (sources[i].first) sets.first.insert(sets.first.end(), examples[i].begin(), examples[i].end());
    if (sources[i].second) sets.second.insert(sets.second.end(), examples[i].begin(), examples[i].end());
  }
  return sets;
}

}  // namespace waymark::workflows
