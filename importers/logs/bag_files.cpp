// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "core/text_file.hpp"
#include "importers/logs/bag_file.hpp"
#include "importers/logs/zstd.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;

/// Returns the first bytes of a file; none of a pipe, whose reader would miss them.
std::string bag_head(const fs::path& file) {
  if (!fs::is_regular_file(file)) return {};
  std::string head(kRos1Magic.size(), '\0');
  head.resize(VsiFile(file.string()).read(0, head.data(), head.size()));
  return head;
}

std::vector<std::string> visit_plain_bag(const fs::path& file, const BagVisitor& visit) {
  if (bag_head(file).starts_with(kMcapMagic)) return visit_mcap(file, visit);
  if (file.extension() == ".mcap") return visit_mcap(file, visit);  // reports what is wrong with it
  visit_rosbag2(file, visit);
  return {};
}

// rosbag2 compresses a file as a whole, and unpacks it beside the bag to play it.
std::vector<std::string> visit_packed_bag(const fs::path& file, const BagVisitor& visit) {
  const LockedFolder folder(fs::temp_directory_path());
  const fs::path plain = folder.path() / file.stem();
  const std::string packed = read_text(file, "the bag");
  std::string content;
  try {
    content = unpacked_zstd(packed);
  } catch (const std::runtime_error& problem) {
    throw Error(ErrorCode::input, fmt::format("the bag cannot be unpacked: {}", problem.what()),
                file.string(), "copy or record it again");
  }
  if (write_aside(plain, content) != 0)
    throw Error(ErrorCode::environment, "there is no room to unpack the bag", folder.path().string(),
                "set TMPDIR to a folder with more room, or unpack it: unzstd " + file.string());
  return visit_plain_bag(plain, visit);
}

}  // namespace

bool is_bag(const fs::path& file) {
  const fs::path kind = file.extension() == ".zstd" ? file.stem().extension() : file.extension();
  return kind == ".db3" || kind == ".mcap";
}

bool begins_like_mcap(const fs::path& file) {
  return bag_head(file).starts_with(kMcapMagic);
}

bool begins_like_ros1(const fs::path& file) {
  return bag_head(file).starts_with(kRos1Magic);
}

std::vector<fs::path> bag_files(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path)) {
    const fs::path& file = entry.path();
    if (!is_bag(file)) continue;
    // Playing a compressed bag leaves the unpacked file beside it.
    if (file.extension() == ".zstd" && fs::exists(fs::path(file).replace_extension())) continue;
    files.push_back(file);
  }
  // drive_2.db3 comes before drive_10.db3.
  const auto order = [](const fs::path& file) { return std::pair(file.native().size(), file); };
  std::ranges::sort(files, {}, order);
  return files;
}

std::vector<std::string> visit_bag(const fs::path& path, const BagVisitor& visit) {
  std::vector<std::string> remarks;
  for (const fs::path& file : bag_files(path))
    std::ranges::move(
        file.extension() == ".zstd" ? visit_packed_bag(file, visit) : visit_plain_bag(file, visit),
        std::back_inserter(remarks));
  return remarks;
}

}  // namespace waymark::importers
