// SPDX-License-Identifier: Apache-2.0
#include "planning/route_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <queue>
#include <stdexcept>
#include <utility>

#include "planning/block_array.hpp"
#include "planning/bucket_queue.hpp"
#include "planning/sd_bounds.hpp"

namespace waymark::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Label of a cell and heading: a line of the cache.
struct Label {
  Symmetric3 covariance;
  double cost;
  std::int32_t parent;
  std::uint32_t node;  // cell and heading

  std::int64_t cell() const { return node / kHeadings; }
  int heading() const { return static_cast<int>(node % kHeadings); }
};

/// Label that was taken from the queue, with what others are compared with.
struct ClosedLabel {
  Symmetric3 covariance;
  double cost;
  std::int32_t before;  // of the same cell, as in CellLabels
  std::int32_t heading;
};

/// Labels of a cell, numbered from 1; 0 is none.
struct CellLabels {
  std::int32_t closed;                       // the last; each has the one before it
  std::array<std::int32_t, kHeadings> kept;  // number of them by heading
};

/// Memory of zeros that costs nothing until it is touched: most searches touch a small part of the cells.
template <class T>
class LazyZeros {
 public:
  explicit LazyZeros(std::size_t count)
      : data_(static_cast<T*>(std::calloc(std::max<std::size_t>(count, 1), sizeof(T)))) {
    if (!data_) throw std::bad_alloc();
  }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
  std::unique_ptr<T, Free> data_;
};

/// Returns lower bounds of the cost to the goal.
std::vector<double> bounds_to_go(const RouteProblem& problem, const SigmaSearch& search) {
  if (!(search.weight > 0)) return distances_to(problem.field.cells, problem.passable, problem.to);
  return cost_to_go(problem, search.weight,
                    problem.min_sd.empty() ? relaxed_sd(problem, kInfinity) : problem.min_sd);
}

Route trace(const BlockArray<Label>& labels, std::int32_t last, const Moves& moves) {
  Route route;
  for (std::int32_t i = last; i >= 0; i = labels[slot(i)].parent)
    route.nodes.push_back({labels[slot(i)].cell(), labels[slot(i)].heading(), labels[slot(i)].covariance});
  std::ranges::reverse(route.nodes);
  route.cost = labels[slot(last)].cost;
  route.worst_sd = position_sd(route.nodes.front().covariance);
  for (std::size_t i = 1; i < route.nodes.size(); ++i) {
    route.length += moves.length(route.nodes[i].heading);
    route.worst_sd = std::max(route.worst_sd, position_sd(route.nodes[i].covariance));
  }
  return route;
}

/// One search: its labels, and which of them dominate others.
class SigmaSearcher {
 public:
  SigmaSearcher(const RouteProblem& problem, const SigmaSearch& search, const std::vector<double>& to_go)
      : problem_(problem),
        search_(search),
        to_go_(to_go),
        moves_(problem.field.cells, problem.passable),
        // Without a limit, the first label that a node opens at the least cost is the one it keeps.
        has_limit_(std::isfinite(search.max_sd)),
        keeps_cheapest_(!has_limit_ && search.labels == 1),
        open_(to_go[slot(problem.from)], width_of_buckets()),
        cells_(slot(problem.field.cells.count())),
        cheapest_(keeps_cheapest_ ? slot(problem.field.cells.count() * kHeadings) : 0) {
    for (int e = 0; e < kHeadings; ++e) {
      turns_[slot(e)] = turn_between(0, e);
      turn_noise_[slot(e)] = problem.noise.yaw_per_radian * turns_[slot(e)];
    }
  }

  std::optional<Route> run();

 private:
  // Any width is correct; this makes heaps of some hundred entries.
  double width_of_buckets() const {
    return std::max(problem_.field.cells.cell / 64, to_go_[slot(problem_.from)] / 16384);
  }
  static std::size_t eighths(int from, int to) { return slot((from - to + kHeadings) % kHeadings); }

