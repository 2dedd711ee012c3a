// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/measured_trees.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/text_table.hpp"
#include "pipeline/forest/allometry_fit.hpp"

namespace waymark::importers {
namespace {

std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') out += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) out += c;
  }
  return out;
}

using Names = std::vector<std::string>;

std::optional<std::size_t> column(const TableHeader& header, const std::string& asked, const Names& usual) {
  if (!asked.empty()) {
    for (std::size_t i = 0; i < header.columns.size(); ++i)
      if (header.columns[i] == asked || plain(header.columns[i]) == plain(asked)) return i;
    const std::string nearest = nearest_name(asked, header.columns);
    throw Error(ErrorCode::input, fmt::format("the table has no column '{}'", asked), header.path,
                nearest.empty() ? fmt::format("it has {}", fmt::join(header.columns, ", "))
                                : "did you mean '" + nearest + "'?");
  }
  for (const std::string& name : usual)
    for (std::size_t i = 0; i < header.columns.size(); ++i)
      if (plain(header.columns[i]) == name) return i;
  return {};
}

std::size_t needed(const TableHeader& header, const std::string& asked, const Names& usual,
                   const char* what) {
  if (const auto found = column(header, asked, usual)) return *found;
  throw Error(ErrorCode::input, fmt::format("no column of the table is a {}", what), header.path,
              fmt::format("it has {}: name one with --{}", fmt::join(header.columns, ", "), what));
}

std::optional<double> number(const TableRow& row, std::size_t column, bool decimal_comma) {
  if (column >= row.cells.size()) return {};
  std::string cell = row.cells[column];
  if (decimal_comma) std::ranges::replace(cell, ',', '.');
  double value = 0;
  if (!parse_number(cell, value) || !std::isfinite(value)) return {};  // NA, empty
  return value;
}

// Returns centimetres per unit, inferred from the median diameter of stems: 3 to 200 cm.
double unit_of(const std::vector<pipeline::MeasuredTree>& trees, const std::string& asked,
               std::string& name) {
  name = asked;
  if (asked.empty()) {
    std::vector<double> all;
    for (const pipeline::MeasuredTree& tree : trees) all.push_back(tree.diameter);
    std::ranges::sort(all);
    const double median = all.empty() ? 20 : all[all.size() / 2];
    name = median < 2 ? "m" : median > 150 ? "mm" : "cm";
  }
  return name == "m" ? 100 : name == "mm" ? 0.1 : 1;
}

}  // namespace

MeasuredTrees read_measured_trees(const std::string& path, const TreeColumns& columns) {
  const auto table = open_table(path, TableFormat::by_name, "", "tree");
  const TableHeader& header = table->header();
  const std::size_t height =
      needed(header, columns.height,
             {"height", "h", "ht", "hmax", "treeheight", "heightm", "htot", "totalheight", "hm"}, "height");
  const std::size_t diameter =
      needed(header, columns.diameter,
             {"dbh", "dbhcm", "diameter", "d", "stemdiameter", "diametercm", "dbhmm", "dbhm", "dcm", "d13"},
             "diameter");
  const auto crown =
      column(header, columns.crown,
             {"crowndiameter", "cd", "crownwidth", "maxcrowndiameter", "crowndiameterm", "cw"});
  const auto species =
      column(header, columns.species, {"species", "taxonid", "sp", "speciescode", "taxon", "spp"});
  const auto plot = column(header, columns.plot, {"plot", "plotid", "stand", "standid"});
  MeasuredTrees read;
  TableRow row;
  while (table->next(row)) {
    const auto h = number(row, height, header.decimal_comma), d = number(row, diameter, header.decimal_comma);
    if (!h || !d || !(*d > 0) || !(*h > 0)) {
      ++read.skipped_rows;
      continue;
    }
    pipeline::MeasuredTree tree{.height = *h, .diameter = *d};
    if (crown) tree.crown = number(row, *crown, header.decimal_comma).value_or(pipeline::Allometry::kUnknown);
    if (species && *species < row.cells.size() && !row.cells[*species].empty())
      tree.species = row.cells[*species];
    if (plot && *plot < row.cells.size()) tree.plot = row.cells[*plot];
    read.trees.push_back(std::move(tree));
  }
  std::string unit;
  const double centimetres = unit_of(read.trees, columns.diameter_unit, unit);
  for (pipeline::MeasuredTree& tree : read.trees) tree.diameter *= centimetres;
  read.columns = fmt::format("height from {}, diameter from {} in {}", header.columns[height],
                             header.columns[diameter], unit);
  for (const auto& [what, at] : {std::pair{"crown diameter", crown}, {"species", species}, {"plot", plot}})
    if (at) read.columns += fmt::format(", {} from {}", what, header.columns[*at]);
  return read;
}

}  // namespace waymark::importers
