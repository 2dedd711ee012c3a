// SPDX-License-Identifier: Apache-2.0
// A folder of 3-D scans, one file each, in the order of their names.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "importers/logs/import_log.hpp"
#include "importers/logs/point_files.hpp"
#include "localization/detectors/scan_landmarks.hpp"
#include "localization/robot_log.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;
constexpr double kSecondsPerScan = 0.1;  // usual; without times.txt

fs::path folder_of_scans(const fs::path& folder) {
  return fs::is_directory(folder / "velodyne") ? folder / "velodyne" : folder;
}

std::vector<fs::path> scans_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder_of_scans(folder)))
    if (entry.is_regular_file() && is_point_file(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<double> times_of(const fs::path& folder, std::size_t scans, std::vector<std::string>& remarks) {
  std::vector<double> times;
  if (fs::exists(folder / "times.txt")) {
    std::istringstream in(read_text(folder / "times.txt", "the times of the scans"));
    for (double t; in >> t;) times.push_back(t);
    if (times.size() != scans)
      throw Error(ErrorCode::input, fmt::format("there are {} times for {} scans", times.size(), scans),
                  (folder / "times.txt").string(), "one line of seconds belongs to each scan");
    return times;
  }
  remarks.push_back(
      fmt::format("the folder has no times.txt: scans are taken {:g} s apart", kSecondsPerScan));
  for (std::size_t i = 0; i < scans; ++i) times.push_back(kSecondsPerScan * static_cast<double>(i));
  return times;
}

}  // namespace

bool is_point_log(const fs::path& folder) {
  return fs::is_directory(folder) && !scans_in(folder).empty();
}

localization::RobotLog import_point_log(const fs::path& folder, const TypeRegistry& types,
                                        const LogImport& how) {
  const std::vector<fs::path> files = scans_in(folder);
  if (files.empty())
    throw Error(ErrorCode::input, "the folder has no 3-D scans", folder.string(),
                "scans are .bin files of KITTI or .ply files, in it or in its folder velodyne");
  localization::RobotLog log;
  const std::vector<double> times = times_of(folder, files.size(), log.remarks);
  const localization::PointDetector detect =
      localization::make_point_detector(types, how.held_types, how.point_detectors);
  for (std::size_t i = 0; i < files.size(); ++i)
    log.events.push_back({times[i], detect(read_point_file(files[i]))});
  localization::clean_log(log);
  return log;
}

}  // namespace waymark::importers
