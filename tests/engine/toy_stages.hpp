// SPDX-License-Identifier: Apache-2.0
// A pipeline small enough to know all its answers: list_numbers -> square_number (per tile) -> sum_squares.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/stage.hpp"
namespace waymark {

/// A whole number as an artifact.
struct Number {
  std::int64_t value = 0;
};
template <>
struct Codec<Number> {
  static std::string encode(const Number& number) { return std::to_string(number.value); }
  static Number decode(std::string_view text) { return {std::stoll(std::string(text))}; }
};

namespace toy {

/// What tests do to running stages, and see of them. Reset by ToyTest.
struct Watch {
  std::atomic<int> listed = 0, squared = 0, summed = 0;     ///< how often each stage ran
  std::function<void(const StageContext&)> in_square = {};  ///< called by square_number in every tile
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

/// (number + index)^power per tile; odd results are rejected on request.
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

/// The sum of all squares, as text that shows their order: "9+16+25+36=86".
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

template <>
struct Codec<std::string> {
  static std::string encode(const std::string& text) { return text; }
  static std::string decode(std::string_view text) { return std::string(text); }
};

/// list_numbers, square_number, sum_squares with their defaults.
Pipeline toy_pipeline(const Registry& registry);

/// A folder of its own that is gone in the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  operator const std::filesystem::path&() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace waymark
