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
namespace waymark {

/// What makes a struct a stage.
template <class S>
concept StageLike = std::copyable<typename S::Options> &&
    requires(typename S::Options options, StageContext& unit, OptionVisitor& visitor) {
  { S::spec() } -> std::same_as<StageSpec>;
  S::run(std::as_const(options), unit);
  options.describe(visitor);
};

/// A stage with its options, its type forgotten: one step of a pipeline.
class Step {
 public:
  virtual ~Step() = default;
  virtual const StageSpec& spec() const = 0;
  /// Shows the options to a visitor that only looks.
  virtual void show_options(OptionVisitor& visitor) const = 0;
  /// Lets the visitor change them.
  virtual void change_options(OptionVisitor& visitor) = 0;
  /// Files the options name, as written there; their contents enter the fingerprint and the provenance.
  virtual std::vector<std::string> input_files() const = 0;
  virtual void run(StageContext& unit) const = 0;
  virtual std::unique_ptr<Step> clone() const = 0;
};

template <StageLike Stage>
class StepOf final : public Step {
 public:
  using Options = typename Stage::Options;
  explicit StepOf(Options options = {}) : options_(std::move(options)) {}

  const StageSpec& spec() const override { return spec_; }
  void show_options(OptionVisitor& visitor) const override { Options(options_).describe(visitor); }
  void change_options(OptionVisitor& visitor) override { options_.describe(visitor); }
  std::vector<std::string> input_files() const override {
    if constexpr (requires { Stage::input_files(options_); }) return Stage::input_files(options_);
    return {};
  }
  void run(StageContext& unit) const override { Stage::run(options_, unit); }
  std::unique_ptr<Step> clone() const override { return std::make_unique<StepOf>(options_); }

 private:
  StageSpec spec_ = Stage::spec();
  Options options_;
};

}  // namespace waymark
