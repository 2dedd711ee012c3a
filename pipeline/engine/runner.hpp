// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>
#include "core/input_file.hpp"
#include "pipeline/engine/artifact.hpp"
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/parts.hpp"
#include "pipeline/engine/pipeline.hpp"
#include "pipeline/engine/progress.hpp"
#include "pipeline/engine/report.hpp"
#include "pipeline/engine/tile.hpp"
namespace waymark::inline landmarks {
class TypeRegistry;
}

namespace waymark::pipeline {

/// Smallest unit of work: one stage applied to one item.
struct Unit {
  std::string stage;
  std::string item;  ///< "map", "tile_000003" or "image_a.png"
  std::optional<Tile> tile;
  std::optional<ImageItem> image;
  std::string fingerprint;         ///< equal fingerprints mean equal results; empty without a work folder
  std::vector<std::size_t> after;  ///< indices into Plan::units of the units it reads, ascending
  bool done = false;               ///< whether its result is in the work folder

  std::string id() const { return stage + "/" + item; }
  /// Returns the index of the tile or image, from 0; `std::nullopt` for the map.
  std::optional<std::int64_t> index() const {
    return tile ? std::optional(tile->index) : image ? std::optional(image->index) : std::nullopt;
  }
};

/// Units in a valid order of execution: by stage, then by tile or image.
struct Plan {
  std::vector<Unit> units;
  std::vector<std::size_t> begins = {0};  ///< units of stage s: [begins[s], begins[s + 1])

  std::size_t stage_count() const { return begins.size() - 1; }
};

/// What a call asks a scheduler for; 0: nothing, the site decides.
struct CallResources {
  int processors = 0;          ///< also the threads of the call
  std::int64_t megabytes = 0;  ///< memory, 1e6 bytes
  std::int64_t minutes = 0;    ///< after which the scheduler ends the call
};

/// Command line by which a scheduler runs one unit.
struct PlanCommand {
  std::string job;   ///< job file
  std::string work;  ///< work folder shared by all machines
  std::string program = "waymark";
  std::vector<std::string> options = {};   ///< words of every call, such as --allow-network
  std::vector<std::string> settings = {};  ///< STAGE.OPTION=VALUE of every call
  std::string map = {};         ///< the last call writes it; empty: the plan ends with the last stage
  std::string sensor = {};      ///< name or file of the profile that the map records; empty: none
  bool confined = false;        ///< a job that names files outside its folder is refused
  std::size_t max_shards = 64;  ///< calls per stage over tiles or images
  /// By stage, "map" for the call that writes the map, "" for all others.
  std::map<std::string, CallResources> resources = {};
};

/// Returns one JSON object per line: unit, stage, item, fingerprint, done, after (ids).
std::string plan_as_jsonl(const Plan& plan);
/// Returns a Snakefile with one rule per stage, whose wildcard is the shard, and one for the map. The empty
/// files that mark finished shards stand in the work folder, named by what determines the results of the
/// stage.
std::string plan_as_snakemake(const Plan& plan, const PlanCommand& command);
/// Returns a shell script of sbatch calls: per stage one job or one array of shards, after the stages it
/// reads.
std::string plan_as_slurm(const Plan& plan, const PlanCommand& command);
/// Returns a shell script that runs the stages in order, the shards of each by GNU parallel.
std::string plan_as_parallel(const Plan& plan, const PlanCommand& command);

/// Returns size and hash of a file that a stage reads. importers/ has an implementation that opens /vsi
/// paths.
using FileHasher = std::function<InputFile(const std::string& path)>;

/// Returns size and SHA-256 of a plain file, read as a stream. Throws Error{input} if it cannot be read.
InputFile hash_plain_file(const std::string& path);

/// Part of the work done by one process: `index` of `count`, from 1.
/// Images are dealt out in turn; the tiles of a shard are neighbours, which read the same blocks of a raster.
/// A map-scope unit is run by every shard that finds its inputs complete, so the last one finishes the job.
struct Shard {
  int index = 1, count = 1;
};

/// How a pipeline is run.
struct RunOptions {
  /// Later runs do what is missing there.
  std::filesystem::path work = {};  ///< folder of finished work; empty: everything in memory
  int threads = 0;                  ///< 0: one per processor
  std::optional<Shard> shard = {};  ///< part of the job to run; needs `work`
  std::string unit = {};            ///< single unit of work to run; needs `work`
  std::string stage = {};           ///< single stage to run, or its part in `shard`; needs `work`
  std::string rerun_from = {};      ///< stage to re-run with its dependents; empty: finished work is kept
  /// Map-scope artifacts that the caller will read. The others are released after their last reader; empty:
  /// all are kept.
  std::vector<std::string> results = {};
  /// Folder for nameless files that receive results which need not stay in memory; empty: the system's
  /// temporary folder. With a work folder they are there.
  std::filesystem::path scratch = {};
  /// Bytes per stage of such tile results that stay in memory without a work folder.
  std::size_t max_bytes_in_memory = std::size_t{32} << 20;
  /// Landmark types of the stages, must outlive the run; null: the built-in types.
  const TypeRegistry* types = nullptr;
  bool check_only = false;  ///< stop after planning: options, wiring, files
  ProgressListener progress = {};
  FileHasher hash_file = hash_plain_file;
};

/// Report, inputs and artifacts of a run.
class RunResult {
 public:
  RunReport report;
  std::vector<InputFile> inputs;  ///< every file that the stages read, once, in their order

