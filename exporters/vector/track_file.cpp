// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/track_file.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "core/rotate_axes.hpp"
#include "core/text_file.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/vector/track_formats.hpp"
#include "geo/axes_rotation.hpp"
#include "geo/point_at_height.hpp"
#include "geodb/replace_map.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 20> kColumns{
    "t",     "x",         "y",         "z",       "roll",     "pitch",       "yaw",
    "var_x", "var_y",     "cov_xy",    "var_yaw", "matched",  "rejected",    "wrong",
    "lost",  "cov_x_yaw", "cov_y_yaw", "nis",     "nis_rows", "seconds_used"};
using Values = std::array<double, kColumns.size()>;
constexpr std::size_t kWrong = 13;

// The CRS -1 of GeoPackages. Without a CRS GDAL writes 0, which readers take for degrees.
constexpr const char* kUndefinedCartesian =
    R"(LOCAL_CS["Undefined Cartesian SRS",UNIT["Meter",1],AXIS["X",EAST],AXIS["Y",NORTH]])";

/// Wrong matches are unknown if no matched sighting has an identity in the log.
bool knows_wrong_matches(const localization::Track& track) {
  std::int64_t matched = 0;
  for (const localization::TrackRow& row : track.rows) matched += row.matched;
  return matched == 0 || track.named > 0;
}

/// Unknown values are NaN.
Values values_of(const localization::TrackRow& row, const LocalFrame* frame, bool wrong_known) {
  Eigen::Matrix3d c = row.at.covariance;
  Eigen::Vector3d at(row.at.pose.x, row.at.pose.y, row.z);
  double yaw = row.at.pose.yaw;
  if (frame) {
    const double rotation = grid_rotation(*frame, row.at.pose.at());
    at = point_of_pose(*frame, at).xyz;
    yaw = localization::wrap_angle(yaw + rotation);
    c = rotate_axes(c, rotation);
  }
  return {row.t,
          at.x(),
          at.y(),
          at.z(),
          row.roll,
          row.pitch,
          yaw,
          c(0, 0),
          c(1, 1),
          c(0, 1),
          c(2, 2),
          double(row.matched),
          double(row.rejected),
          wrong_known ? double(row.wrong) : std::nan(""),
          double(row.lost),
          c(0, 2),
          c(1, 2),
          row.nis,
          double(row.nis_rows),
          row.seconds};
}

std::size_t columns_of(const TrackOutput& output) {
  return kColumns.size() - !output.timing;  // times are the last column
}

/// Returns the cell that names the CRS of the positions, with the comma before it; empty for the map frame
/// and local CRSs, where both agree.
std::string crs_cell(const TrackOutput& output) {
  if (!output.frame || output.frame->crs().kind() == CrsKind::local) return {};
  const Crs& crs = output.frame->crs();
  if (!crs.code().empty()) return "," + crs.id();
  std::string quoted = ",\"";
  for (const char c : crs.wkt2()) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

constexpr std::array<std::size_t, 4> kCounts{11, 12, 13, 18};  // indices of kColumns
constexpr double kMaxCount = 1e6, kMaxTime = 1e15;             // no drive has more sightings or seconds

/// Returns the index of the first column whose value no track has; `std::nullopt` if all are possible.
std::optional<std::size_t> impossible_column(const Values& v) {
  if (!(std::abs(v[0]) <= kMaxTime)) return 0;
  for (const std::size_t i : kCounts)
    if (!(v[i] >= 0 && v[i] <= kMaxCount && v[i] == std::floor(v[i]))) return i;
  return {};
}

localization::TrackRow row_of(const Values& v) {
  localization::TrackRow row{.t = v[0],
                             .at = {{v[1], v[2], localization::wrap_angle(v[6])}, Eigen::Matrix3d::Zero()},
                             .z = v[3],
                             .roll = v[4],
                             .pitch = v[5]};
  row.at.covariance << v[7], v[9], v[15], v[9], v[8], v[16], v[15], v[16], v[10];
  row.matched = static_cast<int>(v[11]);
  row.rejected = static_cast<int>(v[12]);
  row.wrong = static_cast<int>(v[13]);
  row.lost = v[14] != 0;
  row.nis = v[17], row.nis_rows = static_cast<int>(v[18]), row.seconds = v[19];
  return row;
}

/// Converts a row from the frame's CRS, as values_of() converts it to that.
void to_map_frame(localization::TrackRow& row, const LocalFrame& frame) {
  const Eigen::Vector3d at = frame.map_frame_from_crs({{row.at.pose.x, row.at.pose.y, row.z}}).xyz;
  const double rotation = grid_rotation(frame, at.head<2>());
  row.at.pose = {at.x(), at.y(), localization::wrap_angle(row.at.pose.yaw - rotation)};
  row.at.covariance = rotate_axes(row.at.covariance, -rotation);
}

/// Returns the separator of a header.
char separator_of(std::string_view line) {
  for (const char c : {',', ';', '\t'})
    if (line.find(c) != std::string_view::npos) return c;
  return ',';
}

/// Returns the cells of a line without the blanks about them; double quotes enclose separators.
std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == separator && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  for (std::string& cell : cells) {
    const std::size_t first = cell.find_first_not_of(" \t\r"), last = cell.find_last_not_of(" \t\r");
    cell = first == std::string::npos ? "" : cell.substr(first, last - first + 1);
  }
  return cells;
}

