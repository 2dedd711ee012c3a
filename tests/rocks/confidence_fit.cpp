// SPDX-License-Identifier: Apache-2.0
#include "tests/rocks/confidence_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/random.hpp"
#include "pipeline/rocks/find_shadow_rocks.hpp"
#include "tests/rocks/made_view.hpp"
#include "tests/rocks/rock_score.hpp"
namespace waymark::testing {
namespace {

constexpr std::size_t kHidden = 16, kInputs = kEvidenceCount;
constexpr std::size_t kWeights = kHidden * (kInputs + 2) + 1;  // inputs and bias, output weights and bias

struct Network {
  std::array<double, kInputs> mean{}, sd{};
  std::array<double, kWeights> w{};
};

std::array<double, kHidden> hidden_of(const std::array<double, kWeights>& w,
                                      const std::array<double, kInputs>& in) {
  std::array<double, kHidden> hidden{};
  for (std::size_t h = 0; h < kHidden; ++h) {
    const double* row = &w[h * (kInputs + 1)];
    double sum = row[kInputs];
    for (std::size_t i = 0; i < kInputs; ++i) sum += row[i] * in[i];
    hidden[h] = std::tanh(sum);
  }
  return hidden;
}

void append_numbers(std::string& text, const char* name, const double* values, std::size_t count) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "inline constexpr float %s[] = {", name);
  text += buffer;
  for (std::size_t i = 0; i < count; ++i) {
    std::snprintf(buffer, sizeof buffer, "%s%.5gF", i == 0 ? "" : ", ", values[i]);
    std::string number = buffer + (i == 0 ? 0 : 2);
    if (number.find_first_of(".e") == std::string::npos) number.insert(number.size() - 1, ".0");
    text += (i == 0 ? "" : i % 12 == 0 ? ",\n    " : ", ") + number;
  }
  text += "};\n";
}

}  // namespace

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
  scene.log_uniform = random.chance(0.4);
  scene.min_height = 0.25;
  scene.max_height = 0.8;
  scene.slope = {random.uniform(0, 15)};
  scene.downhill = {random.uniform(0, 360)};
  if (random.chance(0.55)) {
    scene.dunes = random.log_uniform(0.2, 2.5);
    scene.dune_length = random.log_uniform(6, 40);
  }
  if (random.chance(0.55)) scene.craters = random.log_uniform(0.03, 0.4);
  scene.roughness = random.log_uniform(0.01, 0.15);
  scene.albedo = random.log_uniform(0.01, 0.08);
  scene.skylight = random.uniform(0.01, 0.3);
  scene.haze = random.chance(0.3) ? random.uniform(0.1, 0.4) : random.uniform(0, 0.1);
  scene.blur = random.uniform(0.3, 1.2);
  scene.noise = random.log_uniform(0.002, 0.04);
  scene.sunlit = random.uniform(60, 160);
  scene.lunar = random.chance(0.6);
  scene.quantise = random.chance(0.7);
  return scene;
}

std::vector<ConfidenceSample> confidence_samples(int number, bool made) {
  MadeView view;
  if (made) {
    view = made_view(number);
  } else {
    const RockScene scene = random_scene(number);
    view = {render(scene), to_radians(scene.sun_angle).value,
            to_radians(Degrees{90 - scene.incidence.value})};
  }
  const RockImage& image = view.image;
  Random random(static_cast<std::uint64_t>(number), "what the detector is told");
  RockSearch search;
  const double sun = view.sun_angle;
  const double told = sun + (random.chance(0.5) ? random.normal(0, 0.06) : 0);
  if (random.chance(0.6)) search.sun_elevation = view.elevation;
  const auto judged = judge_scales(image.pixels, search, Radians{told});
  std::vector<ConfidenceSample> samples;
  std::vector<Detection> spots;
  for (const JudgedRock& one : judged) {
    Detection spot;
    spot.outline.x = one.scale * (one.rock.x + 0.5) - 0.5;
    spot.outline.y = one.scale * (one.rock.y + 0.5) - 0.5;
    spot.outline.major = spot.outline.minor = 2 * one.scale * one.rock.size.radius;
    spot.shadow_reach = Measured{one.scale * one.rock.size.reach, 1};
    spots.push_back(spot);
  }
  const RockMatch match = match_rocks(image, spots, sun);
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const double diameter = spots[i].outline.diameter();
    const TrueRockInImage* nearest = nullptr;
    double best = 1;  // share of the matching radius
    for (const auto& rock : image.rocks) {
      const double d = std::hypot(rock.x - spots[i].outline.x, rock.y - spots[i].outline.y) /
                       std::max(0.75 * rock.diameter, 2.0);
      if (d < best) {
        best = d;
        nearest = &rock;
      }
    }
    // A rock seen again at a coarser scale is no false alarm: repeats are taken out later.
    const bool alike = nearest != nullptr && diameter > 0.45 * nearest->diameter - 0.5 &&
                       diameter < 2.2 * nearest->diameter + 0.8;
    const bool rock = alike && (match.rock_of[i] >= 0 || judged[i].scale > 1);
    const double margin = 3;
    if (!rock && (spots[i].outline.x < margin || spots[i].outline.y < margin ||
                  spots[i].outline.x > static_cast<double>(image.pixels.columns() - 1) - margin ||
                  spots[i].outline.y > static_cast<double>(image.pixels.rows() - 1) - margin))
      continue;  // its rock may stand outside
    samples.push_back({number, rock, diameter, judged[i].evidence});
  }
  // At most this many of one scene, at random: scenes count alike, crowded or bare.
  constexpr std::size_t kMostPerScene = 300;
  for (std::size_t i = 0; i < samples.size() && i < kMostPerScene; ++i)
    std::swap(samples[i], samples[i + random.below(samples.size() - i)]);
  if (samples.size() > kMostPerScene) samples.resize(kMostPerScene);
  return samples;
}