  /// Returns a map-scope artifact. Throws Error with the first failure if it was not made.
  /// Throws std::logic_error unless exactly one stage writes that name and type, with map scope.
  template <class T>
  const T& artifact(std::string_view name) const& {
    return *static_cast<const T*>(find_one(name, typeid(T)).get());
  }
  template <class T>
  const T& artifact(std::string_view name) const&& = delete;  // would dangle

  /// Reads one artifact at each call; it stays in memory only while it is used.
  template <class T>
  using Reader = std::function<std::shared_ptr<const T>()>;

  /// Returns whether every unit of the stage wrote the artifact.
  bool is_complete(std::string_view stage, std::string_view name) const;

  /// Returns the artifacts of all stages under that name and type, by stage, then by tile or image.
  /// Missing artifacts and those released after their last reader are left out.
  template <class T>
  std::vector<std::shared_ptr<const T>> artifacts(std::string_view name) const {
    std::vector<std::shared_ptr<const T>> all;
    for (auto& value : find_all(name, typeid(T))) all.push_back(std::static_pointer_cast<const T>(value));
    return all;
  }
  /// Moves tile-scope artifacts out of the result as readers, since all together may not fit in memory.
  template <class T>
  std::vector<Reader<T>> take_readers(std::string_view name) {
    std::vector<Reader<T>> readers;
    for (ArtifactPtr& item : take_items(name, typeid(T), Scope::tile))
      readers.push_back([item] { return std::static_pointer_cast<const T>(item->value()); });
    return readers;
  }
  /// Moves the parts of map-scope artifacts out of the result, as readers of all of them.
  template <class T>
  std::vector<Reader<T>> take_parts(std::string_view name) {
    std::vector<Reader<T>> readers;
    for (ArtifactPtr& item : take_items(name, typeid(Parts<T>), Scope::map)) {
      const auto parts = std::static_pointer_cast<const Parts<T>>(item->value());
      for (std::size_t i = 0; i < parts->count(); ++i)
        readers.push_back([parts, i] { return std::make_shared<const T>(parts->read(i)); });
    }
    return readers;
  }
  /// Moves the artifacts out of the result; copies only those with other owners.
  template <class T>
  std::vector<T> take(std::string_view name) {
    std::vector<Artifact::Value> values = find_all(name, typeid(T));
    std::erase_if(artifacts_, [&](const StoredOutput& kept) { return kept.name == name; });
    std::vector<T> all;
    for (auto& value : values) all.push_back(move_or_copy<T>(std::move(value)));
    return all;
  }

 private:
  friend class Run;
  struct StoredOutput {
    std::string stage, name;
    std::type_index type;
    Scope scope;
    std::vector<ArtifactPtr> items;  ///< null if not made
  };
  Artifact::Value find_one(std::string_view name, std::type_index type) const;
  std::vector<Artifact::Value> find_all(std::string_view name, std::type_index type) const;
  std::vector<ArtifactPtr> take_items(std::string_view name, std::type_index type, Scope scope);

  std::vector<StoredOutput> artifacts_;
};

/// Runs the units whose results are not in the work folder, those of a stage in parallel. Results and report
/// do not depend on the number of threads.
/// A unit that throws becomes a failure; its dependents are skipped and the others run.
/// Throws Error if the job is invalid or a listing stage fails, std::logic_error if a stage violates its
/// declaration.
RunResult run(const Pipeline& pipeline, const RunOptions& options = {});

/// Returns the units of a run. Runs the listing stages.
Plan plan(const Pipeline& pipeline, const RunOptions& options = {});

}  // namespace waymark::pipeline
