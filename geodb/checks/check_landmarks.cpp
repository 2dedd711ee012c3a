// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "core/landmark.hpp"
#include "geodb/checks/map_checks.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/sqlite/sql_text.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark::geodb {
namespace {

constexpr double kRounding = 1e-9;  // of stored quotients and sums against recomputed ones

bool is_fraction(double value) {
  return value >= 0 && value <= 1;
}

/// Checks rows of one table one by one.
class RowCheck {
 public:
  RowCheck(const LandmarkLayout& layout, std::int32_t srs_id, FindingList& findings)
      : layout_(&layout), srs_id_(srs_id), findings_(&findings) {
    for (std::size_t i = 0; i < layout.columns().size(); ++i) {
      const std::string& name = layout.columns()[i].name;
      if (name == "seen") common_ = static_cast<int>(i);
    }
    first_attribute_ = common_ + 10;
  }

  void check(const sqlite::Statement& row) {
    row_ = LandmarkLayout::row_id(row);
    check_geometry(LandmarkLayout::geometry(row));
    if (LandmarkLayout::uid(row).empty()) find("uid.empty", "the landmark has no uid");
    const auto& features = layout_->type().features;
    for (std::size_t i = 0; i < features.size(); ++i)
      check_feature(row, features[i], 3 + 3 * static_cast<int>(i));
    check_quality(row);
    check_covariance(row);
    check_bounds(row);
  }

 private:
  void find(const char* code, std::string text) {
    findings_->add(code, layout_->type().name, row_, std::move(text));
  }

  void check_geometry(std::span<const std::byte> blob) {
    const auto point = point_of(blob);
    if (!point || !has_z(blob) || !point->allFinite())
      return find("geometry.bad", "the geometry is not a PointZ");
    if (srs_id_of(blob) != srs_id_)
      find("geometry.crs", fmt::format("the geometry has srs_id {}, the map {}", *srs_id_of(blob), srs_id_));
  }

  void check_feature(const sqlite::Statement& row, const FeatureSpec& spec, int column) {
    const auto value = row.optional_real(column), deviation = row.optional_real(column + 1),
               confidence = row.optional_real(column + 2);
    if (!value && (deviation || confidence))
      find("feature.spread", spec.name + " is unknown, but has a spread or a confidence");
    if (value && !(spec.min_value <= *value && *value <= spec.max_value))
      find("feature.range", fmt::format("{} = {} is outside [{}, {}] {}", spec.name, *value, spec.min_value,
                                        spec.max_value, spec.unit));
    if (deviation && !(*deviation >= 0))
      find("feature.spread", fmt::format("{}_sd = {} is negative", spec.name, *deviation));
    if (confidence && !is_fraction(*confidence))
      find("quality.range", fmt::format("{}_q = {} is outside [0, 1]", spec.name, *confidence));
  }

  void check_quality(const sqlite::Statement& row) {
    const Landmark landmark = layout_->read(row);
    const auto& [seen, visible, feature_confidences] = landmark.quality;
    if (seen < 0 || visible < seen)
      find("quality.counts", fmt::format("seen {} of {} times it was visible", seen, visible));
    check_stored(row.optional_real(common_ + 2), multiplicity_confidence(seen, visible), "q_multiplicity");
    check_stored(row.optional_real(common_ + 3), quality_of(layout_->type(), landmark), "quality");
    if (!is_fraction(landmark.confidence))
      find("quality.range", fmt::format("confidence = {} is outside [0, 1]", landmark.confidence));
    if (landmark.observations < 0)
      find("quality.counts", fmt::format("observations = {} is negative", landmark.observations));
  }

  void check_stored(std::optional<double> stored, std::optional<double> right, const char* name) {
    if (stored && !is_fraction(*stored))
      return find("quality.range", fmt::format("{} = {} is outside [0, 1]", name, *stored));
    if (stored.has_value() != right.has_value() || (stored && !(std::abs(*stored - *right) <= kRounding)))
      find("quality.stale",
           fmt::format("{} is {}, but {} by its inputs", name, stored.value_or(NAN), right.value_or(NAN)));
  }

  void check_covariance(const sqlite::Statement& row) {
    const double xx = row.real(common_ + 5), yy = row.real(common_ + 6), xy = row.real(common_ + 7),
                 zz = row.real(common_ + 8);
    const bool plane_unknown = std::isnan(xx) && std::isnan(yy) && std::isnan(xy);
    const bool plane_sound = xx >= 0 && yy >= 0 && xy * xy <= xx * yy * (1 + kRounding);
    if (!(plane_unknown || plane_sound) || !(std::isnan(zz) || zz >= 0))
      find("covariance.bad",
           fmt::format("var_x {}, var_y {}, cov_xy {}, var_z {} are not a valid covariance", xx, yy, xy, zz));
  }

  /// An attribute <feature>_low is a certified lower bound of the feature.
  void check_bounds(const sqlite::Statement& row) {
    const auto& type = layout_->type();
    for (std::size_t a = 0; a < type.attributes.size(); ++a)
      for (std::size_t f = 0; f < type.features.size(); ++f) {
        if (type.attributes[a].name != type.features[f].name + "_low") continue;
        const double low = row.real(first_attribute_ + static_cast<int>(a)), value = layout_->feature(row, f);
        if (low > value)
          find("bound.above",
               fmt::format("{} = {} is above the value {}", type.attributes[a].name, low, value));
      }
  }

  const LandmarkLayout* layout_;
  std::int32_t srs_id_;
  FindingList* findings_;
  int common_ = 0, first_attribute_ = 0;
  std::int64_t row_ = 0;
};

}  // namespace

void check_landmarks(const sqlite::Database& database, const LandmarkLayout& layout, std::int32_t srs_id,
                     FindingList& findings) {
  RowCheck check(layout, srs_id, findings);
  sqlite::Statement row = database.prepare(layout.select("ORDER BY t.id"));
  while (row.step()) check.check(row);

  const std::string& table = layout.type().name;
  find_rows(
      database, findings, "uid.twice", table,
      substitute_keys(
          R"(SELECT min(id), 'uid ' || uid || ' is used ' || count(*) || ' times' FROM "{t}" GROUP BY uid HAVING count(*) > 1)",
          {{"t", table}}));
  if (database.has_table("waymark_moved"))
    find_rows(
        database, findings, "position.moved", table,
        substitute_keys(
            R"(SELECT m.id, coalesce(t.uid, '?') || ' was moved by another program at ' || m.moved || '; its features, accuracies and quality are those of the old position'
       FROM waymark_moved m JOIN "{t}" t ON t.id = m.id WHERE m.type = '{t}')",
            {{"t", table}}));
  for (const auto& attribute : layout.type().attributes)
    if (attribute.name.ends_with("_uid"))
      find_rows(
          database, findings, "uid.dangling", table,
          substitute_keys(
              R"(SELECT id, '{a} ' || "{a}" || ' is not a landmark' FROM "{t}" WHERE "{a}" <> '' AND "{a}" NOT IN (SELECT uid FROM "{t}"))",
              {{"t", table}, {"a", attribute.name}}));
}

}  // namespace waymark::geodb
