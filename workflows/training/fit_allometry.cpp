// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/fit_allometry.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "pipeline/forest/allometry_fit.hpp"

namespace waymark::workflows {
namespace {

void check_table_output(const std::string& output) {
  const std::filesystem::path path(output);
  if (path.extension() != ".csv")
    throw Error(ErrorCode::usage, "an allometry table is written as .csv", output,
                "e.g. -o " + std::filesystem::path(path).replace_extension(".csv").string());
  const std::filesystem::path folder = path.parent_path().empty() ? "." : path.parent_path();
  if (!std::filesystem::is_directory(folder))
    throw Error(ErrorCode::output, "the folder of the output does not exist: " + folder.string(), output,
                "make it with: mkdir -p " + folder.string());
  if (std::filesystem::is_directory(path))
    throw Error(ErrorCode::output, "the output is a folder", output, "name a file in it");
}

std::vector<pipeline::Allometry> fit_table(const importers::MeasuredTrees& read,
                                           const AllometryRequest& request) {
  try {
    return fit_allometry(read.trees, {.min_trees = static_cast<int>(request.min_trees)});
  } catch (const Error& error) {
    throw Error(error.code(), error.problem(), request.input, error.hint());
  }
}

}  // namespace

std::vector<pipeline::Allometry> fit_allometry(const AllometryRequest& request, const Callbacks& callbacks) {
  if (!request.output.empty()) check_table_output(request.output);
  if (request.min_trees < 5)
    throw Error(ErrorCode::usage, fmt::format("--min-trees is {}, below 5", request.min_trees), "",
                "leave it out for the usual 20");
  const importers::MeasuredTrees read = importers::read_measured_trees(request.input, request.columns);
  callbacks.summary(fmt::format(
      "{} trees; {}{}\n", read.trees.size(), read.columns,
      read.skipped_rows ? fmt::format("; {} rows without them left out", read.skipped_rows) : ""));
  const auto table = fit_table(read, request);
  for (const pipeline::Allometry& row : table)
    callbacks.summary(
        fmt::format("{:12} {:12} a {:.4g} b {:.4g}  {} trees  RMSE {:.2f} cm, held out {:.2f} cm\n",
                    row.species, to_string(row.form), row.a, row.b, row.trees, row.rmse, row.held_out_rmse));
  if (request.output.empty()) return table;
  write_file(request.output, pipeline::allometry_as_csv(table));
  return table;
}

}  // namespace waymark::workflows
