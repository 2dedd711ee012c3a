// SPDX-License-Identifier: Apache-2.0
#include "geodb/write_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "geodb/geopackage/crs_table.hpp"
#include "geodb/geopackage/dem_coverage.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/geopackage/layer_registration.hpp"
#include "geodb/geopackage/migrations.hpp"
#include "geodb/geopackage/provenance.hpp"
#include "geodb/geopackage/type_catalogue.hpp"
#include "geodb/layers/evidence.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/layers/largest_index.hpp"
#include "geodb/layers/layer_style.hpp"
#include "geodb/replace_map.hpp"
#include "geodb/rtree/landmark_order.hpp"
#include "geodb/rtree/packed_rtree.hpp"
#include "geodb/rtree/rejected_order.hpp"
#include "geodb/sqlite/row_inserter.hpp"
#include "geodb/sqlite/sql_text.hpp"
#include "landmarks/uid_index.hpp"

namespace waymark::geodb {
namespace {

[[noreturn]] void refuse(std::string problem, std::string where) {
  throw Error(ErrorCode::input, std::move(problem), std::move(where),
              "check the stage that made the landmarks");
}

/// Statistics of the landmarks of one type.
struct TypeStatistics {
  std::int64_t count = 0;
  Envelope extent;
  std::vector<std::uint32_t> in_memory = {};  ///< positions in MapContents::landmarks
  LargestValues largest{0};
};

void add_statistics(std::vector<TypeStatistics>& of_type, const std::vector<LandmarkLayout>& layouts,
                    const std::vector<Landmark>& landmarks, bool in_memory) {
  for (std::uint32_t i = 0; i < landmarks.size(); ++i) {
    const Landmark& landmark = landmarks[i];
    if (landmark.uid.empty()) refuse("a landmark has no uid", fmt::format("landmark {}", i));
    if (!landmark.position.xyz.allFinite())
      refuse("a landmark's position is not finite", "landmark " + landmark.uid);
    TypeStatistics& statistics = of_type.at(landmark.type);
    ++statistics.count;
    statistics.extent.add(landmark.position.xyz.x(), landmark.position.xyz.y());
    add_landmark(statistics.largest, layouts[landmark.type], landmark);
    if (in_memory) statistics.in_memory.push_back(i);
  }
}

std::vector<TypeStatistics> type_statistics(const MapContents& contents) {
  std::vector<TypeStatistics> of_type(contents.types.size());
  std::vector<LandmarkLayout> layouts;
  for (TypeId id = 0; id < of_type.size(); ++id) {
    layouts.emplace_back(contents.types[id], id);
    of_type[id].largest = LargestValues(layouts[id].columns().size());
  }
  add_statistics(of_type, layouts, contents.landmarks, true);
  for (std::size_t part = 0; part < contents.parts.count; ++part)
    add_statistics(of_type, layouts, *contents.parts.landmarks(part), false);
  return of_type;
}

constexpr std::int64_t kLarge = 50'000;  // landmarks of a large map

// In kB. A larger cache does not write a map faster.
constexpr const char* kCache = "PRAGMA cache_size = -2048";

// Large pages save a quarter of the time for large maps; small pages save space for small maps. SQLite
// converts the cache size to pages when it is set, so it is set again after the page size.
void set_page_size(const sqlite::Database& database, const std::vector<TypeStatistics>& statistics) {
  std::int64_t count = 0;
  for (const TypeStatistics& type : statistics) count += type.count;
  database.execute(count < kLarge ? "PRAGMA page_size = 4096" : "PRAGMA page_size = 16384");
  database.execute(kCache);
}

class MapWriter {
 public:
  MapWriter(const sqlite::Database& database, const MapContents& contents,
            const std::vector<TypeStatistics>& statistics, const WriteMapOptions& options)
      : database_(&database),
        contents_(&contents),
        statistics_(&statistics),
        max_in_memory_(options.max_landmarks_in_memory),
        changed_(time_stamp(contents.run.started_utc)),
        rejected_(contents.parts, options.max_landmarks_in_memory),
        row_index_(contents.landmarks.size()) {
    choose_types(options.empty_tables);
  }

