// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/stand_inventory.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace waymark::pipeline {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFarEdge = 5;  // standard deviations from the edge beyond which a position is certain
constexpr double kDominantPerHa = 100;

/// Tree that is in the stand with a probability above 0.
struct Member {
  const StandTree* tree = nullptr;
  std::size_t index = 0;
  bool counted = false;
  double weight = 0;  ///< number of trees it represents; 0 if not counted
  double weight_variance = 0;
  std::size_t recall_row = 0;  ///< only if there is a recall
};

double normal_below(double z) {
  return std::erfc(-z / std::numbers::sqrt2) / 2;
}

/// Row for a height; the first also applies below.
std::size_t recall_row_of(std::span<const RecallRow> rows, double height) {
  std::size_t row = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (height >= rows[i].height_from) row = i;
  return row;
}

std::vector<Member> members_of(std::span<const StandTree> trees, const StandPolygon& stand,
                               std::span<const RecallRow> recall) {
  const Eigen::AlignedBox2d box = bounds(stand);
  std::vector<Member> members;
  if (box.isEmpty()) return members;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const StandTree& tree = trees[i];
    const double reach = kFarEdge * tree.position_sd;
    if (box.squaredExteriorDistance(tree.position) > reach * reach) continue;
    Member member{.tree = &tree, .index = i, .counted = inside(stand, tree.position)};
    double within = member.counted ? 1 : 0;
    if (tree.position_sd > 0) {
      const double z = distance_to_edge(stand, tree.position) / tree.position_sd;
      within = normal_below(member.counted ? z : -z);
      if (!member.counted && z > kFarEdge) continue;
    } else if (!member.counted) {
      continue;
    }
    const double there = tree.confidence * within;
    member.weight = member.counted ? 1 : 0;
    member.weight_variance = there * (1 - there);
    if (!recall.empty()) {
      member.recall_row = recall_row_of(recall, tree.height);
      const double found = recall[member.recall_row].recall;
      member.weight *= tree.confidence / found;
      member.weight_variance = there * (1 - there + 1 - found) / (found * found);
    }
    members.push_back(member);
  }
  return members;
}

/// Contribution of one tree to an estimate sum(w a) / sum(w b) or sum(w a) / fixed, with its derivatives by
/// height and diameter.
struct Part {
  double a = 0, a_by_height = 0, a_by_diameter = 0;
  double b = 0, b_by_diameter = 0;
};

class Figures {
 public:
  Figures(const std::vector<Member>& members, const InventoryOptions& options)
      : members_(&members), recall_(options.recall), alike_(options.recall_errors_correlated) {}

  /// `part(tree)` returns the contribution; a = NaN for a tree without one. `fixed` > 0: the denominator.
  Estimate ratio(const auto& part, double fixed) const {
    double a = 0, b = 0;
    int telling = 0;
    for (const Member& m : *members_) {
      const Part p = part(*m.tree);
      if (std::isnan(p.a) || !m.counted) continue;
      ++telling;
      a += m.weight * p.a;
      b += m.weight * p.b;
    }
    const bool any = std::ranges::any_of(*members_, &Member::counted);
    if (fixed > 0) b = fixed;
    if (!(b > 0) || (any && telling == 0)) return {};
    return {a / b, std::sqrt(variance(part, a / b, b, fixed > 0))};
  }

 private:
  double variance(const auto& part, double value, double b, bool fixed) const {
    double own = 0, shared = 0;
    std::map<std::size_t, double> by_recall;
    for (const Member& m : *members_) {
      const StandTree& t = *m.tree;
      const Part p = part(t);
      if (std::isnan(p.a)) continue;
      const double pull = p.a - (fixed ? 0 : value * p.b);
      const double by_diameter = p.a_by_diameter - (fixed ? 0 : value * p.b_by_diameter);
      const auto square = [](double x) { return x * x; };
      own += m.weight_variance * pull * pull +
             square(m.weight) * (square(p.a_by_height * t.height_sd) + square(by_diameter * t.diameter_sd));
      shared += m.weight * by_diameter * t.diameter_bias;
      if (!recall_.empty())
        by_recall[alike_ ? 0 : m.recall_row] +=
            m.weight * pull * recall_[m.recall_row].sd / recall_[m.recall_row].recall;
    }
    double sum = own + shared * shared;
    for (const auto& [row, pull] : by_recall) sum += pull * pull;
    return sum / (b * b);
  }

  const std::vector<Member>* members_;
  std::span<const RecallRow> recall_;
  bool alike_;
};

double section(double diameter) {
  return kPi / 4 * diameter * diameter;
}

Part volume_part(const StandTree& t, double amount) {
  return {.a = amount, .a_by_height = amount / t.height, .a_by_diameter = 2 * amount / t.diameter};
}

