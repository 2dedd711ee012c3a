// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>
#include "core/input_file.hpp"
#include "pipeline/engine/artifact.hpp"
#include "pipeline/engine/file_hash.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/plan.hpp"
#include "pipeline/engine/report.hpp"
namespace waymark {

/// How far a stage is. Given to one caller at a time, at most 20 times a second and at the end of each stage.
struct Progress {
  std::string stage;
  double done = 0;  ///< units, parts of units included
  std::int64_t total = 0;
  double rate = 0;  ///< units per second since the stage began; 0 at the start
};

/// Share `index` of `count`, from 1: 3/8. Tile-scope units go round robin; a map-scope unit is done by every
/// share that finds its inputs complete, so the last share finishes the job.
struct Shard {
  int index = 1, count = 1;
};

struct RunOptions {
  /// Where results are kept so that a later run can go on; empty: in memory, nothing is written.
  std::filesystem::path work = {};
  int threads = 0;  ///< 0: as many as the machine has
  std::optional<Shard> shard = {};
  std::string unit = {};        ///< do this unit only, "find_mountain_tops/tile_000003"
  std::string rerun_from = {};  ///< make this stage and what depends on it anew
  /// Artifacts of the map that the caller will ask for. The others are let go of after the last stage that
  /// reads them; empty: none are.
  std::vector<std::string> results = {};
  /// Results of tiles that a stage of the map need not see at once are kept out of memory: in the work
  /// folder, else what exceeds this many bytes per stage in a nameless file in `scratch` (empty: the system's
  /// folder for temporary files).
  std::filesystem::path scratch = {};
  std::size_t held_bytes = std::size_t{32} << 20;
  bool check_only = false;  ///< stop after planning: options, wiring, files
  std::function<void(const Progress&)> progress = {};
  FileHasher hash_file = hash_plain_file;
};

class RunResult {
 public:
  RunReport report;
  std::vector<InputFile> inputs;  ///< every file the stages named, once, in their order

  /// A map-scope artifact. Throws Error where it was not made, with the first failure; std::logic_error where
  /// not one stage writes that name and type, or it belongs to tiles or images.
  template <class T>
  const T& artifact(std::string_view name) const& {
    return *static_cast<const T*>(find_one(name, typeid(T)).get());
  }
  template <class T>
  const T& artifact(std::string_view name) const&& = delete;  // would dangle

  /// Reads one artifact each time it is called, which stays in memory no longer than it is used.
  template <class T>
  using Reader = std::function<std::shared_ptr<const T>()>;

  /// Whether every unit of the stage wrote that.
  bool whole(std::string_view stage, std::string_view name) const;

  /// What all stages wrote under that name and type, stage by stage, each in the order of its tiles or
  /// images; without what was not made, and what was released after the last stage that reads it.
  template <class T>
  std::vector<std::shared_ptr<const T>> artifacts(std::string_view name) const {
    std::vector<std::shared_ptr<const T>> all;
    for (auto& value : find_all(name, typeid(T))) all.push_back(std::static_pointer_cast<const T>(value));
    return all;
  }
  /// The same out of the result, of tiles alone: to be read one by one, as there may be more than memory
  /// holds.
  template <class T>
  std::vector<Reader<T>> take_readers(std::string_view name) {
    std::vector<Reader<T>> readers;
    for (ArtifactPtr& item : take_tiles(name, typeid(T)))
      readers.push_back([item] { return std::static_pointer_cast<const T>(item->value()); });
    return readers;
  }
  /// The same, out of the result: without a copy where nobody else holds them.
  template <class T>
  std::vector<T> take(std::string_view name) {
    std::vector<Artifact::Value> values = find_all(name, typeid(T));
    std::erase_if(artifacts_, [&](const Kept& kept) { return kept.name == name; });
    std::vector<T> all;
    for (auto& value : values) all.push_back(own<T>(std::move(value)));
    return all;
  }

 private:
  friend class Run;
  struct Kept {
    std::string stage, name;
    std::type_index type;
    Scope scope;
    std::vector<ArtifactPtr> items;  ///< null where not made
  };
  Artifact::Value find_one(std::string_view name, std::type_index type) const;
  std::vector<Artifact::Value> find_all(std::string_view name, std::type_index type) const;
  std::vector<ArtifactPtr> take_tiles(std::string_view name, std::type_index type);

  std::vector<Kept> artifacts_;
};

/// Runs what is not yet in the work folder. Units of a stage run in parallel; results and report do not
/// depend on threads. A unit that throws becomes a failure, units that read it are skipped, the others go on.
/// Throws Error where the job itself is wrong or a listing stage fails, std::logic_error where a stage breaks
/// its own declaration.
RunResult run(const Pipeline& pipeline, const RunOptions& options = {});

/// The units a run would do. Runs the listing stages.
Plan plan(const Pipeline& pipeline, const RunOptions& options = {});

}  // namespace waymark
