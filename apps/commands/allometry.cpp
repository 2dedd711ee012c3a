// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "apps/command.hpp"
#include "apps/log.hpp"
#include "apps/session.hpp"
#include "core/error.hpp"
#include "importers/tables/measured_trees.hpp"

namespace waymark {
namespace {

void check_output(const std::string& output) {
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

class AllometryCommand final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "allometry",
        .group = Group::make,
        .summary = "Fit stem diameters to heights (and crowns) of measured trees",
        .about =
            "Fits D = a (H - 1.3)^b by least squares, for all trees and for each species with enough of "
            "them; where "
            "every tree has a crown diameter also D = a (H CD)^b, and keeps what errs less on trees held "
            "out. The "
            "table says how far it errs: held_out_rmse_cm is of trees (of whole plots, where the table names "
            "plots) that the curve was not fitted to. Columns are found by their usual names; heights are "
            "metres.",
        .arguments =
            {Argument{"", "fit", &what_, "What to do"}.one_of({"fit"}).needed(),
             file_word("TREES.csv", &input_, "Measured trees: any table with heights and diameters"),
             Argument{"-o,--output", "TABLE.csv", &output_, "Table for --allometry"}.needed().offering(
                 Offer::file),
             Argument{"--height", "COLUMN", &columns_.height, "Column of heights, metres"},
             Argument{"--diameter", "COLUMN", &columns_.diameter, "Column of stem diameters"},
             Argument{"--diameter-unit", "UNIT", &columns_.diameter_unit, "Unit of the diameters"}
                 .one_of({"cm", "m", "mm"})
                 .or_else("by the size of the numbers"),
             Argument{"--crown", "COLUMN", &columns_.crown, "Column of crown diameters, metres"},
             Argument{"--species", "COLUMN", &columns_.species, "Column that names the species"},
             Argument{"--plot", "COLUMN", &columns_.plot, "Column whose trees are held out together"},
             {"--least-trees", "N", &least_, "Species with fewer trees get no row of their own"}},
        .examples = {
            {"waymark allometry fit plots.csv -o spruce.csv", "A table for `waymark trees --allometry`"},
            {"waymark allometry fit als.csv -o table.csv --height hmax --diameter DBH",
             "Diameters from heights as a laser sees them"}}};
  }

  int run(const Session&) override {
    check_output(output_);
    if (least_ < 5)
      throw Error(ErrorCode::usage, fmt::format("--least-trees is {}, below 5", least_), "",
                  "leave it out for the usual 20");
    const MeasuredTrees read = read_measured_trees(input_, columns_);
    say(fmt::format("{} trees; {}{}\n", read.trees.size(), read.columns,
                    read.left_out ? fmt::format("; {} rows without them left out", read.left_out) : ""));
    const auto table = fitted(read);
    for (const Allometry& row : table)
      say(fmt::format("{:12} {:12} a {:.4g} b {:.4g}  {} trees  RMSE {:.2f} cm, held out {:.2f} cm\n",
                      row.species, to_string(row.form), row.a, row.b, row.trees, row.rmse,
                      row.held_out_rmse));
    std::ofstream file(output_, std::ios::binary | std::ios::trunc);
    if (!(file << allometry_as_csv(table)) || !file.flush())
      throw Error(ErrorCode::output, "the table cannot be written", output_,
                  "is the disk full or write-protected?");
    return 0;
  }

 private:
  std::vector<Allometry> fitted(const MeasuredTrees& read) const {
    try {
      return fit_allometry(read.trees, {.least_trees = static_cast<int>(least_)});
    } catch (const Error& error) {
      throw Error(error.code(), error.problem(), input_, error.hint());
    }
  }

  std::string what_, input_, output_;
  TreeColumns columns_;
  std::int64_t least_ = 20;
};

}  // namespace

void register_command_allometry(CommandTable& commands);
void register_command_allometry(CommandTable& commands) {
  commands.add<AllometryCommand>();
}

}  // namespace waymark
