// SPDX-License-Identifier: Apache-2.0
// Taken artifacts are moved to the last reader and copied for others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;

/// Counts how often it was copied.
struct Parcel {
  Parcel() = default;
  Parcel(const Parcel& other) : copies(other.copies + 1) {}
  Parcel(Parcel&&) = default;
  Parcel& operator=(const Parcel&) = delete;
  Parcel& operator=(Parcel&&) = default;
  int copies = 0;
};
}  // namespace waymark::test

namespace waymark::pipeline {

template <>
struct Codec<test::Parcel> {
  static std::string encode(const test::Parcel& parcel) { return std::to_string(parcel.copies); }
  static test::Parcel decode(std::string_view text) {
    test::Parcel parcel;
    parcel.copies = std::stoi(std::string(text));
    return parcel;
  }
};

}  // namespace waymark::pipeline

namespace waymark::test {
using namespace pipeline;

namespace {

struct SendParcel {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr Out<std::vector<Tile>> tiles{"tiles"};
  static constexpr Out<Parcel> sent{"sent"};
  static StageSpec spec() {
    return {.name = "send_parcel",
            .summary = "Sends",
            .version = 1,
            .scope = Scope::map,
            .lists = Scope::tile,
            .outputs = {tiles, sent}};
  }
  static void run(const Options&, StageContext& unit) {
    unit.write(tiles, {Tile{.cells = {0, 0, 1, 1}}});
    unit.write(sent, Parcel());
  }
};

template <int number>
struct Take {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr const char* kStage = number == 1 ? "take_first" : "take_second";
  static constexpr In<Parcel> sent{"sent"};
  static constexpr Out<Parcel> received{number == 1 ? "first" : "second"};
  static StageSpec spec() {
    return {.name = kStage,
            .summary = "Receives",
            .version = 1,
            .scope = Scope::map,
            .inputs = {sent},
            .outputs = {received}};
  }
  static void run(const Options&, StageContext& unit) { unit.write(received, unit.take(sent)); }
};

class TakeTest : public testing::Test {
 protected:
  TakeTest() {
    registry.add<SendParcel>();
    registry.add<Take<1>>();
    registry.add<Take<2>>();
  }
  Pipeline pipeline_of(std::initializer_list<const char*> stages) {
    Pipeline pipeline(registry);
    for (const char* stage : stages) pipeline.add(stage);
    return pipeline;
  }
  Registry registry;
};

TEST_F(TakeTest, TheLastReaderGetsItUncopied) {
  const RunOptions only_last{.results = {"second"}};
  const RunResult result = run(pipeline_of({"send_parcel", "take_first", "take_second"}), only_last);
  EXPECT_EQ(result.artifact<Parcel>("first").copies, 1);   // take_second needed it as well
  EXPECT_EQ(result.artifact<Parcel>("second").copies, 0);  // nobody did
  EXPECT_THAT(result.artifacts<Parcel>("sent"), testing::IsEmpty());
}

TEST_F(TakeTest, AResultIsKept) {
  for (const std::vector<std::string>& results : {std::vector<std::string>{}, {"sent"}}) {
    const RunResult result = run(pipeline_of({"send_parcel", "take_first"}), {.results = results});
    EXPECT_EQ(result.artifact<Parcel>("first").copies, 1);
    EXPECT_EQ(result.artifact<Parcel>("sent").copies, 0);
  }
}

TEST_F(TakeTest, AWorkFolderKeepsWhatWasTaken) {
  const TemporaryFolder work;
  const RunOptions options{.work = work, .results = {"first"}};
  run(pipeline_of({"send_parcel", "take_first"}), options);
  RunOptions all = options;
  all.results = {};
  const RunResult again = run(pipeline_of({"send_parcel", "take_first"}), all);
  EXPECT_EQ(again.report.stages[0].reused, 1);
  EXPECT_EQ(again.artifact<Parcel>("sent").copies, 0);
  EXPECT_EQ(again.artifact<Parcel>("first").copies, 0);
}

TEST_F(TakeTest, TheCallerTakesWithoutACopy) {
  RunResult result = run(pipeline_of({"send_parcel"}));
  EXPECT_EQ(result.take<Parcel>("sent").at(0).copies, 0);
  EXPECT_THROW(result.artifact<Parcel>("sent"), std::logic_error);
}

}  // namespace
}  // namespace waymark::test