  /// A closed label dominates one of another heading if it does so after the turn, which costs no way. What
  /// keeps a limit depends on covariances more than on cost, so places are left for smaller ones.
  bool dominates(const ClosedLabel& closed, const Label& label) const {
    if (!(closed.cost <= label.cost)) return false;
    const int heading = label.heading();
    if (!has_limit_ && closed.heading != heading) return false;
    Symmetric3 earlier = closed.covariance;
    earlier.tt += turn_noise_[eighths(closed.heading, heading)];
    return earlier == label.covariance || exceeds(label.covariance, earlier, scale_);
  }
  /// Compares a label with those closed since `seen`.
  bool is_dominated(const Label& label, const CellLabels& cell, std::int32_t seen) const {
    if (cell.kept[slot(label.heading())] >= search_.labels) return true;
    for (std::int32_t i = cell.closed; i != seen; i = closed_[slot(i - 1)].before)
      if (dominates(closed_[slot(i - 1)], label)) return true;
    return false;
  }
  void push(const Label& label);
  void close(const Label& label, CellLabels& cell);
  void expand(const Label& label, std::int32_t index);

  const RouteProblem& problem_;
  const SigmaSearch& search_;
  const std::vector<double>& to_go_;
  const Moves moves_;
  const bool has_limit_, keeps_cheapest_;
  const double scale_ = (1 + search_.tolerance) * (1 + search_.tolerance);
  std::array<double, kHeadings> turns_{}, turn_noise_{};  // by the difference of headings
  BlockArray<Label> labels_;
  BlockArray<ClosedLabel> closed_;
  BucketQueue open_;  // labels by whole cost, with node and the last closed label they were compared with
  LazyZeros<CellLabels> cells_;
  LazyZeros<std::uint64_t> cheapest_;  // least cost at which a node was opened; 0: none
};

void SigmaSearcher::push(const Label& label) {
  const double whole = label.cost + to_go_[slot(label.cell())];
  if (whole > search_.max_cost || labels_.size() >= search_.max_labels) return;
  const CellLabels& cell = cells_[slot(label.cell())];
  if (is_dominated(label, cell, 0)) return;
  const auto index = static_cast<std::int32_t>(labels_.size());
  if (keeps_cheapest_) {
    // Costs >= 0 are ordered as their bits are.
    const std::uint64_t cost = std::bit_cast<std::uint64_t>(label.cost) + 1;
    std::uint64_t& cheapest = cheapest_[label.node];
    if (cheapest > 0 && cost >= cheapest) return;
    cheapest = cost;
  }
  open_.push({whole, static_cast<std::uint32_t>(index), label.node, static_cast<std::uint32_t>(cell.closed)});
  labels_.push_back(label);
}

void SigmaSearcher::close(const Label& label, CellLabels& cell) {
  ++cell.kept[slot(label.heading())];
  if (keeps_cheapest_) return;  // the number of labels says all
  closed_.push_back({label.covariance, label.cost, cell.closed, label.heading()});
  cell.closed = static_cast<std::int32_t>(closed_.size());
}

void SigmaSearcher::expand(const Label& label, std::int32_t index) {
  const bool is_first = label.parent < 0 && !problem_.heading;
  for (unsigned left = moves_.from(label.cell()); left != 0; left &= left - 1) {
    const int h = std::countr_zero(left);
    if (is_first && h != label.heading()) continue;  // any start heading has its own label
    const std::int64_t next = moves_.to(label.cell(), h);
    if (to_go_[slot(next)] == kInfinity || cells_[slot(next)].kept[slot(h)] >= search_.labels) continue;
    const Symmetric3 covariance =
        step_belief(problem_, label.covariance, next, h, turns_[eighths(label.heading(), h)]);
    const double sd = position_sd(covariance);
    if (!(sd <= search_.max_sd)) continue;
    push({covariance, label.cost + moves_.length(h) * (1 + search_.weight * sd), index,
          static_cast<std::uint32_t>(next * kHeadings + h)});
  }
}

