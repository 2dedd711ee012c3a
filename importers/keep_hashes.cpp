// SPDX-License-Identifier: Apache-2.0
#include "importers/keep_hashes.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"
#include "importers/gdal_session.hpp"
#include "importers/hash.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Clock = std::chrono::system_clock;

constexpr std::uint64_t kWorthKeeping = 1 << 20;  // smaller files are read in a millisecond

/// What changes when the content of a file does.
struct FileState {
  std::string text;
  std::uint64_t bytes = 0;
  Clock::time_point changed;
};

Clock::time_point time_of(const ::timespec& time) {
  return Clock::time_point(std::chrono::seconds(time.tv_sec)) +
         std::chrono::duration_cast<Clock::duration>(std::chrono::nanoseconds(time.tv_nsec));
}

// The time of a change of the inode cannot be set, so a copy that keeps the time of its content is noticed.
std::optional<FileState> state_of_local(const std::string& path) {
  struct ::stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileState{
      fmt::format("{}\n{} {}.{} {}.{} {}\n", path, status.st_size, status.st_mtim.tv_sec,
                  status.st_mtim.tv_nsec, status.st_ctim.tv_sec, status.st_ctim.tv_nsec, status.st_ino),
      static_cast<std::uint64_t>(status.st_size), std::max(time_of(status.st_mtim), time_of(status.st_ctim))};
}

std::optional<FileState> state_on_server(const std::string& path) {
  const GdalListener quiet;
  VSIStatBufL status;
  if (VSIStatL(path.c_str(), &status) != 0 || VSI_ISDIR(status.st_mode) || status.st_mtime <= 0)
    return std::nullopt;
  return FileState{fmt::format("{}\n{} {}\n", path, status.st_size, status.st_mtime),
                   static_cast<std::uint64_t>(status.st_size), Clock::from_time_t(status.st_mtime)};
}

std::optional<FileState> state_of(const std::string& path) {
  constexpr std::array<std::string_view, 7> kServers{"/vsicurl", "/vsis3",  "/vsigs",   "/vsiaz",
                                                     "/vsiadls", "/vsioss", "/vsiswift"};
  if (!path.starts_with("/vsi")) return state_of_local(path);
  const bool is_on_server = std::ranges::any_of(kServers, [&](std::string_view name) {
    return path.starts_with(std::string(name) + "/") || path.starts_with(std::string(name) + "?");
  });
  return is_on_server ? state_on_server(path) : std::nullopt;
}

/// Returns the state of all files behind a path; `std::nullopt` if it must be read.
std::optional<FileState> state_of_input(const std::string& path, std::chrono::seconds settled) {
  FileState all{"waymark 1\n", 0, {}};
  for (const std::string& file : hashed_files(path)) {
    const std::optional<FileState> state = state_of(file);
    if (!state) return std::nullopt;
    all.text += state->text;
    all.bytes += state->bytes;
    all.changed = std::max(all.changed, state->changed);
  }
  if (all.bytes < kWorthKeeping || Clock::now() - all.changed < settled) return std::nullopt;
  return all;
}

/// Returns a kept sum; `std::nullopt` if there is none, or it is damaged.
std::optional<InputFile> find(const fs::path& record, const std::string& path) try {
  std::error_code ignored;
  if (!fs::exists(record, ignored)) return std::nullopt;
  const Json kept = Json::parse(checked_json(read_text(record, "a checksum"), record.string()));
  InputFile input{path, kept.at("bytes").get<std::uint64_t>(), kept.at("sha256").get<std::string>()};
  const bool is_sum =
      input.sha256.size() == 64 && input.sha256.find_first_not_of("0123456789abcdef") == std::string::npos;
  return is_sum ? std::optional(std::move(input)) : std::nullopt;
} catch (const Error&) {
  return std::nullopt;
} catch (const Json::exception&) {
  return std::nullopt;
}

void keep(const fs::path& record, const InputFile& input) {
  std::error_code problem;
  fs::create_directories(record.parent_path(), problem);
  if (problem)
    throw Error(ErrorCode::output, "cannot create a folder in the work folder: " + problem.message(),
                record.parent_path().string(), "choose another folder with --work");
  write_file(record, Json{{"path", input.path}, {"bytes", input.bytes}, {"sha256", input.sha256}}.dump(
                         2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

pipeline::FileHasher keep_hashes(pipeline::FileHasher hash, fs::path folder, std::chrono::seconds settled) {
  return [hash = std::move(hash), folder = std::move(folder), settled](const std::string& path) {
    const std::optional<FileState> state = state_of_input(path, settled);
    if (!state) return hash(path);
    const fs::path record = folder / (pipeline::sha256(state->text).substr(0, 32) + ".json");
    if (std::optional<InputFile> kept = find(record, path)) return std::move(*kept);
    InputFile input = hash(path);
    keep(record, input);
    return input;
  };
}

}  // namespace waymark::importers
