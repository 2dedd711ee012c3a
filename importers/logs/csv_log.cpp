// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/log_records.hpp"
#include "importers/tables/table_columns.hpp"

namespace waymark::importers {
namespace {

using nlohmann::ordered_json;

enum class Need {
  optional,
  needed,
  one_of_several,  // a record needs at least one of these fields of its kind
};

// A target of --columns: a field of a record. A record is made of a row that has all of its needed fields.
struct CsvField {
  const char *target, *kind, *field;
  Need need = Need::optional;
  bool word = false;
};

// Fields of a position in the robot's frame, which becomes a range and a bearing.
constexpr const char *kSeenForward = "seen_x", *kSeenLeft = "seen_y", *kSeenSd = "seen_sd";

constexpr std::array kCsvFields{
    CsvField{"v", "odometry", "v", Need::needed},
    CsvField{"omega", "odometry", "omega", Need::needed},
    CsvField{"sideways", "odometry", "sideways"},
    CsvField{"wheel_v", "car", "v", Need::needed},
    CsvField{"steering", "car", "steering", Need::needed},
    CsvField{"dx", "step", "dx", Need::needed},
    CsvField{"dy", "step", "dy", Need::needed},
    CsvField{"dyaw", "step", "dyaw", Need::needed},
    CsvField{"gnss_x", "gnss", "x", Need::needed},
    CsvField{"gnss_y", "gnss", "y", Need::needed},
    CsvField{"gnss_sd", "gnss", "sd"},
    CsvField{"gnss_var_x", "gnss", "var_x"},
    CsvField{"gnss_var_y", "gnss", "var_y"},
    CsvField{"gnss_cov_xy", "gnss", "cov_xy"},
    CsvField{"compass", "compass", "yaw", Need::needed},
    CsvField{"compass_sd", "compass", "sd"},
    CsvField{"bearing", "sightings", "bearing", Need::one_of_several},
    CsvField{"bearing_sd", "sightings", "bearing_sd"},
    CsvField{"range", "sightings", "range", Need::one_of_several},
    CsvField{"range_sd", "sightings", "range_sd"},
    CsvField{"seen_x", "sightings", kSeenForward, Need::one_of_several},
    CsvField{"seen_y", "sightings", kSeenLeft},
    CsvField{"seen_sd", "sightings", kSeenSd},
    CsvField{"elevation", "sightings", "elevation"},
    CsvField{"elevation_sd", "sightings", "elevation_sd"},
    CsvField{"confidence", "sightings", "confidence"},
    CsvField{"landmark", "sightings", "landmark", Need::optional, true},
    CsvField{"type", "sightings", "type", Need::optional, true},
    CsvField{"truth_x", "truth", "x", Need::needed},
    CsvField{"truth_y", "truth", "y", Need::needed},
    CsvField{"truth_yaw", "truth", "yaw"},
};

std::vector<std::string> csv_targets() {
  std::vector<std::string> targets{"t", "frame"};
  for (const CsvField& field : kCsvFields) targets.push_back(field.target);
  return targets;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

// Words of a table need not be UTF-8.
std::string text_of(const ordered_json& record) {
  return record.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

class CsvLog {
 public:
  CsvLog(const std::filesystem::path& file, const std::string& columns)
      : file_(file.string()), table_(open_csv_table(file_)) {
    for (const ColumnAssignment& one : column_assignments(columns)) assign(one);
    for (const std::string& target : csv_targets())
      for (const std::string& column : table_->header().columns)
        if (target != "frame" && same_name(target, column) && !chosen_.contains(target))
          bind(target, '"' + column + '"');
    if (!bound_.contains("t"))
      refuse("no column of the log is recognised as t, the time in seconds", "--columns t=COLUMN");
    check_kinds();
  }

  std::vector<LogRecord> records() {
    for (TableRow row; table_->next(row);) {
      const double t = bound_.at("t").value(row, *table_);
      if (std::isnan(t)) {
        ++without_time_;
        continue;
      }
      if (!set_.empty() && set_["t"] != t) flush();
      for (const char* kind : {"truth", "odometry", "car", "step", "gnss", "compass", "sightings"})
        add(row, t, kind);
    }
    flush();
    return std::move(records_);
  }

  std::vector<std::string> remarks() const {
    std::vector<std::string> all;
    if (without_time_ > 0) all.push_back(fmt::format("{} lines without a time are skipped", without_time_));
    for (const auto& [kind, count] : incomplete_)
      all.push_back(
          fmt::format("{} lines have an incomplete record of the kind '{}', which is skipped", count, kind));
    return all;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& example) const {
    throw Error(ErrorCode::usage, problem, file_,
                fmt::format("say what the columns are, e.g. {}; the log has {}", example,
                            fmt::join(table_->header().columns, ", ")));
  }

  void assign(const ColumnAssignment& one) {
    const std::vector<std::string> targets = csv_targets();
    if (std::ranges::find(targets, one.target) == targets.end()) {
      const std::string nearest = nearest_name(one.target, targets);
      throw Error(ErrorCode::usage, fmt::format("a log has no '{}'", one.target), "--columns",
                  nearest.empty() ? fmt::format("it has {}", fmt::join(targets, ", "))
                                  : "did you mean '" + nearest + "'?");
    }
    if (!chosen_.emplace(one.target, true).second)
      throw Error(ErrorCode::usage, fmt::format("--columns gives '{}' twice", one.target), "--columns",
                  "remove one of them");
    if (one.target == "frame")
      records_.push_back({1, text_of({{"kind", "header"}, {"version", 1}, {"frame", one.expression}})});
    else if (!one.expression.empty())
      bind(one.target, one.expression);
  }
  void bind(const std::string& target, const std::string& expression) {
    bound_.emplace(target, TableExpression(expression, table_->header().columns));
  }

  // Some, but not all, of the needed fields of a kind: a forgotten column.
  void check_kinds() const {
    std::map<std::string, std::vector<std::string>> missing, choices;
    std::map<std::string, int> present, chosen;
    for (const CsvField& field : kCsvFields) {
      const bool bound = bound_.contains(field.target);
      present[field.kind] += bound;
      if (field.need == Need::needed && !bound) missing[field.kind].push_back(field.target);
      if (field.need == Need::one_of_several)
        choices[field.kind].push_back(field.target), chosen[field.kind] += bound;
    }
    for (const auto& [kind, targets] : choices)
      if (present[kind] > 0 && chosen[kind] == 0)
        refuse(fmt::format("records of the kind '{}' also need {}", kind, fmt::join(targets, " or ")),
               fmt::format("--columns {}=COLUMN", targets[0]));
    bool any = false;
    for (const auto& [kind, count] : present) {
      any = any || count > 0;
      if (count > 0 && !missing[kind].empty())
        refuse(fmt::format("records of the kind '{}' also need {}", kind, fmt::join(missing[kind], ", ")),
               fmt::format("--columns {}=COLUMN", missing[kind][0]));
    }
    if (!any) refuse("no column of the log is recognised as a reading", "--columns v=SPEED,omega=TURN_RATE");
  }

  void add(const TableRow& row, double t, const std::string& kind) {
    ordered_json values;
    int needed = 0, known = 0;
    bool choice = false, chosen = false;
    for (const CsvField& field : kCsvFields) {
      const auto bound = kind == field.kind ? bound_.find(field.target) : bound_.end();
      if (bound == bound_.end()) continue;
      needed += field.need == Need::needed;
      choice = choice || field.need == Need::one_of_several;
      if (field.word) {
        if (const std::string& word = bound->second.word(row); !word.empty()) values[field.field] = word;
        continue;
      }
      const double value = bound->second.value(row, *table_);
      if (std::isnan(value)) continue;
      values[field.field] = value;
      known += field.need == Need::needed;
      chosen = chosen || field.need == Need::one_of_several;
    }
    needed += choice, known += chosen;
    if (needed == 0 || values.empty() || known == 0) return;
    if (known < needed) {
      ++incomplete_[kind];
      return;
    }
    const auto line = static_cast<std::size_t>(row.number);
    if (kind == "sightings") {
      if (!use_position(values)) {
        ++incomplete_[kind];
        return;
      }
      return add_sighting(line, t, std::move(values));
    }
    ordered_json record{{"kind", kind}, {"t", t}};
    record.update(values);
    records_.push_back({line, text_of(record)});
  }

  /// Replaces the position of a sighting by its range and bearing. Returns false if half of it is missing.
  static bool use_position(ordered_json& item) {
    const bool forward = item.contains(kSeenForward), left = item.contains(kSeenLeft);
    if (forward != left || (!forward && item.contains(kSeenSd))) return false;
    if (!forward) return true;
    const double x = item[kSeenForward], y = item[kSeenLeft], range = std::hypot(x, y);
    item["range"] = range, item["bearing"] = std::atan2(y, x);
    if (item.contains(kSeenSd)) {
      const double sd = item[kSeenSd];
      item["range_sd"] = sd;
      if (range > 0) item["bearing_sd"] = sd / range;
    }
    for (const char* field : {kSeenForward, kSeenLeft, kSeenSd}) item.erase(field);
    return true;
  }

  // Sightings of one time are one set.
  void add_sighting(std::size_t line, double t, ordered_json item) {
    if (set_.empty()) {
      set_ = {{"kind", "sightings"}, {"t", t}, {"items", ordered_json::array()}};
      set_line_ = line;
    }
    set_["items"].push_back(std::move(item));
  }
  void flush() {
    if (!set_.empty()) records_.push_back({set_line_, text_of(set_)});
    set_.clear();
  }

  std::string file_;
  std::unique_ptr<TableSource> table_;
  std::map<std::string, bool> chosen_;
  std::map<std::string, TableExpression> bound_;
  std::vector<LogRecord> records_;
  ordered_json set_ = ordered_json::object();
  std::size_t set_line_ = 0;
  std::size_t without_time_ = 0;
  std::map<std::string, std::size_t> incomplete_;
};

}  // namespace

localization::RobotLog import_csv_log(const std::filesystem::path& file, const std::string& columns,
                                      const TypeRegistry& types,
                                      const std::optional<SensorCoverage>& sensor) {
  CsvLog csv(file, columns);
  const std::vector<LogRecord> records = csv.records();
  localization::RobotLog log = read_log_records(file, records, types, {.sensor = sensor});
  for (std::string& remark : csv.remarks()) log.remarks.push_back(std::move(remark));
  return log;
}

}  // namespace waymark::importers
