// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/engine/toy_stages.hpp"

#include <unistd.h>

#include <cmath>

namespace waymark::test {
using namespace pipeline;
namespace toy {

Watch& watch() {
  static Watch the_watch;
  return the_watch;
}

void ListNumbers::Options::describe(OptionVisitor& option) {
  option("tiles", tiles, {.help = "How many tiles there are", .min = 0, .max = 100'000});
  option("files", files, {.help = "Files that count as read"});
}
StageSpec ListNumbers::spec() {
  return {.name = "list_numbers",
          .summary = "Lists tiles and writes a number",
          .lists = Scope::tile,
          .outputs = {tiles, number}};
}
void ListNumbers::run(const Options& options, StageContext& unit) {
  ++watch().listed;
  std::vector<Tile> list;
  for (std::int64_t i = 0; i < options.tiles; ++i)
    list.push_back({.index = i, .column = i, .row = 0, .cells = {10 * i, 0, 10, 10}});
  unit.write(tiles, list);
  unit.write(number, Number{3});
  unit.count_out(options.tiles);
}

void SquareNumber::Options::describe(OptionVisitor& option) {
  option("power", power, {.help = "Exponent", .min = 0.5, .max = 4});
  option("keep", keep, {.help = "Which squares are kept", .choices = {"all", "even", "none"}});
  option("height", height, {.help = "A length | unused", .min = 0});
  option("loud", loud, {.help = "Warn in every tile"});
  option("memory", memory, {.help = "Bytes it may take", .min = 1, .affects_result = false});
}
StageSpec SquareNumber::spec() {
  return {.name = "square_number",
          .summary = "Raises the number of a tile to a power",
          .version = 2,
          .scope = Scope::tile,
          .halo = 3,
          .inputs = {number},
          .outputs = {square}};
}
void SquareNumber::run(const Options& options, StageContext& unit) {
  ++watch().squared;
  if (watch().in_square) watch().in_square(unit);
  const double base = static_cast<double>(unit.read(number).value + unit.tile().index);
  const Number result{std::llround(std::pow(base, options.power))};
  unit.count_in(1);
  const bool keep = options.keep == "all" || (options.keep == "even" && result.value % 2 == 0);
  if (keep)
    unit.count_out(1);
  else
    unit.reject("not " + options.keep);
  if (options.loud) unit.warn("loud");
  unit.write(square, keep ? result : Number{0});
}

void SumSquares::Options::describe(OptionVisitor& option) {
  option("sign", sign, {.help = "Between two squares"});
}
StageSpec SumSquares::spec() {
  return {.name = "sum_squares", .summary = "Adds the squares up", .inputs = {square}, .outputs = {sum}};
}
void SumSquares::run(const Options& options, StageContext& unit) {
  ++watch().summed;
  std::int64_t total = 0;
  std::string text;
  for (const auto& part : unit.read_all(square)) {
    text += (text.empty() ? "" : options.sign) + std::to_string(part->value);
    total += part->value;
  }
  unit.write(sum, text + "=" + std::to_string(total));
}

Registry registry() {
  Registry registry;
  registry.add<ListNumbers>();
  registry.add<SquareNumber>();
  registry.add<SumSquares>();
  return registry;
}

}  // namespace toy

Pipeline toy_pipeline(const Registry& registry) {
  Pipeline pipeline(registry);
  pipeline.add("list_numbers").add("square_number").add("sum_squares");
  return pipeline;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "waymark_test_XXXXXX").string();
  path_ = mkdtemp(name.data());
}
TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace waymark::test
