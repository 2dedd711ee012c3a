// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/artifact.hpp"
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/stage_spec.hpp"
#include "pipeline/engine/store/scratch_file.hpp"
#include "pipeline/engine/tile.hpp"
namespace waymark::inline landmarks {
class TypeRegistry;
}

namespace waymark::pipeline {

/// Counts of items read, written and rejected. Sums over units and resumed runs.
struct Counts {
  std::int64_t in = 0, out = 0;
  std::map<std::string, std::int64_t> rejected;  ///< by reason

  std::int64_t rejected_total() const;
  Counts& operator+=(const Counts& other);
  friend bool operator==(const Counts&, const Counts&) = default;
};

/// Artifacts that a unit reads from one port.
struct PortInput {
  std::vector<ArtifactPtr> items;  ///< one, or several: by stage, then by item
  bool many = false;               ///< read with read_all
};

/// Inputs of a unit.
struct UnitInputs {
  std::string id = {};                  ///< "find_mountain_tops/tile_000003"
  std::optional<Tile> tile = {};        ///< of a tile-scope unit
  std::optional<ImageItem> image = {};  ///< of an image-scope unit
  std::map<std::string, PortInput, std::less<>> ports = {};
  std::filesystem::path base_folder = {};  ///< relative paths of options start here
  int threads = 1;
  const TypeRegistry* types = nullptr;  ///< landmark types of the run
  std::function<void(double)> progress = {};
  std::filesystem::path scratch = {};  ///< folder for temporary files; empty: the system's
};

/// Results of a unit.
struct UnitOutcome {
  std::map<std::string, Artifact::Value, std::less<>> outputs;  ///< by port
  Counts counts;
  std::vector<std::string> warnings;
  bool keep = true;  ///< false: another run may give a better result
};

/// Interface of a running stage to its declared ports, its item and its report.
/// Access to an undeclared port throws std::logic_error. Counting, warning and progress are thread-safe.
class StageContext {
 public:
  /// Both must outlive the context.
  StageContext(const StageSpec& spec, const UnitInputs& inputs) : spec_(spec), inputs_(inputs) {}

  /// Returns whether the port has an artifact: always while running, if planning made it in check_inputs.
  template <class T>
  bool has(In<T> port) const {
    return !declared_input(port.name, typeid(T)).items.empty();
  }
  /// Returns the artifact of the same item or of the map. Valid until the unit ends.
  template <class T>
  const T& read(In<T> port) {
    return *static_cast<const T*>(read_one(port.name, typeid(T)).get());
  }
  /// Returns the artifacts of all tiles (images) in their order.
  template <class T>
  std::vector<std::shared_ptr<const T>> read_all(In<T> port) {
    return read_values<T>(port.name);
  }
  /// Returns the artifacts of all stages that write the port, by stage, then by item.
  template <class T>
  std::vector<std::shared_ptr<const T>> read_all(Gather<T> port) {
    return read_values<T>(port.name);
  }
  /// Calls visit(shared_ptr<const T>) for the artifacts of all tiles (images) in their order, one in memory
  /// at a time.
  template <class T, class Visit>
  void visit(Stream<T> port, Visit&& take) {
    for (const auto& read : readers<T>(port.name)) take(read());
  }
  /// Returns one reader per artifact, in the order of visit(), to be called any number of times. Thread-safe.
  template <class T>
  std::vector<std::function<std::shared_ptr<const T>()>> readers(Stream<T> port) {
    return readers<T>(port.name);
  }
  template <class T>
  std::vector<std::function<std::shared_ptr<const T>()>> readers(GatherStream<T> port) {
    return readers<T>(port.name);
  }
  /// Calls take(T) for the artifacts in the order of the readers, each of them released before the next.
  /// Artifacts in memory cannot be read afterwards.
  template <class T, class Take>
  void consume(GatherStream<T> port, Take&& take) {
    for (const ArtifactPtr& item : declared_input(port.name, typeid(T)).items)
      take(move_or_copy<T>(item.use_count() > 1 ? item->value() : item->take()));
  }
  /// Returns the artifact by value for a stage that modifies it; copied only if another unit still needs it.
  /// A port is taken once and cannot be read afterwards.
  template <class T>
  T take(In<T> port) {
    return move_or_copy<T>(take_one(port.name, typeid(T)));
  }
  template <class T>
  std::vector<T> take_all(In<T> port) {
    return take_values<T>(port.name);
  }
  template <class T>
  std::vector<T> take_all(Gather<T> port) {
    return take_values<T>(port.name);
  }
  /// Writes an output. Called exactly once for every declared output.
  template <class T>
  void write(Out<T> port, T value) {
    write_one(port.name, typeid(T), std::make_shared<T>(std::move(value)));
  }

