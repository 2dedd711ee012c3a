// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <sstream>

#include "core/text_file.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::atomic<int> g_counted = 0;

/// Lists text files; needs a number that another stage writes while planning.
struct ListTexts {
  struct Options {
    std::vector<std::string> files;
    void describe(OptionVisitor& option) { option("files", files, {.help = "Texts"}); }
  };
  static constexpr In<Number> number{"number"};
  static constexpr Out<std::vector<ImageItem>> images{"images"};
  static StageSpec spec() {
    return {
        .name = "list_texts", .summary = "", .lists = Scope::image, .inputs = {number}, .outputs = {images}};
  }
  static void run(const Options& options, StageContext& unit) {
    std::vector<ImageItem> items;
    for (const std::string& file : options.files)
      items.push_back({.index = std::ssize(items),
                       .name = std::filesystem::path(file).filename(),
                       .file = file,
                       .content = std::to_string(unit.read(number).value)});
    unit.write(images, items);
  }
};

struct NoOptions {
  void describe(OptionVisitor&) {}
};

std::string text_of(const StageContext& unit) {
  std::istringstream file(read_text(unit.image().file, "the image"));
  std::string text;
  std::getline(file, text);
  return text;
}

/// Two stages that write the same artifact name.
template <char letter>
struct CountLetter {
  using Options = NoOptions;
  static constexpr Out<Number> found{"found"};
  static StageSpec spec() {
    return {.name = std::string("count_") + letter, .summary = "", .scope = Scope::image, .outputs = {found}};
  }
  static void run(const Options&, StageContext& unit) {
    ++g_counted;
    const std::string text = text_of(unit);
    unit.write(found, Number{std::ranges::count(text, letter)});
  }
};

/// Gathers the results of all stages for the same text.
struct SumUp {
  using Options = NoOptions;
  static constexpr Gather<Number> found{"found"};
  static constexpr Out<std::string> line{"line"};
  static StageSpec spec() {
    return {.name = "sum_up", .summary = "", .scope = Scope::image, .inputs = {found}, .outputs = {line}};
  }
  static void run(const Options&, StageContext& unit) {
    std::string text = unit.image().name;
    for (const auto& number : unit.read_all(found)) text += " " + std::to_string(number->value);
    unit.write(line, text);
  }
};

struct WritePage {
  using Options = NoOptions;
  static constexpr Gather<std::string> line{"line"};
  static constexpr Gather<Number> found{"found"};
  static constexpr Out<std::string> page{"page"};
  static StageSpec spec() {
    return {.name = "write_page", .summary = "", .inputs = {line, found}, .outputs = {page}};
  }
  static void run(const Options&, StageContext& unit) {
    std::string text;
    for (const auto& one : unit.read_all(line)) text += *one + "; ";
    for (const auto& number : unit.read_all(found)) text += std::to_string(number->value);
    unit.write(page, text);
  }
};

class ImageScope : public testing::Test {
 protected:
  ImageScope() {
    registry.add<toy::ListNumbers>();
    registry.add<ListTexts>();
    registry.add<CountLetter<'a'>>();
    registry.add<CountLetter<'b'>>();
    registry.add<SumUp>();
    registry.add<WritePage>();
    g_counted = 0;
    save("one", "a");
    save("two", "abb");
    save("three", "bbb");
  }
  void save(const std::string& name, const std::string& text) { std::ofstream(texts / name) << text << '\n'; }

  Pipeline pipeline(const std::vector<std::string>& names) {
    std::vector<std::string> files;
    for (const auto& name : names) files.push_back(texts / name);
    Pipeline job(registry);
    job.add("list_numbers")
        .add<ListTexts>({files})
        .add("count_a")
        .add("count_b")
        .add("sum_up")
        .add("write_page");
    return job;
  }
  /// Returns the page and the number of texts searched for a letter.
  std::string page(const RunResult& result) {
    return result.artifact<std::string>("page") + " after " + std::to_string(g_counted.exchange(0));
  }

  Registry registry;
  TemporaryFolder texts, work;
};

TEST_F(ImageScope, GathersStageByStageThenImageByImage) {
  const RunResult result = run(pipeline({"one", "two", "three"}));
  EXPECT_EQ(page(result), "one 1 0; two 1 2; three 0 3; 110023 after 6");
  ASSERT_EQ(result.inputs.size(), 3U);
  EXPECT_EQ(result.inputs[1], hash_plain_file(texts / "two"));
}

