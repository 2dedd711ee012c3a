// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/rocks/network_fit.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/random.hpp"
#include "pipeline/rocks/find_shadow_rocks.hpp"
#include "tests/pipeline/rocks/rock_score.hpp"
#include "tests/pipeline/rocks/synthetic_view.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

constexpr Eigen::Index kUnits = 48, kInputs = kEvidenceCount, kOutputs = 8;

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Weights of one layer, with their moments (Adam; Kingma & Ba 2015).
struct Layer {
  Matrix w, slope, first, second;

  Layer(Eigen::Index inputs, Eigen::Index outputs, double sd, Random& random)
      : w(inputs + 1, outputs), slope(w.rows(), w.cols()) {
    for (Eigen::Index i = 0; i < w.size(); ++i) w.data()[i] = static_cast<float>(random.normal(0, sd));
    w.row(inputs).setZero();
    first = second = Matrix::Zero(w.rows(), w.cols());
  }
  void step(int number, double rate, float decay) {
    slope += decay * w;
    first = 0.9F * first + 0.1F * slope;
    second = 0.999F * second + 0.001F * slope.cwiseAbs2();
    const auto a = static_cast<float>(rate / (1 - std::pow(0.9, number)));
    const auto b = static_cast<float>(1 / (1 - std::pow(0.999, number)));
    w.array() -= a * first.array() / ((b * second.array()).sqrt() + 1e-8F);
  }
};

// Slope of the loss by the outputs: cross entropy of being a rock; for rocks also the negative logarithm of a
// normal density, times the deviation (Seitzer et al. 2022, beta 0.5), so that what is known sharply does not
// outweigh all else; residuals beyond three deviations pull no harder.
void slope_of(const NetworkSample& sample, const float* out, float* slope) {
  std::fill_n(slope, kOutputs, 0.0F);
  slope[0] = 1 / (1 + std::exp(-out[0])) - (sample.rock ? 1.0F : 0.0F);
  if (!sample.rock) return;
  const double truth[] = {sample.log_radius, sample.log_reach, sample.along, sample.across};
  for (int k = 0; k < 4; ++k) {
    const float sd = std::exp(std::clamp(out[4 + k], -4.0F, 1.0F));
    const float z = (static_cast<float>(truth[k]) - (k < 3 ? out[1 + k] : 0.0F)) / sd;
    const float held = std::clamp(z, -3.0F, 3.0F);
    if (k < 3) slope[1 + k] = -0.5F * held;
    slope[4 + k] = 0.5F * sd * (1 - z * held);
  }
}

void append_numbers(std::string& text, const char* name, const std::vector<float>& values) {
  std::string line = std::string("inline constexpr float ") + name + "[] = {";
  for (std::size_t i = 0; i < values.size(); ++i) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.4g", static_cast<double>(values[i]));
    std::string number = buffer;
    if (number.find_first_of(".e") == std::string::npos) number += ".0";
    number += i + 1 < values.size() ? "F, " : "F};\n";
    if (line.size() + number.size() > 330) {  // below 300 lines
      text += line.substr(0, line.size() - 1) + "\n";
      line = "    ";
    }
    line += number;
  }
  text += line;
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

std::vector<NetworkSample> rock_samples(const SyntheticView& view, int number, std::size_t most) {
  const RockImage& image = view.image;
  Random random(static_cast<std::uint64_t>(number), "what the detector is told");
  RockSearch search;
  search.displacement = view.displacement;
  const double sun = view.sun_angle;
  const double told = sun + (random.bernoulli(0.5) ? random.normal(0, 0.06) : 0);
  if (random.bernoulli(0.6)) search.sun_elevation = view.elevation;
  const auto judged = score_scales(image.pixels, search, Radians{told});
  std::vector<NetworkSample> samples;
  std::vector<Detection> spots;
  for (const ScoredRock& one : judged) {
    Detection spot;
    spot.outline.x = one.scale * (one.position().x() + 0.5) - 0.5;
    spot.outline.y = one.scale * (one.position().y() + 0.5) - 0.5;
    spot.outline.major = spot.outline.minor = 2 * one.scale * one.rock.size.radius;
    spot.shadow_reach = MeasuredValue{one.scale * one.rock.size.reach, 1};
    spots.push_back(spot);
  }
  const RockMatch match = match_rocks(image, spots, sun);
  const LightFrame light = LightFrame::of(Radians{told});
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
    NetworkSample sample{.rock = rock, .evidence = judged[i].evidence};
    if (rock) {
      const RockSize& size = judged[i].rock.size;
      const double unit = judged[i].scale * position_unit(size.radius);
      const double dx = nearest->x - spots[i].outline.x, dy = nearest->y - spots[i].outline.y;
      sample.log_radius = std::clamp(std::log(nearest->diameter / diameter), -1.2, 1.2);
      sample.log_reach = std::clamp(std::log(nearest->reach / (judged[i].scale * size.reach)), -1.4, 1.4);
      sample.along = light.along(dx, dy) / unit;
      sample.across = light.across(dx, dy) / unit;
    }
    samples.push_back(sample);
  }
  for (std::size_t i = 0; i < samples.size() && i < most; ++i)
    std::swap(samples[i], samples[i + random.uniform_index(samples.size() - i)]);
  if (samples.size() > most) samples.resize(most);
  return samples;
}