  /// Returns the tile (image) of the unit. Throws std::logic_error in a stage of another scope.
  const Tile& tile() const;
  const ImageItem& image() const;
  /// Returns the tile's cells grown by the declared halo; may reach outside the grid.
  Window cells_with_halo() const;
  /// Returns "stage/item", the seed for random generators.
  const std::string& id() const { return inputs_.id; }
  /// Returns the landmark types of the run. Throws std::logic_error if the unit has none.
  const TypeRegistry& types() const;
  /// Returns the number of threads a stage may use. oneTBB algorithms respect it by themselves.
  int threads() const { return inputs_.threads; }
  /// Returns the path of an option that names a file, relative to the folder of the job file.
  std::string path(const std::string& option) const;

  /// Returns the folder for temporary files; empty: the system's.
  const std::filesystem::path& scratch() const { return inputs_.scratch; }
  /// Returns a file for temporary results, of which `in_memory` bytes need no disk.
  std::shared_ptr<ScratchFile> make_scratch_file(std::size_t in_memory = std::size_t{4} << 20) const;

  /// Counts items. A stage that counts its input must count every item out or reject it: the engine checks in
  /// = out + rejected. A stage that only counts out is a source.
  void count_in(std::int64_t n);
  void count_out(std::int64_t n);
  void reject(std::string_view reason, std::int64_t n = 1);
  void warn(std::string text);
  /// Keeps the result out of the store, since what is missing in it may be there when the next run tries
  /// again.
  void do_not_keep() { outcome_.keep = false; }
  /// Reports the completed fraction of this unit, [0, 1]. Cheap enough for one call per row.
  void progress(double done_fraction) const;

  /// Returns the results; called by the engine.
  /// Throws std::logic_error naming the stage if a declared output is missing or in != out + rejected.
  UnitOutcome finish();

 private:
  template <class T>
  std::vector<std::shared_ptr<const T>> read_values(std::string_view port) {
    std::vector<std::shared_ptr<const T>> all;
    for (auto& value : read_each(port, typeid(T))) all.push_back(std::static_pointer_cast<const T>(value));
    return all;
  }
  template <class T>
  std::vector<std::function<std::shared_ptr<const T>()>> readers(std::string_view port) {
    std::vector<std::function<std::shared_ptr<const T>()>> all;
    for (const ArtifactPtr& item : declared_input(port, typeid(T)).items)
      all.push_back([item] { return std::static_pointer_cast<const T>(item->value()); });
    return all;
  }
  template <class T>
  std::vector<T> take_values(std::string_view port) {
    std::vector<T> all;
    for (auto& value : take_each(port, typeid(T))) all.push_back(move_or_copy<T>(std::move(value)));
    return all;
  }
  Artifact::Value read_one(std::string_view port, std::type_index type);
  std::vector<Artifact::Value> read_each(std::string_view port, std::type_index type);
  Artifact::Value take_one(std::string_view port, std::type_index type);
  std::vector<Artifact::Value> take_each(std::string_view port, std::type_index type);
  void write_one(std::string_view port, std::type_index type, Artifact::Value value);
  const PortInput& declared_input(std::string_view port, std::type_index type) const;
  const ArtifactPtr& only_item(std::string_view port, std::type_index type) const;

  const StageSpec& spec_;
  const UnitInputs& inputs_;
  std::mutex mutex_;
  UnitOutcome outcome_;
  std::map<const Artifact*, Artifact::Value> read_;  ///< values read, kept until the unit ends
  bool counts_input_ = false;
};

/// Returns `text` if it is absolute or a GDAL name such as "NETCDF:x.nc:z", else the path below `folder`.
std::string resolve_path(const std::filesystem::path& folder, const std::string& text);

}  // namespace waymark::pipeline
