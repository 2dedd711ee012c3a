// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/assignment.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace waymark::localization {

ChosenColumns assign_greedily(const std::vector<std::vector<Choice>>& rows) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> all;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c) all.emplace_back(rows[r][c].cost, r, c);
  std::ranges::sort(all);
  ChosenColumns chosen(rows.size());
  std::set<int> taken;
  for (const auto& [cost, r, c] : all)
    if (!chosen[r] && taken.insert(rows[r][c].column).second) chosen[r] = c;
  return chosen;
}

ChosenColumns assign_cheapest(const std::vector<std::vector<Choice>>& rows, double none_cost) {
  constexpr double kNever = 1e15;
  const std::size_t n = rows.size();
  std::map<int, std::size_t> columns;
  for (const auto& row : rows)
    for (const Choice& choice : row) columns.try_emplace(choice.column, columns.size());
  const std::size_t m = columns.size() + n;  // row r's dummy is column columns.size() + r
  std::vector<std::vector<double>> cost(n, std::vector<double>(m, kNever));
  for (std::size_t r = 0; r < n; ++r) {
    for (const Choice& choice : rows[r]) cost[r][columns.at(choice.column)] = choice.cost;
    cost[r][columns.size() + r] = none_cost;
  }

  // Potentials u, v; owner[j]: row of column j. Index 0 means "no row" and "no column".
  std::vector<double> u(n + 1, 0), v(m + 1, 0);
  std::vector<std::size_t> owner(m + 1, 0), way(m + 1, 0);
  for (std::size_t r = 1; r <= n; ++r) {
    owner[0] = r;
    std::size_t j0 = 0;
    std::vector<double> min_reduced(m + 1, std::numeric_limits<double>::infinity());
    std::vector<bool> used(m + 1, false);
    do {
      used[j0] = true;
      const std::size_t i0 = owner[j0];
      std::size_t j1 = 0;
      double delta = std::numeric_limits<double>::infinity();
      for (std::size_t j = 1; j <= m; ++j) {
        if (used[j]) continue;
        const double reduced = cost[i0 - 1][j - 1] - u[i0] - v[j];
        if (reduced < min_reduced[j]) min_reduced[j] = reduced, way[j] = j0;
        if (min_reduced[j] < delta) delta = min_reduced[j], j1 = j;
      }
      for (std::size_t j = 0; j <= m; ++j)
        if (used[j])
          u[owner[j]] += delta, v[j] -= delta;
        else
          min_reduced[j] -= delta;
      j0 = j1;
    } while (owner[j0] != 0);
    for (; j0; j0 = way[j0]) owner[j0] = owner[way[j0]];
  }

  ChosenColumns chosen(n);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c)
      if (owner[columns.at(rows[r][c].column) + 1] == r + 1) chosen[r] = c;
  return chosen;
}

}  // namespace waymark::localization
