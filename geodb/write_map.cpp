// SPDX-License-Identifier: Apache-2.0
#include "geodb/write_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>

#include "core/error.hpp"
#include "geodb/aside_file.hpp"
#include "geodb/crs_table.hpp"
#include "geodb/dem_coverage.hpp"
#include "geodb/evidence.hpp"
#include "geodb/geometry_blob.hpp"
#include "geodb/landmark_layout.hpp"
#include "geodb/landmark_order.hpp"
#include "geodb/layer_registration.hpp"
#include "geodb/layer_style.hpp"
#include "geodb/migrations.hpp"
#include "geodb/packed_rtree.hpp"
#include "geodb/provenance.hpp"
#include "geodb/sql_text.hpp"
#include "geodb/type_catalogue.hpp"
#include "landmarks/uid_index.hpp"

namespace waymark {
namespace {

[[noreturn]] void refuse(std::string problem, std::string where) {
  throw Error(ErrorCode::input, std::move(problem), std::move(where),
              "this comes from the stage that made the landmarks");
}

/// What there is of a type.
struct Stock {
  std::int64_t count = 0;
  Envelope extent;
  std::vector<std::uint32_t> held = {};  ///< positions in MapContents::landmarks
};

void take_stock(std::vector<Stock>& of_type, const std::vector<Landmark>& landmarks, bool held) {
  for (std::uint32_t i = 0; i < landmarks.size(); ++i) {
    const Landmark& landmark = landmarks[i];
    if (landmark.uid.empty()) refuse("a landmark has no uid", fmt::format("landmark {}", i));
    if (!landmark.position.xyz.allFinite())
      refuse("a landmark's position is not finite", "landmark " + landmark.uid);
    Stock& stock = of_type.at(landmark.type);
    ++stock.count;
    stock.extent.add(landmark.position.xyz.x(), landmark.position.xyz.y());
    if (held) stock.held.push_back(i);
  }
}

std::vector<Stock> stock_of(const MapContents& contents) {
  std::vector<Stock> of_type(contents.types.size());
  take_stock(of_type, contents.landmarks, true);
  for (std::size_t part = 0; part < contents.parts.count; ++part)
    take_stock(of_type, *contents.parts.landmarks(part), false);
  return of_type;
}

constexpr const char* kCache = "PRAGMA cache_size = -65536";  // kB

// Large pages save a quarter of the time of a large map; small ones keep a small map small. SQLite counts the
// cache in pages of the size they had when it was told, so it is told anew.
void set_page_size(const sqlite::Database& database, const std::vector<Stock>& stock) {
  constexpr std::int64_t kLarge = 50'000;  // landmarks
  std::int64_t count = 0;
  for (const Stock& type : stock) count += type.count;
  database.execute(count < kLarge ? "PRAGMA page_size = 4096" : "PRAGMA page_size = 16384");
  database.execute(kCache);
}

class MapWriter {
 public:
  MapWriter(const sqlite::Database& database, const MapContents& contents, const std::vector<Stock>& stock,
            const WriteMapOptions& options)
      : database_(&database),
        contents_(&contents),
        stock_(&stock),
        at_once_(options.landmarks_at_once),
        changed_(time_stamp(contents.run.started_utc)),
        held_place_(contents.landmarks.size()) {
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
    write_run(*database_, contents_->run);
    write_metadata(*database_, contents_->run, changed_);
    if (contents_->dem_coverage) write_dem_coverage(*database_, *contents_->dem_coverage, srs_id_, changed_);
  }

 private:
  void choose_types(const std::vector<std::string>& wanted) {
    const bool all =
        wanted.empty() && std::ranges::all_of(*stock_, [](const Stock& type) { return type.count == 0; });
    std::vector<char> evident(contents_->types.size());
    for (const auto& o : contents_->observations) evident.at(o.type) = 1;
    for (TypeId id = 0; id < contents_->types.size(); ++id) {
      const LandmarkType& type = contents_->types[id];
      if (all || evident[id] || (*stock_)[id].count > 0 || std::ranges::count(wanted, type.name) > 0) {
        kept_.push_back(id);
        new_id_[id] = types_.add(type);
      }
    }
  }

  void write_landmarks(TypeId old_id) {
    const LandmarkType& type = types_[new_id_.at(old_id)];
    const LandmarkLayout layout(type, new_id_.at(old_id));
    const Envelope& extent = (*stock_)[old_id].extent;
    orders_.emplace(old_id, LandmarkOrder(*contents_, old_id, extent, at_once_));
    database_->execute(layout.create_table());
    insert_rows(layout, old_id);
    create_uid_index(type.name);
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
    store_style(*database_, type.name, qml_style(type), sld_style(type), type.summary, changed_);
    whole_extent_.add(extent);
  }

