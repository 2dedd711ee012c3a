// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

/// Stage whose spec is set by the test.
template <int>
struct Made {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static inline StageSpec the_spec;
  static StageSpec spec() { return the_spec; }
  static void run(const Options&, StageContext&) {}
};

std::string refusal_of_stage(StageSpec spec) {
  Made<0>::the_spec = std::move(spec);
  return message_of<std::logic_error>([] { Registry().add<Made<0>>(); });
}

constexpr Out<std::vector<Tile>> kTiles{"tiles"};

TEST(Registry, NamesTheNearestStage) {
  EXPECT_EQ(message_of([] { toy::registry().at("square_numbr"); }),
            "there is no stage 'square_numbr'; did you mean 'square_number'?\n"
            "  stages: list_numbers, square_number, sum_squares");
  EXPECT_EQ(message_of([] { toy::registry().at("xyz"); }),
            "there is no stage 'xyz'\n  stages: list_numbers, square_number, sum_squares");
}

TEST(Registry, ListsNamesInOrder) {
  EXPECT_THAT(toy::registry().names(), testing::ElementsAre("list_numbers", "square_number", "sum_squares"));
  EXPECT_EQ(toy::registry().at("square_number").spec().version, 2);
}

TEST(Registry, RefusesAStageTwice) {
  Registry registry = toy::registry();
  EXPECT_EQ(message_of<std::logic_error>([&] { registry.add<toy::SumSquares>(); }),
            "two stages named sum_squares");
}

TEST(Registry, RefusesSpecsThatContradictThemselves) {
  EXPECT_EQ(refusal_of_stage({.name = "Find Tops", .summary = ""}),
            "stage 'Find Tops': its name is not [a-z][a-z0-9_]*");
  EXPECT_EQ(refusal_of_stage({.name = "a", .summary = "", .outputs = {Out<Number>{"../x"}}}),
            "stage 'a': its output '../x' is not [a-z][a-z0-9_]*");
  EXPECT_EQ(refusal_of_stage({.name = "a", .summary = "", .outputs = {Out<Number>{"x"}, Out<Number>{"x"}}}),
            "stage 'a': it declares the output 'x' twice");
  EXPECT_EQ(
      refusal_of_stage(
          {.name = "a", .summary = "", .scope = Scope::tile, .lists = Scope::tile, .outputs = {kTiles}}),
      "stage 'a': a listing stage has map scope, lists tiles or images");
  EXPECT_EQ(refusal_of_stage({.name = "a", .summary = "", .lists = Scope::tile}),
            "stage 'a': a stage that lists tiles writes one vector<Tile>");
  EXPECT_EQ(refusal_of_stage({.name = "a", .summary = "", .lists = Scope::image, .outputs = {kTiles}}),
            "stage 'a': a stage that lists images writes one vector<ImageItem>");
  EXPECT_EQ(refusal_of_stage({.name = "a", .summary = "", .halo = 2}),
            "stage 'a': only a tile has a halo, >= 0 cells");
}

TEST(ReadableType, LeavesNamespacesAndAllocatorsOut) {
  EXPECT_EQ(readable_type(typeid(Number)), "Number");
  EXPECT_EQ(readable_type(typeid(std::vector<Number>)), "vector<Number>");
  EXPECT_EQ(readable_type(typeid(std::string)), "string");
  EXPECT_EQ(readable_type(typeid(std::vector<std::vector<std::string>>)), "vector<vector<string>>");
  EXPECT_EQ(readable_type(typeid(std::shared_ptr<const Number>)), "shared_ptr<const Number>");
  EXPECT_EQ(readable_type(typeid(Made<3>)), "Made<3>");
}

}  // namespace
}  // namespace waymark::test
