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
#include "pipeline/engine/tile.hpp"
namespace waymark {

/// How many things went in, came out and were dropped. Adds up over units and resumed runs.
struct Counts {
  std::int64_t in = 0, out = 0;
  std::map<std::string, std::int64_t> rejected;  ///< by reason

  std::int64_t rejected_total() const;
  Counts& operator+=(const Counts& other);
  friend bool operator==(const Counts&, const Counts&) = default;
};

/// What a unit reads from one port.
struct PortInput {
  std::vector<ArtifactPtr> items;  ///< one, or many: stage by stage, item by item
  bool many = false;               ///< to be read with read_all
};

/// What a unit of work is given.
struct UnitInputs {
  std::string id = {};                  ///< "find_mountain_tops/tile_000003"
  std::optional<Tile> tile = {};        ///< of a tile-scope unit
  std::optional<ImageItem> image = {};  ///< of an image-scope unit
  std::map<std::string, PortInput, std::less<>> ports = {};
  std::filesystem::path base_folder = {};  ///< relative paths of options start here
  int threads = 1;
  std::function<void(double)> progress = {};
};

/// What a unit of work leaves behind.
struct UnitOutcome {
  std::map<std::string, Artifact::Value, std::less<>> outputs;  ///< by port
  Counts counts;
  std::vector<std::string> warnings;
};

/// All a running stage may touch: its declared ports, its item, and its report. Touching a port it has not
/// declared throws std::logic_error. Counting, warning and progress may be called from many threads.
class StageContext {
 public:
  /// Both must outlive the context.
  StageContext(const StageSpec& spec, const UnitInputs& inputs) : spec_(spec), inputs_(inputs) {}

  /// The artifact of the same item, or of the map. Valid until the unit ends.
  template <class T>
  const T& read(In<T> port) {
    return *static_cast<const T*>(read_one(port.name, typeid(T)).get());
  }
  /// The artifacts of all tiles (images) in their order.
  template <class T>
  std::vector<std::shared_ptr<const T>> read_all(In<T> port) {
    return all_of<T>(port.name);
  }
  /// The artifacts of all stages that write it, stage by stage, each in the order of its items.
  template <class T>
  std::vector<std::shared_ptr<const T>> read_all(Gather<T> port) {
    return all_of<T>(port.name);
  }
  /// The same for a stage that changes what it reads: without a copy where nobody reads it later. A port is
  /// taken once, and not read after.
  template <class T>
  T take(In<T> port) {
    return own<T>(take_one(port.name, typeid(T)));
  }
  template <class T>
  std::vector<T> take_all(In<T> port) {
    return taken_of<T>(port.name);
  }
  template <class T>
  std::vector<T> take_all(Gather<T> port) {
    return taken_of<T>(port.name);
  }
  /// Once per port; every declared output must be written.
  template <class T>
  void write(Out<T> port, T value) {
    write_one(port.name, typeid(T), std::make_shared<T>(std::move(value)));
  }

  /// Throws std::logic_error in a stage of another scope.
  const Tile& tile() const;
  const ImageItem& image() const;
  /// The tile's cells grown by the declared halo; may reach outside the grid.
  Window cells_with_halo() const;
  /// "stage/item": what a random generator is seeded from.
  const std::string& id() const { return inputs_.id; }
  /// Threads a stage may use; oneTBB algorithms inside a stage keep to them by themselves.
  int threads() const { return inputs_.threads; }
  /// An option that names a file: relative to the folder of the job file.
  std::string path(const std::string& option) const;

  /// A stage that counts what goes in must count every thing out again or reject it; the engine checks that
  /// in = out + rejected. One that only counts out is a source.
  void count_in(std::int64_t n);
  void count_out(std::int64_t n);
  void reject(std::string_view reason, std::int64_t n = 1);
  void warn(std::string text);
  /// Share of this unit that is done, [0, 1]. Cheap enough for once per row.
  void progress(double done_fraction) const;

  /// For the engine: what the unit left behind. Throws std::logic_error naming the stage where a declared
  /// output was not written or in != out + rejected.
  UnitOutcome finish();

 private:
  template <class T>
  std::vector<std::shared_ptr<const T>> all_of(std::string_view port) {
    std::vector<std::shared_ptr<const T>> all;
    for (auto& value : read_each(port, typeid(T))) all.push_back(std::static_pointer_cast<const T>(value));
    return all;
  }
  template <class T>
  std::vector<T> taken_of(std::string_view port) {
    std::vector<T> all;
    for (auto& value : take_each(port, typeid(T))) all.push_back(own<T>(std::move(value)));
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
  std::map<const Artifact*, Artifact::Value> read_;  ///< what was read lives until the unit ends
  bool counts_what_goes_in_ = false;
};

/// `text` where it is absolute or a GDAL name such as "NETCDF:x.nc:z"; else below `folder`.
std::string resolve_path(const std::filesystem::path& folder, const std::string& text);

}  // namespace waymark