Estimate dominant_height(const std::vector<Member>& members, double hectares) {
  std::vector<const Member*> thickest;
  for (const Member& m : members)
    if (m.counted && !std::isnan(m.tree->diameter) && !std::isnan(m.tree->height)) thickest.push_back(&m);
  std::ranges::sort(thickest, [](const Member* a, const Member* b) {
    const StandTree &s = *a->tree, &t = *b->tree;
    if (s.diameter != t.diameter) return s.diameter > t.diameter;
    return s.height != t.height ? s.height > t.height : a->index < b->index;
  });
  if (thickest.empty()) return {};
  double left = kDominantPerHa * hectares, taken = 0, sum = 0, variance = 0;
  std::size_t end = 0;
  for (; end < thickest.size() && left > 0; ++end) {
    const double fraction = std::min(left, thickest[end]->weight);
    const StandTree& t = *thickest[end]->tree;
    left -= fraction;
    taken += fraction;
    sum += fraction * t.height;
    variance += fraction * fraction * t.height_sd * t.height_sd;
  }
  if (!(taken > 0)) return {};
  const double mean = sum / taken;
  // Without one of them the next thickest replaces it.
  const double next = end < thickest.size() ? thickest[end]->tree->height : mean;
  for (std::size_t i = 0; i < end; ++i) {
    const double change = thickest[i]->tree->height - next;
    variance += thickest[i]->weight_variance * change * change;
  }
  return {mean, std::sqrt(variance) / taken};
}

std::vector<DiameterClass> diameter_classes(const std::vector<Member>& members, const Figures& figures,
                                            double hectares, const InventoryOptions& options) {
  // 30 cm belongs to the class from 30 cm despite rounding of 6 x 0.05.
  const auto class_of = [&](double diameter) {
    return static_cast<int>(std::floor(diameter / options.class_width + 1e-9));
  };
  int count = class_of(options.class_end + options.class_width - 2e-9);
  for (const Member& m : members)
    if (m.counted && !std::isnan(m.tree->diameter)) count = std::max(count, class_of(m.tree->diameter) + 1);
  std::vector<DiameterClass> classes;
  for (int i = 0; i < count; ++i) {
    const double from = i * options.class_width, to = (i + 1) * options.class_width;
    const auto in_class = [&](const StandTree& t) {
      return Part{.a = !std::isnan(t.diameter) && class_of(t.diameter) == i ? 1.0 : 0.0};
    };
    Estimate stems = figures.ratio(in_class, hectares);
    // A tree near an edge of its class may belong to the next one.
    double misplaced = 0;
    for (const Member& m : members) {
      const double sd = std::hypot(m.tree->diameter_sd, m.tree->diameter_bias);
      if (!m.counted || !(sd > 0) || std::isnan(m.tree->diameter)) continue;
      const double in =
          normal_below((to - m.tree->diameter) / sd) - normal_below((from - m.tree->diameter) / sd);
      misplaced += m.weight * m.weight * in * (1 - in);
    }
    stems.se = std::sqrt(stems.se * stems.se + misplaced / (hectares * hectares));
    classes.push_back({from, to, stems});
  }
  return classes;
}

}  // namespace

StandAttributes inventory(std::span<const StandTree> trees, const StandPolygon& stand,
                          const InventoryOptions& options) {
  StandAttributes out;
  out.hectares = area(stand) / 1e4;
  const std::vector<Member> members = members_of(trees, stand, options.recall);
  for (const Member& m : members) {
    out.trees += m.counted ? 1 : 0;
    out.without_diameter += m.counted && std::isnan(m.tree->diameter) ? 1 : 0;
  }
  if (!(out.hectares > 0)) return out;

  const Figures figures(members, options);
  const double ha = out.hectares;
  out.stems = figures.ratio([](const StandTree&) { return Part{.a = 1}; }, ha);
  out.basal_area = figures.ratio(
      [](const StandTree& t) {
        return Part{.a = section(t.diameter), .a_by_diameter = kPi / 2 * t.diameter};
      },
      ha);
  out.volume = figures.ratio([](const StandTree& t) { return volume_part(t, t.volume); }, ha);
  out.mass = figures.ratio([](const StandTree& t) { return volume_part(t, t.mass / 1000); }, ha);
  for (Estimate* e : {&out.volume, &out.mass})
    e->se = std::hypot(e->se, e->value * options.form_factor_error);
  out.lorey_height = figures.ratio(
      [](const StandTree& t) {
        const double g = section(t.diameter), slope = kPi / 2 * t.diameter;
        return Part{.a = g * t.height,
                    .a_by_height = g,
                    .a_by_diameter = slope * t.height,
                    .b = g,
                    .b_by_diameter = slope};
      },
      0);
  out.mean_height =
      figures.ratio([](const StandTree& t) { return Part{.a = t.height, .a_by_height = 1, .b = 1}; }, 0);
  out.mean_diameter =
      figures.ratio([](const StandTree& t) { return Part{.a = t.diameter, .a_by_diameter = 1, .b = 1}; }, 0);
  const Estimate square = figures.ratio(
      [](const StandTree& t) {
        return Part{.a = t.diameter * t.diameter, .a_by_diameter = 2 * t.diameter, .b = 1};
      },
      0);
  const double root = std::sqrt(square.value);
  if (root > 0) out.quadratic_mean_diameter = {root, square.se / (2 * root)};
  out.dominant_height = dominant_height(members, ha);
  out.classes = diameter_classes(members, figures, ha, options);
  return out;
}

std::vector<std::size_t> trees_in_stand(std::span<const StandTree> trees, const StandPolygon& stand) {
  const Eigen::AlignedBox2d box = bounds(stand);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < trees.size(); ++i)
    if (!box.isEmpty() && box.contains(trees[i].position) && inside(stand, trees[i].position))
      found.push_back(i);
  return found;
}

}  // namespace waymark::pipeline
