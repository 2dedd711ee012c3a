// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/pipeline.hpp"

#include "pipeline/engine/step_options.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

/// Reads "square" as another type than square_number writes.
struct Mistyped {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static StageSpec spec() {
    return {.name = "mistyped", .summary = "", .inputs = {In<std::string>{"square"}}};
  }
  static void run(const Options&, StageContext&) {}
};
/// A second stage that lists tiles.
struct ListAgain : Mistyped {
  static StageSpec spec() {
    return {.name = "list_again",
            .summary = "",
            .lists = Scope::tile,
            .outputs = {Out<std::vector<Tile>>{"again"}}};
  }
};
/// Writes "number" as list_numbers does.
struct WriteAgain : Mistyped {
  static StageSpec spec() {
    return {.name = "write_again", .summary = "", .outputs = {Out<Number>{"number"}}};
  }
};
/// A tile-scope stage without inputs.
struct Lonely : Mistyped {
  static StageSpec spec() { return {.name = "lonely", .summary = "", .scope = Scope::tile}; }
};

/// Lists images from an artifact of tiles.
struct ListByTile : Mistyped {
  static StageSpec spec() {
    return {.name = "list_by_tile",
            .summary = "",
            .lists = Scope::image,
            .inputs = {In<Number>{"square"}},
            .outputs = {Out<std::vector<ImageItem>>{"images"}}};
  }
};

class PipelineTest : public testing::Test {
 protected:
  const Registry registry = [] {
    Registry all = toy::registry();
    all.add<Mistyped>();
    all.add<ListAgain>();
    all.add<WriteAgain>();
    all.add<Lonely>();
    all.add<ListByTile>();
    return all;
  }();

  std::string refusal(std::initializer_list<const char*> stages) const {
    Pipeline pipeline(registry);
    for (const char* stage : stages) pipeline.add(stage);
    return message_of([&] { pipeline.check(); });
  }
};

TEST_F(PipelineTest, AcceptsWhatFits) {
  EXPECT_NO_THROW(toy_pipeline(registry).check());
}

TEST_F(PipelineTest, NamesTheMissingWriter) {
  EXPECT_EQ(refusal({"list_numbers", "sum_squares"}),
            "stages[1] sum_squares reads 'square', which no stage before it writes\n"
            "  add before it: square_number");
  EXPECT_EQ(refusal({"list_numbers", "sum_squares", "square_number"}),
            "stages[1] sum_squares reads 'square', which no stage before it writes\n"
            "  stages[2] square_number writes it: move it up");
}

TEST_F(PipelineTest, NamesBothTypes) {
  EXPECT_EQ(refusal({"list_numbers", "square_number", "mistyped"}),
            "stages[2] mistyped reads 'square' as string, but stages[1] square_number writes it as Number");
}

TEST_F(PipelineTest, NamesBothWriters) {
  EXPECT_EQ(refusal({"list_numbers", "write_again", "square_number"}),
            "stages[0] list_numbers and stages[1] write_again both write 'number', but stages[2] "
            "square_number reads only one");
  EXPECT_EQ(refusal({"list_numbers", "square_number", "list_by_tile"}),
            "stages[1] square_number runs tile by tile, but a stage that lists reads it while planning");
  EXPECT_EQ(refusal({"list_numbers", "list_numbers"}),
            "stages[0] list_numbers and stages[1] list_numbers are the same stage");
  EXPECT_EQ(refusal({"list_numbers", "list_again"}),
            "stages[0] list_numbers and stages[1] list_again both list tiles");
}

TEST_F(PipelineTest, NamesTheStagesThatListTiles) {
  EXPECT_EQ(refusal({"lonely", "list_numbers"}),
            "stages[0] lonely works on tiles, but no stage before it lists them\n"
            "  add before it: list_again or list_numbers");
  EXPECT_EQ(refusal({}), "the job has no stages");
}

TEST_F(PipelineTest, NamesThePlaceOfAnUnknownStage) {
  Pipeline pipeline(registry);
  EXPECT_EQ(message_of([&] { pipeline.add("list_numbers").add("sqare_number"); }),
            "stages[1]: there is no stage 'sqare_number'; did you mean 'square_number'?\n"
            "  stages: list_again, list_by_tile, list_numbers, lonely, mistyped, square_number, sum_squares, "
            "write_again");
}

TEST_F(PipelineTest, TakesOptionsAsJsonAndAsValues) {
  Pipeline pipeline(registry);
  pipeline.add("list_numbers", R"({"tiles": 2})").add<toy::SquareNumber>({.power = 3}).add<toy::SumSquares>();
  EXPECT_EQ(canonical_options(*pipeline.steps()[0]), R"({"files":[],"tiles":2})");
  EXPECT_EQ(canonical_options(*pipeline.steps()[1]),
            R"({"height":20.0,"keep":"all","loud":false,"power":3.0})");
  EXPECT_THROW(pipeline.add<toy::SquareNumber>({.power = 9}), Error);
  EXPECT_EQ(pipeline.find_writer("square"), pipeline.steps()[1].get());
  EXPECT_EQ(pipeline.find_writer("tree"), nullptr);
}

TEST_F(PipelineTest, SetsOneOption) {
  Pipeline pipeline = toy_pipeline(registry);
  pipeline.set("square_number.power=3").set("sum_squares.sign=a=b.c");
  EXPECT_THAT(canonical_options(*pipeline.steps()[1]), testing::HasSubstr(R"("power":3.0)"));
  EXPECT_EQ(canonical_options(*pipeline.steps()[2]), R"({"sign":"a=b.c"})");
  EXPECT_EQ(message_of([&] { pipeline.set("power=3"); }),
            "'power=3' is not STAGE.OPTION=VALUE\n  as in find_mountain_tops.min_prominence=25");
  EXPECT_EQ(message_of([&] { pipeline.set("square_numbr.power=3"); }),
            "the job has no stage 'square_numbr'; did you mean 'square_number'?\n"
            "  its stages: list_numbers, square_number, sum_squares");
}

}  // namespace
}  // namespace waymark::test
