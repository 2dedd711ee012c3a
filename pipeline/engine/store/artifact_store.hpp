// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/artifact.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/stage_context.hpp"
#include "pipeline/engine/stage_spec.hpp"
namespace waymark::pipeline {

/// Result of a unit as found on disk. Artifacts are decoded when first read.
struct StoredUnit {
  Counts counts;
  std::vector<std::string> warnings;
  std::map<std::string, ArtifactPtr, std::less<>> artifacts;
};

/// Work folder with the layout <stage>/<item>/<fingerprint>/{<port>.bin, manifest.json}.
/// - A result is written in a LockedFolder and renamed, so it is complete or absent if the process is killed.
/// - The manifest holds the SHA-256 of every file, so damage is detected.
/// - Processes may share the folder: the first to finish a unit wins, the others drop their equal copy.
/// - Files are not synced to the device: results damaged by a power loss are computed again.
class ArtifactStore {
 public:
  /// Throws Error{output} if the folder cannot be created.
  explicit ArtifactStore(std::filesystem::path folder);

  /// Returns `std::nullopt` if the result is missing, truncated or damaged.
  std::optional<StoredUnit> find(const Unit& unit, const StageSpec& spec) const;
  /// Returns one port of an existing result, decoded when read. Values of tiles are released after each
  /// reading.
  ArtifactPtr artifact(const Unit& unit, const StageSpec& spec, const OutputPort& port) const;
  /// Returns whether the result exists, without verifying it.
  bool contains(const Unit& unit) const;
  /// Throws Error{output} if the result cannot be written.
  void save(const Unit& unit, const StageSpec& spec, const UnitOutcome& outcome) const;
  void remove(const Unit& unit) const;
  /// Writes <fingerprint>.failure.json beside the result's folder; `save` removes it when the unit succeeds.
  void save_failure(const Unit& unit, std::string_view message) const;

 private:
  std::filesystem::path item_folder(const Unit& unit) const;
  std::filesystem::path result_folder(const Unit& unit) const;
  std::filesystem::path failure_file(const Unit& unit) const;

  std::filesystem::path folder_;
};

}  // namespace waymark::pipeline
