// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <memory>
#include <string>
#include <utility>
#include <vector>
#include "core/options.hpp"
#include "pipeline/engine/stage_context.hpp"
#include "pipeline/engine/stage_spec.hpp"
namespace waymark::pipeline {

/// Requirements of a stage.
template <class S>
concept StageLike = std::copyable<typename S::Options> &&
    requires(typename S::Options options, StageContext& unit, OptionVisitor& visitor) {
  { S::spec() } -> std::same_as<StageSpec>;
  S::run(std::as_const(options), unit);
  options.describe(visitor);
};

/// Step of a pipeline: a type-erased stage with its options.
class Step {
 public:
  virtual ~Step() = default;
  virtual const StageSpec& spec() const = 0;
  /// Passes a copy of the options to a visitor.
  virtual void show_options(OptionVisitor& visitor) const = 0;
  /// Passes the options to a visitor that may change them.
  virtual void change_options(OptionVisitor& visitor) = 0;
  /// Returns the files that the options name, unresolved. Their contents enter fingerprint and provenance.
  virtual std::vector<std::string> input_files() const = 0;
  /// Checks the options against the map-scope artifacts that planning made. Throws Error as `run` would.
  virtual void check_inputs(StageContext& unit) const = 0;
  virtual void run(StageContext& unit) const = 0;
  virtual std::unique_ptr<Step> clone() const = 0;
};

/// Step made of a stage.
template <StageLike Stage>
class TypedStep final : public Step {
 public:
  using Options = typename Stage::Options;
  explicit TypedStep(Options options = {}) : options_(std::move(options)) {}

  const StageSpec& spec() const override { return spec_; }
  void show_options(OptionVisitor& visitor) const override { Options(options_).describe(visitor); }
  void change_options(OptionVisitor& visitor) override { options_.describe(visitor); }
  std::vector<std::string> input_files() const override {
    if constexpr (requires { Stage::input_files(options_); }) return Stage::input_files(options_);
    return {};
  }
  void check_inputs([[maybe_unused]] StageContext& unit) const override {
    if constexpr (requires { Stage::check_inputs(options_, unit); }) Stage::check_inputs(options_, unit);
  }
  void run(StageContext& unit) const override { Stage::run(options_, unit); }
  std::unique_ptr<Step> clone() const override { return std::make_unique<TypedStep>(options_); }

 private:
  StageSpec spec_ = Stage::spec();
  Options options_;
};

}  // namespace waymark::pipeline
