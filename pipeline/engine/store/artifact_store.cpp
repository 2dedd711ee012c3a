// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/store/artifact_store.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kManifest = "manifest.json";
constexpr std::string_view kPrefix = ".part-";

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

// Returns the process of this machine that created a name of temporary_path, else 0.
pid_t local_owner(std::string_view name) {
  const std::string suffix = "-" + host_name();
  if (!name.starts_with(kPrefix) || !name.ends_with(suffix)) return 0;
  pid_t process = 0;
  std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), process);
  return process;
}

bool is_gone(pid_t process) {
  return kill(process, 0) != 0 && errno == ESRCH;
}

// Returns a path in `folder` that no other thread, process or machine uses, for a file to be renamed later.
// The name identifies the process, so that files left by killed processes are recognised.
fs::path temporary_path(const fs::path& folder) {
  static std::atomic<int> counter = 0;
  return folder / fmt::format("{}{}-{}-{}", kPrefix, getpid(), counter++, host_name());
}

// Removes temporary files that killed processes of this machine left in `folder`.
void remove_stale_files(const fs::path& folder) {
  std::error_code ignored;  // another process may be cleaning the same folder
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    const pid_t owner = local_owner(entry->path().filename().string());
    if (owner > 0 && is_gone(owner)) fs::remove_all(entry->path(), ignored);
  }
}

// Throws Error{output} with the system's reason.
void write_file(const fs::path& path, std::string_view bytes) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file)
    throw Error(ErrorCode::output, std::string("cannot write into the work folder: ") + std::strerror(errno),
                path.string(),
                "free some space or choose another folder with --work; finished results are kept");
}

std::string read_file(const fs::path& path) {
  return read_text(path, "from the work folder", ErrorCode::input, "run again: missing results are computed");
}

void make_folder(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem)
    throw Error(ErrorCode::output, "cannot create the work folder: " + problem.message(), folder.string(),
                "choose another folder with --work");
}

fs::path payload_file(const fs::path& result, const std::string& port) {
  return result / (port + ".bin");
}

bool is_there(const fs::path& path) {
  std::error_code ignored;  // an unreadable path counts as absent
  return fs::exists(path, ignored);
}

/// Returns the manifest of a complete and undamaged result, else null.
Json intact_manifest(const fs::path& result) try {
  if (!is_there(result / kManifest)) return nullptr;
  Json manifest = Json::parse(checked_json(read_file(result / kManifest), kManifest));
  for (const auto& [port, sum] : manifest.at("outputs").items())
    if (sha256(read_file(payload_file(result, port))) != sum.get<std::string>()) return nullptr;
  return manifest;
} catch (const Error&) {
  return nullptr;
} catch (const Json::exception&) {
  return nullptr;
}

/// Removes the files of a failed save. After a rename the path no longer exists.
struct Undo {
  fs::path path;
  ~Undo() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

Artifact::Value load(const fs::path& file, const ErasedCodec& codec, const std::string& stage) try {
  return codec.decode(read_file(file));
} catch (const std::exception& problem) {
  throw Error(ErrorCode::input, std::string("cannot read a stored result: ") + problem.what(), file.string(),
              "compute it again with --rerun-from " + stage);
}

/// Renames a complete result to its final path. If another process was first, its equal result stays.
void publish(const fs::path& temporary, const fs::path& result) {
  std::error_code problem;
  for (int attempt = 0; attempt < 8; ++attempt) {
    fs::rename(temporary, result, problem);
    if (!problem) return;
    if (!intact_manifest(result).is_null()) return;
    std::error_code ignored;
    const fs::path damaged = temporary_path(result.parent_path());
    fs::rename(result, damaged, ignored);
    fs::remove_all(damaged, ignored);
  }
  throw Error(ErrorCode::output, "cannot move a result to its final path: " + problem.message(),
              result.string(), "check the write permissions, or choose another folder with --work");
}

}  // namespace

ArtifactStore::ArtifactStore(fs::path folder) : folder_(std::move(folder)) {
  make_folder(folder_);
}

fs::path ArtifactStore::item_folder(const Unit& unit) const {
  return folder_ / unit.stage / unit.item;
}
fs::path ArtifactStore::result_folder(const Unit& unit) const {
  return item_folder(unit) / unit.fingerprint;
}
fs::path ArtifactStore::failure_file(const Unit& unit) const {
  return item_folder(unit) / (unit.fingerprint + ".failure.json");
}

bool ArtifactStore::contains(const Unit& unit) const {
  return is_there(result_folder(unit) / kManifest);
}

std::optional<StoredUnit> ArtifactStore::find(const Unit& unit, const StageSpec& spec) const {
  const fs::path result = result_folder(unit);
  const Json manifest = intact_manifest(result);
  if (manifest.is_null()) return std::nullopt;
  StoredUnit stored;
  try {
    stored.counts = {manifest.at("in"), manifest.at("out"), manifest.at("rejected")};
    stored.warnings = manifest.at("warnings");
    for (const OutputPort& port : spec.outputs) {
      if (!manifest.at("outputs").contains(port.name)) return std::nullopt;
      stored.artifacts[port.name] = artifact(unit, spec, port);
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return stored;
}

ArtifactPtr ArtifactStore::artifact(const Unit& unit, const StageSpec& spec, const OutputPort& port) const {
  return std::make_shared<Artifact>(
      [file = payload_file(result_folder(unit), port.name), codec = port.codec, stage = spec.name] {
        return load(file, *codec, stage);
      },
      spec.scope == Scope::tile ? Artifact::Retention::release : Artifact::Retention::keep);
}

void ArtifactStore::save(const Unit& unit, const StageSpec& spec, const UnitOutcome& outcome) const {
  const fs::path folder = item_folder(unit);
  make_folder(folder);
  remove_stale_files(folder);
  const fs::path temporary = temporary_path(folder);
  make_folder(temporary);
  const Undo undo{temporary};
  Json manifest{{"stage", unit.stage},
                {"item", unit.item},
                {"fingerprint", unit.fingerprint},
                {"version", spec.version},
                {"in", outcome.counts.in},
                {"out", outcome.counts.out},
                {"rejected", outcome.counts.rejected},
                {"warnings", outcome.warnings},
                {"outputs", Json::object()}};
  for (const OutputPort& port : spec.outputs) {
    const std::string bytes = port.codec->encode(outcome.outputs.find(port.name)->second.get());
    write_file(payload_file(temporary, port.name), bytes);
    manifest["outputs"][port.name] = sha256(bytes);
  }
  write_file(temporary / kManifest, manifest.dump(2, ' ', false, Json::error_handler_t::replace));
  publish(temporary, result_folder(unit));
  std::error_code ignored;
  fs::remove(failure_file(unit), ignored);
}

void ArtifactStore::remove(const Unit& unit) const {
  std::error_code ignored;  // a missing result need not be removed
  const fs::path temporary = temporary_path(item_folder(unit));
  fs::rename(result_folder(unit), temporary, ignored);
  fs::remove_all(temporary, ignored);
}

void ArtifactStore::save_failure(const Unit& unit, std::string_view message) const {
  make_folder(item_folder(unit));
  const fs::path temporary = temporary_path(item_folder(unit));
  write_file(temporary, Json{{"unit", unit.id()}, {"message", message}}.dump(2, ' ', false,
                                                                             Json::error_handler_t::replace));
  std::error_code ignored;  // the report holds the failure as well
  fs::rename(temporary, failure_file(unit), ignored);
}

}  // namespace waymark::pipeline