std::optional<Route> SigmaSearcher::run() {
  const RouteCells& cells = problem_.field.cells;
  for (int h = 0; h < kHeadings; ++h)
    if (!problem_.heading || *problem_.heading == h)
      push({problem_.start, 0, -1, static_cast<std::uint32_t>(problem_.from * kHeadings + h)});
  SearchProgress progress(problem_, std::min(static_cast<std::int64_t>(search_.max_labels),
                                             cells.count() * kHeadings * search_.labels));
  while (!open_.empty()) {
    progress.step();
    const QueueEntry first = open_.pop();
    CellLabels& cell = cells_[first.value / kHeadings];
    if (cell.kept[first.value % kHeadings] >= search_.labels) continue;  // most end here
    const Label label = labels_[first.number];
    const auto index = static_cast<std::int32_t>(first.number);
    if (is_dominated(label, cell, static_cast<std::int32_t>(first.more))) continue;
    if (label.cell() == problem_.to) return trace(labels_, index, moves_);
    close(label, cell);
    expand(label, index);
  }
  return {};
}

}  // namespace

std::optional<Route> search_by_sigma(const RouteProblem& problem, const SigmaSearch& search) {
  if (problem.field.cells.count() > std::numeric_limits<std::uint32_t>::max() / kHeadings)
    throw std::length_error("a search has at most 2^29 cells");
  const bool keeps_distances = !(search.weight > 0) && !problem.to_go.empty();
  const std::vector<double> own = keeps_distances ? std::vector<double>() : bounds_to_go(problem, search);
  const std::vector<double>& to_go = keeps_distances ? problem.to_go : own;
  if (to_go[slot(problem.from)] == kInfinity || !(position_sd(problem.start) <= search.max_sd)) return {};
  return SigmaSearcher(problem, search, to_go).run();
}

std::optional<Route> search_by_landmarks(const RouteProblem& problem, double count, bool by_quality) {
  const RouteCells& cells = problem.field.cells;
  struct Cost {
    double outside = kInfinity, length = kInfinity;
    auto operator<=>(const Cost&) const = default;
  };
  const std::size_t nodes = slot(cells.count() * kHeadings);
  std::vector<Cost> best(nodes);
  std::vector<std::int64_t> parent(nodes, -1);
  using Entry = std::pair<Cost, std::int64_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (int h = 0; h < kHeadings; ++h)
    if (!problem.heading || *problem.heading == h) {
      const std::int64_t node = problem.from * kHeadings + h;
      best[slot(node)] = {0, 0};
      open.emplace(best[slot(node)], node);
    }
  std::int64_t last = -1;
  SearchProgress progress(problem, cells.count() * kHeadings);
  while (!open.empty()) {
    progress.step();
    const auto [cost, node] = open.top();
    open.pop();
    if (cost > best[slot(node)]) continue;
    if (node / kHeadings == problem.to) {
      last = node;
      break;
    }
    for (int h = 0; h < kHeadings; ++h) {
      const std::int64_t next = neighbour(cells, problem.passable, node / kHeadings, h);
      if (next < 0) continue;
      const Information& seen = problem.field.get(next, h);
      const double value = by_quality ? seen.quality : seen.landmarks, length = step_length(cells, h);
      const Cost there{cost.outside + (value >= count ? 0 : length), cost.length + length};
      const std::int64_t to = next * kHeadings + h;
      if (there < best[slot(to)]) {
        best[slot(to)] = there, parent[slot(to)] = node;
        open.emplace(there, to);
      }
    }
  }
  if (last < 0) return {};
  Route route;
  route.outside = best[slot(last)].outside;
  route.cost = route.length = best[slot(last)].length;
  for (std::int64_t node = last; node >= 0; node = parent[slot(node)])
    route.nodes.push_back({node / kHeadings, static_cast<int>(node % kHeadings), {}});
  std::ranges::reverse(route.nodes);
  if (!problem.heading && route.nodes.size() > 1) route.nodes[0].heading = route.nodes[1].heading;
  route.nodes[0].covariance = problem.start;
  route.worst_sd = position_sd(problem.start);
  for (std::size_t i = 1; i < route.nodes.size(); ++i) {
    RouteNode& node = route.nodes[i];
    const RouteNode& before = route.nodes[i - 1];
    node.covariance = step_belief(problem, before.covariance, node.cell, node.heading,
                                  turn_between(before.heading, node.heading));
    route.worst_sd = std::max(route.worst_sd, position_sd(node.covariance));
  }
  return route;
}

}  // namespace waymark::planning
