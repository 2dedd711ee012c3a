// SPDX-License-Identifier: Apache-2.0
// Small pipeline with known results: list_numbers -> square_number (per tile) -> sum_squares.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/stage.hpp"
namespace waymark::test {
using namespace pipeline;

/// A whole number as an artifact.
struct Number {
  std::int64_t value = 0;
};
}  // namespace waymark::test

namespace waymark::pipeline {

template <>
struct Codec<test::Number> {
  static std::string encode(const test::Number& number) { return std::to_string(number.value); }
  static test::Number decode(std::string_view text) { return {std::stoll(std::string(text))}; }
};

}  // namespace waymark::pipeline

namespace waymark::test {
using namespace pipeline;

namespace toy {

/// Counters and hooks of running stages. Reset by ToyTest.
struct Watch {
  std::atomic<int> listed = 0, squared = 0, summed = 0;  ///< how often each stage ran
  std::function<void(StageContext&)> in_square = {};     ///< called by square_number in every tile
};
Watch& watch();

/// Tiles in one row, 10 x 10 cells each; writes 3 to "number".
struct ListNumbers {
  struct Options {
    std::int64_t tiles = 4;
    std::vector<std::string> files;
    void describe(OptionVisitor& option);
  };
  static constexpr Out<std::vector<Tile>> tiles{"tiles"};
  static constexpr Out<Number> number{"number"};
  static StageSpec spec();
  static std::vector<std::string> input_files(const Options& options) { return options.files; }
  static void run(const Options& options, StageContext& unit);
};

/// Writes (number + index)^power per tile; odd results are rejected on request.
struct SquareNumber {
  struct Options {
    double power = 2;
    std::string keep = "all";
    Meters height{20};
    bool loud = false;
    std::int64_t memory = 1;
    void describe(OptionVisitor& option);
  };
  static constexpr In<Number> number{"number"};
  static constexpr Out<Number> square{"square"};
  static StageSpec spec();
  static void run(const Options& options, StageContext& unit);
};

/// Sums all squares, as text that shows their order: "9+16+25+36=86".
struct SumSquares {
  struct Options {
    std::string sign = "+";
    void describe(OptionVisitor& option);
  };
  static constexpr In<Number> square{"square"};
  static constexpr Out<std::string> sum{"sum"};
  static StageSpec spec();
  static void run(const Options& options, StageContext& unit);
};

Registry registry();

}  // namespace toy

}  // namespace waymark::test

namespace waymark::pipeline {

template <>
struct Codec<std::string> {
  static std::string encode(const std::string& text) { return text; }
  static std::string decode(std::string_view text) { return std::string(text); }
};

}  // namespace waymark::pipeline

namespace waymark::test {
using namespace pipeline;

/// Returns list_numbers, square_number, sum_squares with default options.
Pipeline toy_pipeline(const Registry& registry);

/// Folder that is removed on destruction.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  operator const std::filesystem::path&() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace waymark::test