constexpr std::size_t kCrs = kColumns.size() + 1;

/// Columns of a file: indices of kColumns, kCrs, or kColumns.size() for others.
struct Header {
  std::vector<std::size_t> columns;
  std::array<bool, kColumns.size()> found{};
};

Header read_header(std::string_view line, char separator) {
  Header header;
  for (const std::string& name : cells_of(line, separator)) {
    std::size_t i = 0;
    while (i < kColumns.size() && name != kColumns[i]) ++i;
    if (i < kColumns.size()) header.found[i] = true;
    header.columns.push_back(name == "crs" ? kCrs : i);
  }
  return header;
}

/// Returns the finite number that a cell is.
std::optional<double> number_of(std::string_view cell) {
  double value = 0;
  const auto [rest, problem] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (problem != std::errc() || rest != cell.data() + cell.size() || !std::isfinite(value)) return {};
  return value;
}

localization::Track in_order_of_time(localization::Track track) {
  std::ranges::stable_sort(track.rows, {}, &localization::TrackRow::t);
  return track;
}

/// Throws Error{input}, which begins with `place`, if the values are none of a track.
void check_values(const Values& values, const std::string& place) {
  if (const auto wrong = impossible_column(values))
    throw Error(ErrorCode::input,
                fmt::format("{} = {:g} is not possible in a track", kColumns[*wrong], values[*wrong]), place,
                *wrong == 0 ? fmt::format("times are seconds, at most {:g} from 0", kMaxTime)
                            : "counts are whole numbers from 0 to a million");
}

void count_named(localization::Track& track) {
  for (const localization::TrackRow& row : track.rows) track.named += row.matched;
}

/// Reads the layer `track` of write_track_geopackage().
TrackFile read_track_geopackage(const fs::path& file) {
  const GdalMessages messages;
  const char* only[] = {"GPKG", nullptr};
  const std::unique_ptr<GDALDataset> set(
      GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, only, nullptr, nullptr));
  OGRLayer* layer = set ? set->GetLayerByName("track") : nullptr;
  if (!layer)
    throw Error(ErrorCode::input, set ? "the GeoPackage has no layer 'track'" : "this is no GeoPackage",
                file.string(), "`waymark localize -o track.gpkg` writes one");
  std::array<int, kColumns.size()> fields{};
  for (std::size_t i = 0; i < fields.size(); ++i)
    fields[i] = layer->GetLayerDefn()->GetFieldIndex(kColumns[i]);
  if (fields[0] < 0 || fields[1] < 0 || fields[2] < 0)
    throw Error(ErrorCode::input, "a track has the columns t, x and y", file.string() + ", layer track",
                "`waymark localize -o track.gpkg` writes such a layer");
  TrackFile read;
  bool wrong_known = fields[kWrong] >= 0;
  for (const auto& feature : *layer) {
    Values values{};
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const bool has_value = fields[i] >= 0 && feature->IsFieldSetAndNotNull(fields[i]);
      if (has_value) values[i] = feature->GetFieldAsDouble(fields[i]);
      if (i < 3 && !(has_value && std::isfinite(values[i])))
        throw Error(ErrorCode::input, fmt::format("a pose has no {}", kColumns[i]),
                    fmt::format("{}, feature {}", file.string(), feature->GetFID()));
      if (i == kWrong && !has_value) wrong_known = false;
    }
    check_values(values, fmt::format("{}, feature {}", file.string(), feature->GetFID()));
    read.track.rows.push_back(row_of(values));
  }
  if (!messages.failures().empty())
    throw Error(ErrorCode::input, messages.cause("it is damaged"), file.string(), "write the track again");
  if (wrong_known) count_named(read.track);
  const OGRSpatialReference* srs = layer->GetSpatialRef();
  const bool on_body = srs && (srs->IsProjected() || srs->IsGeographic());
  if (on_body && std::string_view(srs->GetName()) != "Undefined geographic SRS") {
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    char* wkt = nullptr;
    srs->exportToWkt(&wkt, options);
    read.crs = wkt;
    CPLFree(wkt);
  }
  read.track = in_order_of_time(std::move(read.track));
  return read;
}