FittedNetwork fit_network(const std::vector<NetworkSample>& samples) {
  const auto count = static_cast<Eigen::Index>(samples.size());
  Matrix in(count, kInputs + 1);
  double rocks = 0;
  for (Eigen::Index n = 0; n < count; ++n) {
    const NetworkSample& sample = samples[static_cast<std::size_t>(n)];
    for (Eigen::Index i = 0; i < kInputs; ++i)
      in(n, i) = static_cast<float>(sample.evidence[static_cast<std::size_t>(i)]);
    in(n, kInputs) = 1;
    rocks += sample.rock;
  }
  Eigen::RowVectorXf mean = in.colwise().mean(), sd(kInputs + 1);
  for (Eigen::Index i = 0; i < kInputs; ++i) {
    in.col(i).array() -= mean[i];
    sd[i] = std::sqrt(in.col(i).squaredNorm() / static_cast<float>(count)) + 1e-6F;
    in.col(i) = (in.col(i) / sd[i]).cwiseMax(-6.0F).cwiseMin(6.0F);
  }
  Random random(1, "rock network");
  Layer hidden(kInputs, kUnits, 0.15, random), out(kUnits, kOutputs, 0.1, random);
  constexpr int kRounds = 40;
  constexpr Eigen::Index kBatch = 64;
  std::vector<std::size_t> order(samples.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  int step = 0;
  Matrix batch(kBatch, kInputs + 1), middle(kBatch, kUnits + 1), back(kBatch, kOutputs);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.uniform_index(i)]);
    const double rate = 0.003 * (1 - static_cast<double>(round) / kRounds);
    for (Eigen::Index from = 0; from + kBatch <= count; from += kBatch) {
      for (Eigen::Index k = 0; k < kBatch; ++k)
        batch.row(k) = in.row(static_cast<Eigen::Index>(order[static_cast<std::size_t>(from + k)]));
      middle.leftCols(kUnits) = (batch * hidden.w).array().tanh();
      middle.col(kUnits).setOnes();
      const Matrix said = middle * out.w;
      for (Eigen::Index k = 0; k < kBatch; ++k)
        slope_of(samples[order[static_cast<std::size_t>(from + k)]], &said(k, 0), &back(k, 0));
      back /= static_cast<float>(kBatch);
      out.slope = middle.transpose() * back;
      const Matrix deeper =
          (back * out.w.topRows(kUnits).transpose()).array() * (1 - middle.leftCols(kUnits).array().square());
      hidden.slope = batch.transpose() * deeper;
      ++step;
      hidden.step(step, rate, 1e-4F);
      out.step(step, rate, 1e-4F);
    }
  }
  FittedNetwork fitted{
      .rock_prior = rocks / static_cast<double>(count), .mean = {}, .sd = {}, .hidden = {}, .out = {}};
  fitted.mean.assign(mean.data(), mean.data() + kInputs);
  fitted.sd.assign(sd.data(), sd.data() + kInputs);
  fitted.hidden.assign(hidden.w.data(), hidden.w.data() + hidden.w.size());
  fitted.out.assign(out.w.data(), out.w.data() + out.w.size());
  return fitted;
}

FittedNetwork average_networks(const FittedNetwork& a, const FittedNetwork& b) {
  constexpr auto inputs = static_cast<std::size_t>(kInputs), outputs = static_cast<std::size_t>(kOutputs);
  const std::size_t units_a = a.hidden.size() / (inputs + 1), units_b = b.hidden.size() / (inputs + 1);
  FittedNetwork both{
      .rock_prior = (a.rock_prior + b.rock_prior) / 2, .mean = a.mean, .sd = a.sd, .hidden = {}, .out = {}};
  std::vector<float> biases(b.hidden.end() - static_cast<std::ptrdiff_t>(units_b), b.hidden.end());
  for (std::size_t i = 0; i < inputs; ++i) {
    for (std::size_t h = 0; h < units_a; ++h) both.hidden.push_back(a.hidden[units_a * i + h]);
    for (std::size_t h = 0; h < units_b; ++h) {
      const float weight = b.hidden[units_b * i + h] / b.sd[i];
      both.hidden.push_back(weight * a.sd[i]);
      biases[h] += weight * (a.mean[i] - b.mean[i]);
    }
  }
  for (std::size_t h = 0; h < units_a; ++h) both.hidden.push_back(a.hidden[units_a * inputs + h]);
  both.hidden.insert(both.hidden.end(), biases.begin(), biases.end());
  for (std::size_t k = 0; k < outputs * units_a; ++k) both.out.push_back(a.out[k] / 2);
  for (std::size_t k = 0; k < outputs * units_b; ++k) both.out.push_back(b.out[k] / 2);
  for (std::size_t o = 0; o < outputs; ++o)
    both.out.push_back((a.out[outputs * units_a + o] + b.out[outputs * units_b + o]) / 2);
  return both;
}

std::string source_of(const FittedNetwork& network) {
  std::string text =
      "// SPDX-License-Identifier: Apache-2.0\n"
      "// Made by tests/rocks (test RockNetwork.DISABLED_Fit); do not edit.\n"
      "#pragma once\n"
      "#include <cstddef>\n"
      "// clang-format off\n"
      "namespace waymark::rock_network {\n\n"
      "inline constexpr std::size_t kOutputs = 8;\n"
      "// Share of rocks among the dark spots it was fitted on.\n";
  char line[80];
  std::snprintf(line, sizeof line, "inline constexpr float kRockPrior = %.4fF;\n", network.rock_prior);
  text += line;
  text +=
      "// Mean and deviation of each evidence; weights of the hidden units by input, their biases last; of "
      "the "
      "outputs by unit.\n";
  append_numbers(text, "kMean", network.mean);
  append_numbers(text, "kSd", network.sd);
  append_numbers(text, "kHidden", network.hidden);
  append_numbers(text, "kOut", network.out);
  return text + "\n}  // namespace waymark::rock_network\n";
}

}  // namespace waymark::test
