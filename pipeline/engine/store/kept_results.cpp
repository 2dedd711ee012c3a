// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/store/kept_results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "pipeline/engine/sha256.hpp"
#include "pipeline/engine/store/artifact_store.hpp"

namespace waymark::pipeline {
namespace {

Unit unit_of(const KeptStep& step) {
  Unit unit;
  unit.stage = step.name;
  unit.item = step.item;
  std::ranges::replace(unit.item, '/', '_');  // images of folders
  unit.fingerprint = step.fingerprint();
  return unit;
}

StageSpec spec_of(const KeptStep& step, const OutputPort& port) {
  StageSpec spec;
  spec.name = step.name;
  spec.version = step.version;
  spec.outputs = {port};
  return spec;
}

}  // namespace

std::string KeptStep::fingerprint() const {
  return Sha256().add(fmt::format("{} {} {}\n", name, item, version)).add(depends_on).hex().substr(0, 32);
}

KeptResults::KeptResults(std::filesystem::path folder)
    : store_(folder.empty() ? nullptr : std::make_unique<ArtifactStore>(std::move(folder))) {}
KeptResults::~KeptResults() = default;
KeptResults::KeptResults(KeptResults&&) noexcept = default;
KeptResults& KeptResults::operator=(KeptResults&&) noexcept = default;

std::optional<KeptResults::Result> KeptResults::find(const KeptStep& step, const OutputPort& port) const {
  if (!store_) return std::nullopt;
  auto stored = store_->find(unit_of(step), spec_of(step, port));
  if (!stored) return std::nullopt;
  try {
    return Result{stored->artifacts.at(port.name)->take(), std::move(stored->warnings)};
  } catch (const Error&) {
    return std::nullopt;  // written by another version of the layout: computed again
  }
}

void KeptResults::save(const KeptStep& step, const OutputPort& port, const Result& result) const {
  UnitOutcome outcome;
  outcome.outputs.emplace(port.name, result.value);
  outcome.warnings = result.warnings;
  store_->save(unit_of(step), spec_of(step, port), outcome);
}

}  // namespace waymark::pipeline
