// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using testing::HasSubstr;

constexpr In<Number> kNumber{"number"};
constexpr Out<Number> kSquare{"square"};

class StageContextTest : public testing::Test {
 protected:
  const StageSpec spec = toy::SquareNumber::spec();
  const UnitInputs inputs{
      .id = "square_number/tile_000001",
      .tile = Tile{.index = 1, .column = 1, .row = 0, .cells = {10, 0, 10, 10}},
      .ports = {{"number", {{std::make_shared<Artifact>(std::make_shared<const Number>(7))}}}},
      .base_folder = "jobs"};
  StageContext unit{spec, inputs};
};

TEST_F(StageContextTest, ReadsAndWritesDeclaredPorts) {
  EXPECT_EQ(unit.read(kNumber).value, 7);
  unit.write(kSquare, Number{49});
  const UnitOutcome outcome = unit.finish();
  EXPECT_EQ(static_cast<const Number*>(outcome.outputs.at("square").get())->value, 49);
}

TEST_F(StageContextTest, RefusesAnUndeclaredPort) {
  EXPECT_EQ(message_of<std::logic_error>([&] { unit.read(In<Number>{"tree"}); }),
            "stage square_number reads 'tree', which it has not declared");
  EXPECT_EQ(message_of<std::logic_error>([&] { unit.write(Out<Number>{"tree"}, {}); }),
            "stage square_number writes 'tree', which it has not declared");
}

TEST_F(StageContextTest, RefusesADeclaredPortOfAnotherType) {
  EXPECT_EQ(message_of<std::logic_error>([&] { unit.read(In<std::vector<std::string>>{"number"}); }),
            "stage square_number reads 'number' as vector<string>, but declares Number");
}

TEST_F(StageContextTest, RefusesToWriteTwiceOrNotAtAll) {
  EXPECT_EQ(message_of<std::logic_error>([&] { StageContext(spec, inputs).finish(); }),
            "stage square_number did not write 'square'");
  unit.write(kSquare, Number{});
  EXPECT_EQ(message_of<std::logic_error>([&] { unit.write(kSquare, Number{}); }),
            "stage square_number writes 'square' twice");
}

TEST_F(StageContextTest, ProvesThatNothingIsLost) {
  unit.write(kSquare, Number{});
  unit.count_in(10);
  unit.count_out(6);
  unit.reject("too small", 3);
  EXPECT_EQ(message_of<std::logic_error>([&] { unit.finish(); }),
            "stage square_number lost count in square_number/tile_000001: 10 in, 6 out, 3 rejected");
}

TEST_F(StageContextTest, ASourceCountsOutOnly) {
  unit.write(kSquare, Number{});
  unit.count_out(6);
  EXPECT_EQ(unit.finish().counts.out, 6);
}

TEST_F(StageContextTest, CountingNothingInIsCounting) {
  unit.write(kSquare, Number{});
  unit.count_in(0);
  unit.count_out(1);
  EXPECT_THROW(unit.finish(), std::logic_error);
}

TEST_F(StageContextTest, KnowsItsTileAndHalo) {
  EXPECT_EQ(unit.tile().index, 1);
  EXPECT_EQ(unit.cells_with_halo(), (Window{7, -3, 16, 16}));
  const StageSpec map = toy::SumSquares::spec();
  const UnitInputs no_tile;
  EXPECT_EQ(message_of<std::logic_error>([&] { StageContext(map, no_tile).tile(); }),
            "stage sum_squares has map scope: it has no tile");
}

TEST_F(StageContextTest, ManyTilesAreReadWithReadAll) {
  const StageSpec map = toy::SumSquares::spec();
  const UnitInputs gathered{.id = "sum_squares/map", .ports = {{"square", {.items = {}, .many = true}}}};
  StageContext all(map, gathered);
  EXPECT_TRUE(all.read_all(In<Number>{"square"}).empty());
  EXPECT_THAT(message_of<std::logic_error>([&] { all.read(In<Number>{"square"}); }),
              HasSubstr("use read_all"));
}

TEST_F(StageContextTest, PathsStartAtTheJob) {
  EXPECT_EQ(unit.path("dem.tif"), "jobs/dem.tif");
  EXPECT_EQ(unit.path("/data/dem.tif"), "/data/dem.tif");
  EXPECT_EQ(unit.path("/vsizip/a.zip/dem.tif"), "/vsizip/a.zip/dem.tif");
  EXPECT_EQ(unit.path("NETCDF:dem.nc:z"), "NETCDF:dem.nc:z");
  EXPECT_EQ(resolve_path("", "dem.tif"), "dem.tif");
}

TEST(Artifact, IsLoadedOnceAndAfterAFailureAgain) {
  int calls = 0;
  Artifact artifact([&]() -> Artifact::Value {
    if (++calls == 1) throw std::runtime_error("disk");
    return std::make_shared<const Number>(5);
  });
  EXPECT_THROW(artifact.value(), std::runtime_error);
  EXPECT_EQ(artifact.value(), artifact.value());
  EXPECT_EQ(calls, 2);
}

TEST(Tile, ListsSurviveTheDisk) {
  const std::vector<Tile> tiles{{.index = 0, .column = 0, .row = 0, .cells = {0, 0, 64, 64}},
                                {.index = 1, .column = 1, .row = 0, .cells = {64, 0, 1, 64}}};
  using TileCodec = Codec<std::vector<Tile>>;
  EXPECT_EQ(TileCodec::decode(TileCodec::encode(tiles)), tiles);
  EXPECT_ANY_THROW(TileCodec::decode("[[1, 2]]"));
}

}  // namespace
}  // namespace waymark::test
