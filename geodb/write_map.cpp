// SPDX-License-Identifier: Apache-2.0
#include "geodb/write_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/error.hpp"
#include "geodb/aside_file.hpp"
#include "geodb/crs_table.hpp"
#include "geodb/dem_coverage.hpp"
#include "geodb/evidence.hpp"
#include "geodb/geometry_blob.hpp"
#include "geodb/landmark_layout.hpp"
#include "geodb/layer_registration.hpp"
#include "geodb/layer_style.hpp"
#include "geodb/migrations.hpp"
#include "geodb/packed_rtree.hpp"
#include "geodb/provenance.hpp"
#include "geodb/row_order.hpp"
#include "geodb/sql_text.hpp"
#include "geodb/type_catalogue.hpp"
#include "landmarks/uid_index.hpp"

namespace waymark {
namespace {

// Large pages save a quarter of the time of a large map; small ones keep a small map small.
const char* page_size(const MapContents& contents) {
  constexpr std::size_t kLarge = 50'000;  // landmarks
  return contents.landmarks.size() < kLarge ? "PRAGMA page_size = 4096" : "PRAGMA page_size = 16384";
}

[[noreturn]] void refuse(std::string problem, std::string where) {
  throw Error(ErrorCode::input, std::move(problem), std::move(where),
              "this comes from the stage that made the landmarks");
}

/// Landmarks by type: positions in MapContents::landmarks.
std::vector<std::vector<std::uint32_t>> landmarks_by_type(const MapContents& contents) {
  std::vector<std::vector<std::uint32_t>> of_type(contents.types.size());
  for (std::uint32_t i = 0; i < contents.landmarks.size(); ++i) {
    const Landmark& landmark = contents.landmarks[i];
    if (landmark.uid.empty()) refuse("a landmark has no uid", fmt::format("landmark {}", i));
    if (!landmark.position.xyz.allFinite())
      refuse("a landmark's position is not finite", "landmark " + landmark.uid);
    of_type.at(landmark.type).push_back(i);
  }
  return of_type;
}

class MapWriter {
 public:
  MapWriter(const sqlite::Database& database, const MapContents& contents, const WriteMapOptions& options)
      : database_(&database),
        contents_(&contents),
        changed_(time_stamp(contents.run.started_utc)),
        of_type_(landmarks_by_type(contents)) {
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
    const bool all = wanted.empty() && contents_->landmarks.empty();
    std::vector<char> evident(contents_->types.size());
    for (const auto& o : contents_->observations) evident.at(o.type) = 1;
    for (TypeId id = 0; id < contents_->types.size(); ++id) {
      const LandmarkType& type = contents_->types[id];
      if (all || evident[id] || !of_type_[id].empty() || std::ranges::count(wanted, type.name) > 0) {
        kept_.push_back(id);
        new_id_[id] = types_.add(type);
      }
    }
  }

  void write_landmarks(TypeId old_id) {
    const LandmarkType& type = types_[new_id_.at(old_id)];
    const LandmarkLayout layout(type, new_id_.at(old_id));
    const Envelope extent = extent_of(contents_->landmarks, of_type_[old_id]);
    sort_along_hilbert_curve(of_type_[old_id], contents_->landmarks, extent);

    database_->execute(layout.create_table());
    const std::vector<IndexedPoint> points = insert_rows(layout, old_id);
    create_uid_index(type.name);
    create_spatial_index(*database_, type.name);
    fill_rtree(*database_, type.name, points);

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

  std::vector<IndexedPoint> insert_rows(const LandmarkLayout& layout, TypeId old_id) {
    std::vector<IndexedPoint> points;
    points.reserve(of_type_[old_id].size());
    sqlite::Statement insert = database_->prepare(layout.insert());
    std::int64_t row = layout.type_id() * kRowsPerType;
    const std::vector<std::uint32_t>& order = of_type_[old_id];
    for (std::size_t i = 0; i < order.size(); ++i) {
      fetch_ahead(contents_->landmarks, order, i);
      const Landmark& landmark = contents_->landmarks[order[i]];
      const PointBlob geometry = point_blob(landmark.position.xyz, srs_id_);
      layout.bind(insert, ++row, landmark, geometry);
      insert.run();
      points.push_back({row, landmark.position.xyz.x(), landmark.position.xyz.y()});
    }
    return points;
  }

  void create_uid_index(const std::string& table) {
    try {
      // The sorter works in runs as large as the cache: small ones are sorted beside the scan by a second
      // thread.
      database_->execute("PRAGMA threads = 2; PRAGMA cache_size = -8192");
      database_->execute(fill_in("CREATE UNIQUE INDEX \"{t}_uid\" ON \"{t}\" (uid)", {{"t", table}}));
      database_->execute("PRAGMA cache_size = -65536");
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
    database_->execute("CREATE INDEX observation_uid ON observation (uid)");
  }

  /// Of the landmark an observation is evidence of; `rows` finds those of its type, and is made here.
  std::optional<std::int64_t> row_of(const Observation& observation, std::optional<UidIndex>& rows) const {
    const std::vector<std::uint32_t>& order = of_type_[observation.type];
    if (!rows) rows.emplace(contents_->landmarks, order);
    const auto place = rows->find(observation.landmark_uid);
    if (!place) return {};
    return new_id_.at(observation.type) * kRowsPerType + 1 + *place;
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
  std::string changed_;
  std::vector<std::vector<std::uint32_t>> of_type_;
  TypeRegistry types_;                         ///< of the map: those of the contents that get a table
  std::vector<TypeId> kept_;                   ///< their ids in the contents
  std::unordered_map<TypeId, TypeId> new_id_;  ///< id in the contents -> id in the map
  Envelope whole_extent_;
  std::int32_t srs_id_ = 0;
};

}  // namespace

void write_map(const std::filesystem::path& path, const MapContents& contents,
               const WriteMapOptions& options) {
  if (!options.replace && std::filesystem::exists(path))
    throw Error(ErrorCode::output, "the file exists already", path.string(),
                "choose another name, or allow replacing it");
  AsideFile file(path);
  try {
    sqlite::Database database(file.path(), sqlite::OpenMode::create);
    database.execute(page_size(contents));
    sqlite::Transaction all(database);
    MapWriter(database, contents, options).write();
    all.commit();
    database.close();
  } catch (const Error& e) {  // name the map, not the file aside
    throw Error(e.code(), e.problem(), e.where().ends_with(".part") ? path.string() : e.where(), e.hint());
  }
  file.keep();
}

}  // namespace waymark