  void insert_rows(const LandmarkLayout& layout, TypeId old_id) {
    sqlite::Statement insert = database_->prepare(layout.insert());
    const std::span<const Landmark> held = contents_->landmarks;
    orders_.at(old_id).visit([&](const Landmark& landmark, std::int64_t place) {
      const PointBlob geometry = point_blob(landmark.position.xyz, srs_id_);
      layout.bind(insert, row_at(old_id, place), landmark, geometry);
      insert.run();
      const std::less<const Landmark*> before;
      if (!before(&landmark, held.data()) && before(&landmark, held.data() + held.size()))
        held_place_[static_cast<std::size_t>(&landmark - held.data())] = static_cast<std::uint32_t>(place);
    });
  }

  std::int64_t row_at(TypeId old_id, std::int64_t place) const {
    return new_id_.at(old_id) * kRowsPerType + 1 + place;
  }

  /// The sorter works in runs as large as the cache: small ones are sorted beside the scan by a second
  /// thread.
  void create_index(const std::string& definition) {
    database_->execute("PRAGMA threads = 2; PRAGMA cache_size = -8192");
    database_->execute("CREATE " + definition);
    database_->execute(kCache);
  }

  void create_uid_index(const std::string& table) {
    try {
      create_index(fill_in("UNIQUE INDEX \"{t}_uid\" ON \"{t}\" (uid)", {{"t", table}}));
    } catch (const Error&) {
      sqlite::Statement twice =
          database_->prepare("SELECT uid FROM " + sql_name(table) + " GROUP BY uid HAVING count(*) > 1");
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
            "an observation is evidence of a landmark that is not there",
            fmt::format("observation from {}, landmark '{}'", observation.source, observation.landmark_uid));
      observation.type = new_id_.at(observation.type);
      writer.add(observation, row);
    }
    for (const TypeId type : kept_)
      orders_.at(type).visit_evidence([&](Observation observation, std::int64_t place) {
        observation.type = new_id_.at(type);
        writer.add(observation, row_at(type, place));
      });
    create_index("INDEX observation_uid ON observation (uid)");
  }

  /// Of the landmark an observation is evidence of; `rows` finds those of its type, and is made here.
  std::optional<std::int64_t> row_of(const Observation& observation, std::optional<UidIndex>& rows) const {
    const std::vector<std::uint32_t>& held = (*stock_)[observation.type].held;
    if (held.empty()) return {};
    if (!rows) rows.emplace(contents_->landmarks, held);
    const auto found = rows->find(observation.landmark_uid);
    if (!found) return {};
    return row_at(observation.type, held_place_[held[*found]]);
  }

  void write_images() {
    create_spatial_index(*database_, "image");
    Envelope extent;
    for (const ImageRecord& image : contents_->images) {
      for (const auto& ring : image.footprint) {
        if (ring.size() < 3) refuse("a footprint has fewer than three corners", "image " + image.name);
        for (const auto& corner : ring) extent.add(corner.x(), corner.y());
      }
      write_image(*database_, image, srs_id_);
    }
    register_layer(*database_, {.table = "image",
                                .description = "Images, with the ground they show",
                                .geometry_type = "MULTIPOLYGON",
                                .extent = extent,
                                .srs_id = srs_id_,
                                .changed = changed_});
  }

  const sqlite::Database* database_;
  const MapContents* contents_;
  const std::vector<Stock>* stock_;  ///< by type of the contents
  std::size_t at_once_;
  std::string changed_;
  std::vector<std::uint32_t> held_place_;      ///< in the order of rows, of each of MapContents::landmarks
  std::map<TypeId, LandmarkOrder> orders_;     ///< by type of the contents
  TypeRegistry types_;                         ///< of the map: those of the contents that get a table
  std::vector<TypeId> kept_;                   ///< their ids in the contents
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
  AsideFile file(path);
  std::map<std::string, std::int64_t> counts;
  try {
    const std::vector<Stock> stock = stock_of(contents);
    for (TypeId type = 0; type < stock.size(); ++type)
      if (stock[type].count > 0) counts[contents.types[type].name] = stock[type].count;
    sqlite::Database database(file.path(), sqlite::OpenMode::create);
    set_page_size(database, stock);
    sqlite::Transaction all(database);
    MapWriter(database, contents, stock, options).write();
    all.commit();
    database.close();
  } catch (const Error& e) {  // name the map, not the file aside
    throw Error(e.code(), e.problem(), e.where().ends_with(".part") ? path.string() : e.where(), e.hint());
  }
  file.keep();
  return counts;
}

}  // namespace waymark