  void write() {
    create_schema(*database_, changed_);
    srs_id_ = write_crs(*database_, contents_->crs);
    write_types(*database_, types_);
    for (const TypeId type : kept_) write_landmarks(type);
    if (!kept_.empty()) write_view();
    write_evidence();
    write_images();
    write_layers(*database_, contents_->layers, changed_);
    for (const RunRecord& run : contents_->earlier_runs) write_run(*database_, run);
    write_run(*database_, contents_->run);
    write_metadata(*database_, contents_->run, changed_);
    if (contents_->dem_coverage) write_dem_coverage(*database_, *contents_->dem_coverage, srs_id_, changed_);
  }

 private:
  void choose_types(const std::vector<std::string>& wanted) {
    const bool all = wanted.empty() && std::ranges::all_of(*statistics_, [](const TypeStatistics& type) {
                       return type.count == 0;
                     });
    std::vector<char> has_observations(contents_->types.size());
    for (const auto& o : contents_->observations) has_observations.at(o.type) = 1;
    for (const TypeId type : rejected_.types()) has_observations.at(type) = 1;
    for (TypeId id = 0; id < contents_->types.size(); ++id) {
      const LandmarkType& type = contents_->types[id];
      if (all || has_observations[id] || (*statistics_)[id].count > 0 ||
          std::ranges::count(wanted, type.name) > 0) {
        kept_.push_back(id);
        new_id_[id] = types_.add(type);
      }
    }
  }

  void write_landmarks(TypeId old_id) {
    const LandmarkType& type = types_[new_id_.at(old_id)];
    const LandmarkLayout layout(type, new_id_.at(old_id));
    const Envelope& extent = (*statistics_)[old_id].extent;
    orders_.emplace(old_id, LandmarkOrder(*contents_, old_id, extent, max_in_memory_));
    database_->execute(layout.create_table());
    if ((*statistics_)[old_id].count >= kLarge)
      create_largest_indexes(*database_, layout, (*statistics_)[old_id].largest);
    insert_rows(layout, old_id);
    create_uid_index(type.name);
    create_edit_triggers(*database_, type.name);
    create_spatial_index(*database_, type.name);
    fill_rtree(*database_, type.name);

    register_layer(*database_, {.table = type.name,
                                .description = type.summary,
                                .geometry_type = "POINT",
                                .z = true,
                                .extent = extent,
                                .srs_id = srs_id_,
                                .changed = changed_});
    describe_columns(*database_, layout);
    create_evidence_links(*database_, type.name);
    store_style(*database_, type.name, qml_style(type, contents_->crs), sld_style(type), type.summary,
                changed_);
    whole_extent_.add(extent);
  }

  void insert_rows(const LandmarkLayout& layout, TypeId old_id) {
    std::vector<std::string> columns;
    for (const LandmarkColumn& column : layout.columns()) columns.push_back(quote_identifier(column.name));
    sqlite::RowInserter rows(*database_, layout.type().name, columns);
    std::vector<PointBlob> geometries(rows.max_rows());
    const std::span<const Landmark> in_memory = contents_->landmarks;
    orders_.at(old_id).visit(
        [&](const Landmark& landmark, std::int64_t row_index) {
          PointBlob& geometry = geometries[rows.row()] = point_blob(landmark.position.xyz, srs_id_);
          layout.bind(rows.statement(), row_at(old_id, row_index), landmark, geometry, rows.before_first());
          rows.end_row();
          const std::less<const Landmark*> before;
          if (!before(&landmark, in_memory.data()) && before(&landmark, in_memory.data() + in_memory.size()))
            row_index_[static_cast<std::size_t>(&landmark - in_memory.data())] =
                static_cast<std::uint32_t>(row_index);
        },
        [&] { rows.flush(); });
  }

  std::int64_t row_at(TypeId old_id, std::int64_t row_index) const {
    return new_id_.at(old_id) * kRowsPerType + 1 + row_index;
  }

  // In one thread: SQLite's sorter has a further buffer of 250 pages for each other thread.
  void create_uid_index(const std::string& table) {
    try {
      database_->execute(substitute_keys("CREATE UNIQUE INDEX \"{t}_uid\" ON \"{t}\" (uid)", {{"t", table}}));
    } catch (const Error&) {
      sqlite::Statement twice = database_->prepare("SELECT uid FROM " + quote_identifier(table) +
                                                   " GROUP BY uid HAVING count(*) > 1");
      if (twice.step()) refuse("two landmarks have the same uid", table + " " + std::string(twice.text(0)));
      throw;
    }
  }