/// Throws Error{input} for the formats of poses that localize writes without their times.
void refuse_without_times(std::string_view content, const fs::path& file) {
  const std::string_view line = content.substr(0, content.find('\n'));
  std::istringstream words{std::string(line)};
  int numbers = 0;
  for (double number = 0; words >> number;) ++numbers;
  const bool g2o = line.starts_with("VERTEX_") || line.starts_with("EDGE_"),
             kitti = words.eof() && numbers == 12;
  if (g2o || kitti)
    throw Error(ErrorCode::input, fmt::format("poses of {} have no times", g2o ? "g2o" : "KITTI"),
                file.string(), "write the track as .csv, .gpkg or .tum, which have them");
}

}  // namespace

void write_track_csv(const fs::path& file, const localization::Track& track, const TrackOutput& output) {
  fmt::memory_buffer text;
  const std::size_t columns = columns_of(output);
  for (std::size_t i = 0; i < columns; ++i)
    fmt::format_to(std::back_inserter(text), "{}{}", i ? "," : "", kColumns[i]);
  const std::string crs = crs_cell(output);
  fmt::format_to(std::back_inserter(text), "{}\n", crs.empty() ? "" : ",crs");
  const bool wrong_known = knows_wrong_matches(track);
  const bool degrees = output.frame && output.crs && output.crs->kind() == CrsKind::geographic;
  for (const localization::TrackRow& row : track.rows) {
    const Values v = values_of(row, output.frame, wrong_known);
    const int places = degrees ? 11 : 6;
    fmt::format_to(std::back_inserter(text), "{:.4f},{:.{}f},{:.{}f},{:.4f},{:.6f},{:.6f},{:.6f}", v[0], v[1],
                   places, v[2], places, v[3], v[4], v[5], v[6]);
    for (std::size_t i = 7; i < 11; ++i) fmt::format_to(std::back_inserter(text), ",{:.6g}", v[i]);
    for (std::size_t i = 11; i < 15; ++i)
      fmt::format_to(std::back_inserter(text), "{}", std::isnan(v[i]) ? "," : fmt::format(",{:g}", v[i]));
    for (std::size_t i = 15; i < columns; ++i) fmt::format_to(std::back_inserter(text), ",{:.6g}", v[i]);
    fmt::format_to(std::back_inserter(text), "{}\n", crs);
  }
  write_file(file, fmt::to_string(text));
}

void write_track_geopackage(const fs::path& file, const localization::Track& track,
                            const TrackOutput& output) {
  const GdalMessages messages;
  AtomicFile aside(file);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  std::unique_ptr<GDALDataset> set(
      driver ? driver->Create(aside.path().c_str(), 0, 0, 0, GDT_Unknown, nullptr) : nullptr);
  if (!set) fail_output(file, messages.cause("GDAL has no GeoPackage driver"));
  OGRSpatialReference srs;
  srs.importFromWkt(output.crs->kind() == CrsKind::local ? kUndefinedCartesian : output.crs->wkt2().c_str());
  srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRLayer* layer = set->CreateLayer("track", &srs, wkbPoint25D, nullptr);
  if (!layer) fail_output(file, messages.cause("no layer"));
  const std::size_t columns = columns_of(output);
  for (std::size_t i = 0; i < columns; ++i) {
    OGRFieldDefn field(kColumns[i], OFTReal);
    if (layer->CreateField(&field) != OGRERR_NONE) fail_output(file, messages.cause("no column"));
  }
  const bool wrong_known = knows_wrong_matches(track);
  set->StartTransaction();
  for (const localization::TrackRow& row : track.rows) {
    const Values v = values_of(row, output.frame, wrong_known);
    OGRFeature feature(layer->GetLayerDefn());
    for (std::size_t i = 0; i < columns; ++i)
      if (!std::isnan(v[i])) feature.SetField(static_cast<int>(i), v[i]);
    OGRPoint point(v[1], v[2], v[3]);
    feature.SetGeometry(&point);
    if (layer->CreateFeature(&feature) != OGRERR_NONE) fail_output(file, messages.cause("a row was refused"));
  }
  if (set->CommitTransaction() != OGRERR_NONE)
    fail_output(file, messages.cause("the track was not committed"));
  set.reset();
  if (!messages.failures().empty()) fail_output(file, messages.cause("the disk may be full"));
  geodb::replace_map(aside);
}

