// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <vector>
namespace waymark::localization {

/// An entry of a sparse cost table.
struct Choice {
  int column = 0;
  double cost = 0;
};

/// For each row one of its choices, or none; no column twice.
using ChosenColumns = std::vector<std::optional<std::size_t>>;  ///< index into the row's choices

/// Assigns the cheapest entries first.
ChosenColumns assign_greedily(const std::vector<std::vector<Choice>>& rows);

/// Returns the assignment of least total cost (Kuhn 1955; shortest augmenting paths, Jonker & Volgenant
/// 1987). Each row has a dummy column at `none_cost`. O(rows^2 (rows + columns)).
ChosenColumns assign_cheapest(const std::vector<std::vector<Choice>>& rows, double none_cost);

}  // namespace waymark::localization