  void write_view() {
    create_landmark_view(*database_, types_);
    register_layer(*database_, {.table = "landmark",
                                .description = "All landmarks, whatever their type",
                                .geometry_type = "POINT",
                                .z = true,
                                .extent = whole_extent_,
                                .srs_id = srs_id_,
                                .changed = changed_});
  }

  void write_evidence() {
    EvidenceWriter writer(*database_, types_);
    std::vector<std::optional<UidIndex>> rows(contents_->types.size());
    for (Observation observation : contents_->observations) {
      const bool kept = observation.rejected.empty();
      std::optional<std::int64_t> row;
      if (kept) row = row_of(observation, rows[observation.type]);
      if (kept && !row)
        refuse(
            "an observation refers to a missing landmark",
            fmt::format("observation from {}, landmark '{}'", observation.source, observation.landmark_uid));
      observation.type = new_id_.at(observation.type);
      writer.add(observation, row);
    }
    for (const TypeId type : kept_)
      orders_.at(type).visit_evidence([&](Observation observation, std::int64_t row_index) {
        observation.type = new_id_.at(type);
        writer.add(observation, row_at(type, row_index));
      });
    rejected_.visit([&](Observation observation) {
      observation.type = new_id_.at(observation.type);
      writer.add(observation, std::nullopt);
    });
    database_->execute("CREATE INDEX observation_uid ON observation (uid)");
  }

  /// Returns the row of an observation's landmark; creates `rows`, the index of its type, on first use.
  std::optional<std::int64_t> row_of(const Observation& observation, std::optional<UidIndex>& rows) const {
    const std::vector<std::uint32_t>& in_memory = (*statistics_)[observation.type].in_memory;
    if (in_memory.empty()) return {};
    if (!rows) rows.emplace(contents_->landmarks, in_memory);
    const auto found = rows->find(observation.landmark_uid);
    if (!found) return {};
    return row_at(observation.type, row_index_[in_memory[*found]]);
  }

  /// Registers the layer only if there are images, or nothing else that carries the map's CRS.
  void write_images() {
    if (contents_->images.empty() && !kept_.empty()) return;
    create_spatial_index(*database_, "image");
    Envelope extent;
    for (const ImageRecord& image : contents_->images) {
      for (const auto& ring : image.footprint) {
        if (ring.size() < 3) refuse("a footprint has fewer than three corners", "image " + image.name);
        for (const auto& corner : ring) extent.add(corner.x(), corner.y());
      }
      write_image(*database_, image, srs_id_);
    }
    register_images(*database_, extent, srs_id_, changed_);
  }

  const sqlite::Database* database_;
  const MapContents* contents_;
  const std::vector<TypeStatistics>* statistics_;  ///< by type of the contents
  std::size_t max_in_memory_;
  std::string changed_;
  RejectedOrder rejected_;
  std::vector<std::uint32_t> row_index_;    ///< index in the order of rows of each of MapContents::landmarks
  std::map<TypeId, LandmarkOrder> orders_;  ///< by type of the contents
  TypeRegistry types_;                      ///< of the map: those of the contents that get a table
  std::vector<TypeId> kept_;                ///< their ids in the contents
  std::unordered_map<TypeId, TypeId> new_id_;  ///< id in the contents -> id in the map
  Envelope whole_extent_;
  std::int32_t srs_id_ = 0;
};

}  // namespace

std::map<std::string, std::int64_t> write_map(const std::filesystem::path& path, const MapContents& contents,
                                              const WriteMapOptions& options) {
  if (!options.replace && std::filesystem::exists(path))
    throw Error(ErrorCode::output, "the file exists already", path.string(),
                "choose another name, or allow replacing it");
  AtomicFile file(path);
  std::map<std::string, std::int64_t> counts;
  try {
    const std::vector<TypeStatistics> statistics = type_statistics(contents);
    for (TypeId type = 0; type < statistics.size(); ++type)
      if (statistics[type].count > 0) counts[contents.types[type].name] = statistics[type].count;
    sqlite::Database database(file.path(), sqlite::OpenMode::create);
    set_page_size(database, statistics);
    sqlite::Transaction all(database);
    MapWriter(database, contents, statistics, options).write();
    all.commit();
    database.close();
  } catch (const Error& e) {  // name the map, not the temporary file
    throw with_final_path(e, file.path(), path);
  }
  replace_map(file);
  return counts;
}

}  // namespace waymark::geodb