localization::Track read_track(const fs::path& file, const LocalFrame* frame) {
  TrackFile read = read_track_file(file);
  if (read.crs.empty()) return std::move(read.track);
  const std::string name = Crs::from_text(read.crs).id();
  if (!frame)
    throw Error(ErrorCode::usage, fmt::format("the track is in {}, not in the frame of its map", name),
                file.string(), "give --map MAP, or write the track without --crs");
  if (!frame->crs().same_as(Crs::from_text(read.crs)))
    throw Error(ErrorCode::usage, fmt::format("the track is in {}, the map in {}", name, frame->crs().id()),
                file.string(), "give the map of this track");
  for (localization::TrackRow& row : read.track.rows) to_map_frame(row, *frame);
  return std::move(read.track);
}

TrackFile read_track_file(const fs::path& file) {
  std::string content = read_text(file, "the track");
  if (content.starts_with("SQLite format 3")) return read_track_geopackage(file);
  refuse_without_times(content, file);
  if (content.starts_with("\xEF\xBB\xBF")) content.erase(0, 3);
  if (begins_like_tum(content)) return {in_order_of_time(read_track_tum(content, file)), {}};
  std::istringstream in(content);
  std::string line;
  if (!std::getline(in, line))
    throw Error(ErrorCode::input, "the track is empty", file.string(), "waymark localize writes such files");
  const char separator = separator_of(line);
  const Header header = read_header(line, separator);
  if (!header.found[0] || !header.found[1] || !header.found[2])
    throw Error(ErrorCode::input, "a track has the columns t, x and y", file.string() + ", line 1",
                "`waymark localize -o track.csv` writes such files; .gpkg and TUM (t x y z qx qy qz qw) are "
                "read as well");
  TrackFile read;
  bool wrong_known = header.found[kWrong];
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \r\t") == std::string::npos) continue;
    const std::vector<std::string> cells = cells_of(line, separator);
    const auto refuse = [&](const std::string& problem, const std::string& hint) {
      throw Error(ErrorCode::input, problem, fmt::format("{}, line {}", file.string(), number), hint);
    };
    Values values{};
    for (std::size_t i = 0; i < header.columns.size(); ++i) {
      const std::string cell = i < cells.size() ? cells[i] : "";
      const std::size_t column = header.columns[i];
      if (column == kCrs) {
        if (number > 2 && cell != read.crs)
          refuse("the positions of a track are in one CRS", "write each CRS as a track of its own");
        read.crs = cell;
        continue;
      }
      if (column == kWrong && cell.empty()) {
        wrong_known = false;
        continue;
      }
      const std::optional<double> value = number_of(cell);
      if (!value)
        refuse(fmt::format("column {} of the track is no number", i + 1),
               separator == ';' && cell.find(',') != std::string::npos ? "write decimal points, not commas"
                                                                       : "");
      if (column < values.size()) values[column] = *value;
    }
    if (cells.size() > header.columns.size())
      refuse(fmt::format("{} values for {} columns", cells.size(), header.columns.size()),
             "is a decimal comma or a second separator in the line?");
    check_values(values, fmt::format("{}, line {}", file.string(), number));
    read.track.rows.push_back(row_of(values));
  }
  if (wrong_known) count_named(read.track);
  if (!read.crs.empty()) Crs::from_text(read.crs);  // its errors
  read.track = in_order_of_time(std::move(read.track));
  return read;
}

}  // namespace waymark::exporters
