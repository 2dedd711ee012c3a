// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"
#include "apps/console.hpp"
#include "workflows/training/fit_allometry.hpp"

namespace waymark::apps {
namespace {

class AllometryCommand final : public Command {
 public:
  CommandSpec describe() override {
    return {
        .name = "allometry",
        .group = Group::make,
        .summary = "Fit stem diameters to heights (and crowns) of measured trees",
        .about =
            "Fits D = a (H - 1.3)^b by least squares, for all trees and for each species with enough of "
            "them. If every tree has a crown diameter, also fits D = a (H CD)^b and keeps the form with "
            "the smaller error on held-out trees. held_out_rmse_cm is the error on trees (on whole plots, "
            "if the table names plots) that the curve was not fitted to. Columns are found by their usual "
            "names; heights are metres.",
        .arguments =
            {Argument{"", "fit", &what_, "What to do"}.one_of({"fit"}).needed(),
             file_word("TREES.csv", &request_.input, "Measured trees: any table with heights and diameters"),
             Argument{"-o,--output", "TABLE.csv", &request_.output, "Table for --allometry"}
                 .needed()
                 .offering(Offer::file),
             Argument{"--height", "COLUMN", &request_.columns.height, "Column of heights, metres"},
             Argument{"--diameter", "COLUMN", &request_.columns.diameter, "Column of stem diameters"},
             Argument{"--diameter-unit", "UNIT", &request_.columns.diameter_unit, "Unit of the diameters"}
                 .one_of({"cm", "m", "mm"})
                 .or_else("by the size of the numbers"),
             Argument{"--crown", "COLUMN", &request_.columns.crown, "Column of crown diameters, metres"},
             Argument{"--species", "COLUMN", &request_.columns.species, "Column that names the species"},
             Argument{"--plot", "COLUMN", &request_.columns.plot, "Column whose trees are held out together"},
             Argument{"--min-trees", "N", &request_.min_trees,
                      "Species with fewer trees get no row of their own"}
                 .formerly("--least-trees"),
             format_option(&format_)},
        .examples = {{"waymark allometry fit plots.csv -o spruce.csv",
                      "A table for `waymark trees --allometry`"},
                     {"waymark allometry fit als.csv -o table.csv --height hmax --diameter DBH",
                      "Diameters from heights measured by a laser"}},
        .result = result_keys()};
  }

  int run(const Session& session) override {
    const auto rows = workflows::fit_allometry(request_, console_callbacks(session, format_));
    if (format_ != "json") return 0;
    std::string objects;
    for (const pipeline::Allometry& row : rows)
      objects += (objects.empty() ? "" : ",") + result_object({{"species", row.species},
                                                               {"form", pipeline::to_string(row.form)},
                                                               {"a", row.a},
                                                               {"b", row.b},
                                                               {"sigma", row.sigma},
                                                               {"tree_count", row.trees},
                                                               {"rmse_cm", row.rmse},
                                                               {"held_out_rmse_cm", row.held_out_rmse},
                                                               {"held_out_bias_cm", row.held_out_bias}});
    print_result(result_keys(), {{"output", request_.output}, {"rows", ResultJson{"[" + objects + "]"}}});
    return 0;
  }

 private:
  static std::vector<ResultKey> result_keys() {
    return {{"output", ResultKind::text, "Table that was written"},
            {"rows", ResultKind::objects,
             "Its rows: species, form, a, b, sigma, tree_count and the errors in cm"}};
  }

  std::string what_, format_ = "text";
  workflows::AllometryRequest request_;
};

}  // namespace

void register_command_allometry(CommandTable& commands);
void register_command_allometry(CommandTable& commands) {
  commands.add<AllometryCommand>();
}

}  // namespace waymark::apps
