// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/rock_training.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
namespace waymark::pipeline {
namespace {

constexpr Eigen::Index kUnits = 48, kInputs = kEvidenceCount, kOutputs = kRockOutputs;

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
void slope_of(const RockExample& sample, const float* out, float* slope) {
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

}  // namespace

RockNetwork train_rock_network(const std::vector<RockExample>& samples, const RockTraining& training) {
  constexpr Eigen::Index kBatch = 64;
  const auto count = static_cast<Eigen::Index>(samples.size());
  if (count < kBatch)
    throw Error(ErrorCode::usage,
                fmt::format("{} dark spots are too few to train on, {} are needed", count, kBatch), "",
                "render more scenes (--scenes)");
  Matrix in(count, kInputs + 1);
  double rocks = 0;
  for (Eigen::Index n = 0; n < count; ++n) {
    const RockExample& sample = samples[static_cast<std::size_t>(n)];
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
  Random random(training.seed, "rock network");
  Layer hidden(kInputs, kUnits, 0.15, random), out(kUnits, kOutputs, 0.1, random);
  std::vector<std::size_t> order(samples.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  int step = 0;
  Matrix batch(kBatch, kInputs + 1), middle(kBatch, kUnits + 1), back(kBatch, kOutputs);
  for (int round = 0; round < training.rounds; ++round) {
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.uniform_index(i)]);
    const double rate = 0.003 * (1 - static_cast<double>(round) / training.rounds);
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
  RockNetwork fitted;
  fitted.rock_prior = static_cast<float>(rocks / static_cast<double>(count));
  fitted.mean.assign(mean.data(), mean.data() + kInputs);
  fitted.sd.assign(sd.data(), sd.data() + kInputs);
  fitted.hidden.assign(hidden.w.data(), hidden.w.data() + hidden.w.size());
  fitted.out.assign(out.w.data(), out.w.data() + out.w.size());
  return fitted;
}

RockNetwork average_networks(const RockNetwork& a, const RockNetwork& b) {
  constexpr auto inputs = static_cast<std::size_t>(kInputs), outputs = static_cast<std::size_t>(kOutputs);
  const std::size_t units_a = a.hidden.size() / (inputs + 1), units_b = b.hidden.size() / (inputs + 1);
  RockNetwork both;
  both.rock_prior = (a.rock_prior + b.rock_prior) / 2, both.mean = a.mean, both.sd = a.sd;
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

}  // namespace waymark::pipeline
