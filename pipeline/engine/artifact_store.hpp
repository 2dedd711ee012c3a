// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/artifact.hpp"
#include "pipeline/engine/plan.hpp"
#include "pipeline/engine/stage_context.hpp"
#include "pipeline/engine/stage_spec.hpp"
namespace waymark {

/// A unit's result as it was found on disk; artifacts are decoded when first read.
struct StoredUnit {
  Counts counts;
  std::vector<std::string> warnings;
  std::map<std::string, ArtifactPtr, std::less<>> artifacts;
};

/// The work folder: <stage>/<item>/<fingerprint>/{<port>.bin, manifest.json}. A result is written aside and
/// renamed, so it is whole or absent whenever the process is killed; the manifest holds the SHA-256 of every
/// file, so damage is noticed. Processes may share the folder: the first to finish a unit wins, the others
/// drop their equal copy. Not synced to the device: after a power loss damaged results are made again.
class ArtifactStore {
 public:
  /// Throws Error{output} where the folder cannot be made.
  explicit ArtifactStore(std::filesystem::path folder);

  /// Nothing where the result is missing, truncated or damaged.
  std::optional<StoredUnit> find(const Unit& unit, const StageSpec& spec) const;
  /// One port of a result that is there; decoded when read. Those of tiles are let go of after each reading.
  ArtifactPtr artifact(const Unit& unit, const StageSpec& spec, const OutputPort& port) const;
  /// Whether there is a result, without looking into it.
  bool contains(const Unit& unit) const;
  /// Throws Error{output} where the disk does not take it.
  void save(const Unit& unit, const StageSpec& spec, const UnitOutcome& outcome) const;
  void remove(const Unit& unit) const;
  /// Leaves <fingerprint>.failure.json beside the result's place until the unit succeeds.
  void save_failure(const Unit& unit, std::string_view message) const;

 private:
  std::filesystem::path item_folder(const Unit& unit) const;
  std::filesystem::path result_folder(const Unit& unit) const;
  std::filesystem::path failure_file(const Unit& unit) const;

  std::filesystem::path folder_;
};

}  // namespace waymark