TEST_F(ImageScope, OneMoreImageLeavesTheOthersAlone) {
  const RunOptions options{.work = work};
  EXPECT_EQ(page(run(pipeline({"one", "three"}), options)), "one 1 0; three 0 3; 1003 after 4");
  EXPECT_EQ(page(run(pipeline({"one", "two", "three"}), options)),
            "one 1 0; two 1 2; three 0 3; 110023 after 2");
  EXPECT_EQ(page(run(pipeline({"three", "one"}), options)), "three 0 3; one 1 0; 0130 after 0");
}

TEST_F(ImageScope, AnotherPictureUnderTheSameNameIsReadAgain) {
  const RunOptions options{.work = work};
  run(pipeline({"one", "two"}), options);
  save("two", "bbbb");
  g_counted = 0;
  EXPECT_EQ(page(run(pipeline({"one", "two"}), options)), "one 1 0; two 0 4; 1004 after 2");
}

// A disk may fail once: the stage had the image, the record of the run would lack it.
TEST_F(ImageScope, AnImageWhoseHashIsNotKnownIsNotPassedOver) {
  RunOptions options{.work = work};
  options.hash_file = [](const std::string& file) {
    if (file.ends_with("two")) throw Error(ErrorCode::input, "reading the file failed", file);
    return hash_plain_file(file);
  };
  const RunResult result = run(pipeline({"one", "two"}), options);
  EXPECT_EQ(result.report.exit_code(), 3);
  ASSERT_EQ(result.report.failures.size(), 1U);
  EXPECT_THAT(result.report.failures[0].unit, testing::EndsWith("two"));
  EXPECT_THAT(result.report.failures[0].message, HasSubstr("to record its hash"));
  EXPECT_EQ(run(pipeline({"one", "two"}), {.work = work}).report.exit_code(), 0);
}

TEST_F(ImageScope, AMissingImageDoesNotStopTheRest) {
  const RunOptions options{.work = work};
  const RunResult result = run(pipeline({"one", "lost", "three"}), options);
  EXPECT_EQ(result.report.exit_code(), 3);
  EXPECT_EQ(page(result), "one 1 0; three 0 3; 1003 after 6");
  EXPECT_EQ(result.report.failures.size(), 2U);
  EXPECT_THAT(result.report.stages.back().warnings,
              testing::Contains(HasSubstr("made without 1 of 3 results of count_a, which failed")));

  save("lost", "ab");  // only the failed units and their dependents
  EXPECT_EQ(page(run(pipeline({"one", "lost", "three"}), options)),
            "one 1 0; lost 1 1; three 0 3; 110013 after 2");
}

TEST_F(ImageScope, SharesInAnyOrder) {
  RunOptions options{.work = work};
  for (const int share : {3, 1, 2}) {
    options.shard = Shard{share, 3};
    run(pipeline({"one", "two", "three"}), options);
  }
  EXPECT_EQ(g_counted.exchange(0), 6);
  options.shard.reset();
  EXPECT_EQ(page(run(pipeline({"one", "two", "three"}), options)),
            "one 1 0; two 1 2; three 0 3; 110023 after 0");
}

TEST_F(ImageScope, AnyNumberOfThreads) {
  std::vector<std::string> names;
  for (int i = 0; i < 40; ++i) save(names.emplace_back("n" + std::to_string(i)), std::string(i, 'a'));
  const std::string one = page(run(pipeline(names), {.threads = 1}));
  EXPECT_EQ(page(run(pipeline(names), {.threads = 2})), one);
}

TEST_F(ImageScope, NamesUnitsAfterImages) {
  save("a b/c", "");
  const Plan units = plan(pipeline({"one", "two"}), {.work = work});
  EXPECT_EQ(units.units[3].id(), "count_a/image_two");
  EXPECT_EQ(unit_item({.index = 0, .name = "a b/ü", .file = "", .content = ""}), "image_a%20b%2F%C3%BC");
  const std::vector<ImageItem> items{{0, "a", "b", "c"}, {1, "", "", std::string("\0x", 2)}};
  EXPECT_EQ(Codec<std::vector<ImageItem>>::decode(Codec<std::vector<ImageItem>>::encode(items)), items);
}

TEST_F(ImageScope, NeedsAStageThatListsImages) {
  Pipeline job(registry);
  job.add("list_numbers").add("count_a");
  EXPECT_EQ(message_of([&] { job.check(); }),
            "stages[1] count_a works on images, but no stage before it lists them\n"
            "  add before it: list_texts");
}

}  // namespace
}  // namespace waymark::test