std::string fit_confidence(const std::vector<ConfidenceSample>& samples) {
  Network network;
  for (std::size_t i = 0; i < kInputs; ++i) {
    double sum = 0, squares = 0;
    for (const auto& s : samples) sum += s.evidence[i];
    network.mean[i] = sum / static_cast<double>(samples.size());
    for (const auto& s : samples) squares += std::pow(s.evidence[i] - network.mean[i], 2);
    network.sd[i] = std::sqrt(squares / static_cast<double>(samples.size())) + 1e-6;
  }
  Random random(1, "confidence network");
  for (double& w : network.w) w = random.normal(0, 0.3);
  // Adam (Kingma & Ba 2015), batches of 64, the step shrinking to nothing; weights pulled to 0 a little.
  constexpr int kRounds = 60;
  constexpr std::size_t kBatch = 64;
  std::array<double, kWeights> first{}, second{};
  std::vector<std::size_t> order(samples.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  int step = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    const double rate = 0.004 * (1 - static_cast<double>(round) / kRounds);
    for (std::size_t from = 0; from + kBatch <= order.size(); from += kBatch) {
      std::array<double, kWeights> slope{};
      for (std::size_t k = from; k < from + kBatch; ++k) {
        const auto& sample = samples[order[k]];
        std::array<double, kInputs> in{};
        for (std::size_t i = 0; i < kInputs; ++i)
          in[i] = (sample.evidence[i] - network.mean[i]) / network.sd[i];
        const auto hidden = hidden_of(network.w, in);
        const double* out = &network.w[kHidden * (kInputs + 1)];
        double sum = out[kHidden];
        for (std::size_t h = 0; h < kHidden; ++h) sum += out[h] * hidden[h];
        const double error = 1 / (1 + std::exp(-sum)) - (sample.rock ? 1 : 0);
        double* out_slope = &slope[kHidden * (kInputs + 1)];
        out_slope[kHidden] += error;
        for (std::size_t h = 0; h < kHidden; ++h) {
          out_slope[h] += error * hidden[h];
          const double back = error * out[h] * (1 - hidden[h] * hidden[h]);
          double* row = &slope[h * (kInputs + 1)];
          for (std::size_t i = 0; i < kInputs; ++i) row[i] += back * in[i];
          row[kInputs] += back;
        }
      }
      ++step;
      for (std::size_t i = 0; i < kWeights; ++i) {
        const double g = slope[i] / kBatch + 2e-4 * network.w[i];
        first[i] = 0.9 * first[i] + 0.1 * g;
        second[i] = 0.999 * second[i] + 0.001 * g * g;
        const double m = first[i] / (1 - std::pow(0.9, step)), v = second[i] / (1 - std::pow(0.999, step));
        network.w[i] -= rate * m / (std::sqrt(v) + 1e-8);
      }
    }
  }
  std::string text =
      "// SPDX-License-Identifier: Apache-2.0\n"
      "// Made by tests/rocks (test RockConfidence.DISABLED_Fit); do not edit.\n"
      "#pragma once\n"
      "namespace waymark::rock_network {\n\n"
      "// Mean and standard deviation of each evidence; then per hidden unit its weights and bias; then the "
      "output's.\n";
  append_numbers(text, "kMean", network.mean.data(), kInputs);
  append_numbers(text, "kSd", network.sd.data(), kInputs);
  append_numbers(text, "kHidden", network.w.data(), kHidden * (kInputs + 1));
  append_numbers(text, "kOut", &network.w[kHidden * (kInputs + 1)], kHidden + 1);
  return text + "\n}  // namespace waymark::rock_network\n";
}

}  // namespace waymark::testing
