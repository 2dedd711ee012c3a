// SPDX-License-Identifier: Apache-2.0
// Results in parts: written, stored and read with one part in memory.
#include "pipeline/engine/parts.hpp"

#include "core/text_file.hpp"
#include "pipeline/engine/sha256.hpp"
#include "pipeline/engine/store/parts_file.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

Parts<Number> parts_of(std::initializer_list<std::int64_t> values, std::size_t in_memory = 0) {
  PartsWriter<Number> writer(std::make_shared<ScratchFile>(std::filesystem::path(), in_memory));
  for (const std::int64_t value : values) writer.add(Number{value});
  return writer.parts();
}

std::vector<std::int64_t> values_of(const Parts<Number>& parts) {
  std::vector<std::int64_t> values;
  for (std::size_t i = 0; i < parts.count(); ++i) values.push_back(parts.read(i).value);
  return values;
}

std::string bytes_of(const std::filesystem::path& file) {
  return read_text(file, "the parts");
}

TEST(Parts, OutliveTheirWriter) {
  EXPECT_THAT(values_of(parts_of({3, 141, 59})), testing::ElementsAre(3, 141, 59));
  EXPECT_THAT(values_of(parts_of({3, 141, 59}, 1000)), testing::ElementsAre(3, 141, 59));
}

TEST(Parts, AreReplacedOneByOne) {
  PartsWriter<Number> writer(std::make_shared<ScratchFile>(std::filesystem::path(), 0));
  for (const std::int64_t value : {1, 2, 3}) writer.add(Number{value});
  const Parts<Number> before = writer.parts();
  writer.replace(1, Number{20});
  EXPECT_THAT(values_of(writer.parts()), testing::ElementsAre(1, 20, 3));
  EXPECT_THAT(values_of(before), testing::ElementsAre(1, 2, 3));
}

TEST(Parts, AreStoredAsTheirCodecEncodesThem) {
  const TemporaryFolder folder;
  for (const auto& parts : {parts_of({}), parts_of({7}), parts_of({7, 1234567, 0})}) {
    const std::string sum = write_parts(folder / "parts.bin", parts.encoded());
    const std::string bytes = Codec<Parts<Number>>::encode(parts);
    EXPECT_EQ(bytes_of(folder / "parts.bin"), bytes);
    EXPECT_EQ(sum, sha256(bytes));
    EXPECT_EQ(values_of(Parts<Number>(open_parts(folder / "parts.bin"))), values_of(parts));
    EXPECT_EQ(values_of(Codec<Parts<Number>>::decode(bytes)), values_of(parts));
  }
}

TEST(Parts, DamagedFilesAreRefused) {
  const TemporaryFolder folder;
  write_parts(folder / "parts.bin", parts_of({7, 1234567}).encoded());
  const std::string whole = bytes_of(folder / "parts.bin");
  const auto opened = [&](const std::string& bytes) {
    std::ofstream(folder / "parts.bin", std::ios::binary) << bytes;
    return message_of<std::runtime_error>([&] { open_parts(folder / "parts.bin"); });
  };
  EXPECT_EQ(opened(whole.substr(0, 4)), "the file is too short");
  EXPECT_EQ(opened(whole.substr(0, whole.size() - 1)), "the file is too short");
  EXPECT_EQ(opened(whole + "x"), "the file is too long");
  EXPECT_EQ(opened(std::string(8, '\xff') + whole.substr(8)), "the file is too short");
}

// Doubles the numbers of all tiles, gathered as a stream, in parts.
struct DoubleNumbers {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr GatherStream<Number> square{"square"};
  static constexpr Out<Parts<Number>> doubled{"doubled"};
  static StageSpec spec() {
    return {.name = "double_numbers",
            .summary = "Doubles",
            .version = 1,
            .scope = Scope::map,
            .inputs = {square},
            .outputs = {doubled}};
  }
  static void run(const Options&, StageContext& unit) {
    std::int64_t sum = 0;
    for (const auto& read : unit.readers(square)) sum += read()->value;
    PartsWriter<Number> writer(unit.make_scratch_file(0));
    unit.consume(square, [&](Number&& number) {
      writer.add(Number{2 * number.value});
      sum -= number.value;
    });
    if (sum != 0) throw Error(ErrorCode::input, "readers and consume() disagree");
    unit.write(doubled, writer.parts());
  }
};

class PartsOfARun : public ToyTest {
 protected:
  std::vector<std::int64_t> doubled(const RunOptions& options) {
    Registry stages = toy::registry();
    stages.add<DoubleNumbers>();
    Pipeline numbers(stages);
    numbers.add("list_numbers").add("square_number").add("double_numbers");
    RunResult result = run(numbers, options);
    made_ = result.report.stages.back().made;
    std::vector<std::int64_t> values;
    for (const auto& read : result.take_parts<Number>("doubled")) values.push_back(read()->value);
    return values;
  }
  std::int64_t made_ = 0;
};

TEST_F(PartsOfARun, AreTheSameInMemoryAndInAWorkFolder) {
  const std::vector<std::int64_t> expected = doubled({});
  EXPECT_THAT(expected, testing::ElementsAre(18, 32, 50, 72));
  EXPECT_EQ(doubled({.work = work}), expected);
  EXPECT_EQ(made_, 1);
  EXPECT_EQ(doubled({.work = work}), expected);
  EXPECT_EQ(made_, 0);  // read from the folder
}

TEST_F(PartsOfARun, DamageIsFoundAndMended) {
  const std::vector<std::int64_t> expected = doubled({.work = work});
  for (const auto& entry : std::filesystem::recursive_directory_iterator(work))
    if (entry.path().filename() == "doubled.bin")
      std::fstream(entry.path(), std::ios::binary | std::ios::in | std::ios::out).seekp(40).put('9');
  EXPECT_EQ(doubled({.work = work}), expected);
  EXPECT_EQ(made_, 1);
}

}  // namespace
}  // namespace waymark::test
