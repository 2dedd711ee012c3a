// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/tree_confidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <tuple>

#include "pipeline/vision/network_text.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kMinConfidence = 0.1, kMaxConfidence = 0.99;  // limits supported by the synthetic forests

double roughness_at(const CanopyWindow& raw, const CanopyWindow& smooth, const CanopyCell& top) {
  double squares = 0;
  int count = 0;
  for (std::int64_t r = -2; r <= 2; ++r)
    for (std::int64_t c = -2; c <= 2; ++c) {
      const CanopyCell cell{top.column + c, top.row + r};
      if (!raw.contains(cell) || raw.at(cell) == kNoCanopy || smooth.at(cell) == kNoCanopy) continue;
      const auto off = static_cast<double>(raw.at(cell) - smooth.at(cell));
      squares += off * off;
      ++count;
    }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

// Descent of the canopy on the straight line from one top to another, metres.
double drop_between(const CanopyWindow& smooth, const Treetop& from, const CanopyCell& to) {
  const std::int64_t columns = to.column - from.cell.column, rows = to.row - from.cell.row;
  const std::int64_t steps = std::max(std::abs(columns), std::abs(rows));
  float lowest = from.height;
  for (std::int64_t i = 1; i < steps; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(steps);
    const CanopyCell cell{from.cell.column + std::llround(part * static_cast<double>(columns)),
                          from.cell.row + std::llround(part * static_cast<double>(rows))};
    lowest = std::min(lowest, std::max(0.0F, smooth.at(cell)));
  }
  return static_cast<double>(from.height - lowest);
}

bool stands_over(const Treetop& a, const Treetop& b) {
  return std::tuple(-a.height, a.cell.row, a.cell.column) < std::tuple(-b.height, b.cell.row, b.cell.column);
}

}  // namespace

TopEvidence top_evidence(const CanopyWindow& raw, const CanopyWindow& smooth,
                         const std::vector<Treetop>& tops, std::size_t index) {
  const Treetop& top = tops[index];
  TopEvidence evidence{.height = static_cast<double>(top.height),
                       .roughness = roughness_at(raw, smooth, top.cell)};
  const auto rows = static_cast<std::int64_t>(kRivalReach / smooth.cell_height),
             columns = static_cast<std::int64_t>(kRivalReach / smooth.cell_width);
  double nearest = std::numeric_limits<double>::infinity();
  auto other = std::lower_bound(tops.begin(), tops.end(), top.cell.row - rows,
                                [](const Treetop& t, std::int64_t row) { return t.cell.row < row; });
  for (; other != tops.end() && other->cell.row <= top.cell.row + rows; ++other) {
    if (std::abs(other->cell.column - top.cell.column) > columns || !stands_over(*other, top)) continue;
    const double distance =
        std::hypot(static_cast<double>(other->cell.column - top.cell.column) * smooth.cell_width,
                   static_cast<double>(other->cell.row - top.cell.row) * smooth.cell_height);
    if (distance > kRivalReach) continue;
    const double drop = drop_between(smooth, top, other->cell) / std::max(evidence.height, 0.1);
    if (drop * distance >= nearest) continue;
    nearest = drop * distance;
    evidence.has_rival = true, evidence.distance = distance, evidence.drop = drop;
  }
  return evidence;
}

TreetopTerms regression_terms(const TopEvidence& e) {
  const double has_rival = e.has_rival ? 1 : 0;
  return {1,
          has_rival,
          has_rival * std::log(e.drop + 0.01),
          has_rival * std::log(std::max(e.distance, 0.1)),
          std::log(e.roughness + 0.02),
          std::log(std::max(e.height, 0.1))};
}

double tree_confidence(const TreeConfidenceModel& model, const TopEvidence& evidence, ForestType type) {
  const std::size_t index = type == ForestType::conifer ? 0 : type == ForestType::broadleaf ? 1 : 2;
  const TreetopTerms& weights = model.weights[index];
  const TreetopTerms terms = regression_terms(evidence);
  double odds = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) odds += weights[i] * terms[i];
  return std::clamp(1 / (1 + std::exp(-odds)), kMinConfidence, kMaxConfidence);
}

double tree_confidence(const TopEvidence& evidence, ForestType type) {
  return tree_confidence(built_in_tree_confidence(), evidence, type);
}

std::string as_text(const TreeConfidenceModel& model) {
  StoredNetwork stored;
  stored.kind = "treetops";
  stored.trained_on = model.trained_on;
  stored.layers = {{{5, 3}, {}, {}}};
  for (const TreetopTerms& weights : model.weights) {
    stored.layers[0].biases.push_back(weights[0]);
    stored.layers[0].weights.insert(stored.layers[0].weights.end(), weights.begin() + 1, weights.end());
  }
  return network_as_text(stored, {.digits = 6});
}

TreeConfidenceModel parse_tree_confidence(std::string_view text, const std::string& where) {
  const StoredNetwork stored = parse_network(text, "treetops", where, dense_layers_of(5));
  if (stored.layers.size() != 1 || stored.layers[0].outputs() != 3)
    refuse_network("treetops", "it has one layer, of three outputs", where);
  TreeConfidenceModel model;
  model.trained_on = stored.trained_on;
  for (std::size_t type = 0; type < 3; ++type) {
    model.weights[type][0] = stored.layers[0].biases[type];
    std::copy_n(stored.layers[0].weights.begin() + static_cast<std::ptrdiff_t>(5 * type), 5,
                model.weights[type].begin() + 1);
  }
  return model;
}

}  // namespace waymark::pipeline
