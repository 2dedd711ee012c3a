// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/store/artifact_store.hpp"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/json_text.hpp"
#include "core/text_file.hpp"
#include "pipeline/engine/sha256.hpp"
#include "pipeline/engine/store/parts_file.hpp"

namespace waymark::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kManifest = "manifest.json";

[[noreturn]] void fail_work(const fs::path& path, const std::string& reason) {
  throw Error(ErrorCode::output, "cannot write into the work folder: " + reason, path.string(),
              "free some space or choose another folder with --work; finished results are kept");
}

// Throws Error{output} with the system's reason.
void write_result(const fs::path& path, std::string_view bytes) {
  if (const int failed = write_aside(path, bytes)) fail_work(path, std::strerror(failed));
}

/// Folder beside the results of an item, and removes those of killed processes.
LockedFolder make_aside(const fs::path& item_folder) try {
  return LockedFolder(item_folder);
} catch (const fs::filesystem_error& error) {
  fail_work(item_folder, error.code().message());
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
    if (hash_plain_file(payload_file(result, port)).sha256 != sum.get<std::string>()) return nullptr;
  return manifest;
} catch (const Error&) {
  return nullptr;
} catch (const Json::exception&) {
  return nullptr;
}

Artifact::Value load(const fs::path& file, const ErasedCodec& codec, const std::string& stage) try {
  return codec.from_parts ? codec.from_parts(open_parts(file)) : codec.decode(read_file(file));
} catch (const std::exception& problem) {
  throw Error(ErrorCode::input, std::string("cannot read a stored result: ") + problem.what(), file.string(),
              "compute it again with --rerun-from " + stage);
}

/// Writes one output. Returns its SHA-256.
std::string write_output(const fs::path& file, const OutputPort& port, const Artifact::Value& value) {
  if (port.codec->parts) try {
      return write_parts(file, port.codec->parts(value.get()));
    } catch (const std::system_error& error) {
      fail_work(file, error.code().message());
    }
  const std::string bytes = port.codec->encode(value.get());
  write_result(file, bytes);
  return sha256(bytes);
}

/// Renames a complete result in `aside` to its final path. If another process was first, its equal result
/// stays.
void publish(const fs::path& complete, const fs::path& result, const LockedFolder& aside) {
  std::error_code problem;
  for (int attempt = 0; attempt < 8; ++attempt) {
    fs::rename(complete, result, problem);
    if (!problem) return;
    if (!intact_manifest(result).is_null()) return;
    std::error_code ignored;
    fs::rename(result, aside.path() / fmt::format("damaged-{}", attempt), ignored);
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
  remove_dead_folders(item_folder(unit));  // of a process killed after its result was complete
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
  const LockedFolder aside = make_aside(folder);
  const fs::path complete = aside.path() / "result";  // has the permissions of any new folder
  make_folder(complete);
  Json manifest{{"stage", unit.stage},
                {"item", unit.item},
                {"fingerprint", unit.fingerprint},
                {"version", spec.version},
                {"in", outcome.counts.in},
                {"out", outcome.counts.out},
                {"rejected", outcome.counts.rejected},
                {"warnings", outcome.warnings},
                {"outputs", Json::object()}};
  for (const OutputPort& port : spec.outputs)
    manifest["outputs"][port.name] =
        write_output(payload_file(complete, port.name), port, outcome.outputs.find(port.name)->second);
  write_result(complete / kManifest, manifest.dump(2, ' ', false, Json::error_handler_t::replace));
  publish(complete, result_folder(unit), aside);
  std::error_code ignored;
  fs::remove(failure_file(unit), ignored);
}

void ArtifactStore::remove(const Unit& unit) const {
  if (!is_there(result_folder(unit))) return;
  const LockedFolder aside = make_aside(item_folder(unit));
  std::error_code ignored;  // another process may have removed it
  fs::rename(result_folder(unit), aside.path() / "removed", ignored);
}

void ArtifactStore::save_failure(const Unit& unit, std::string_view message) const {
  make_folder(item_folder(unit));
  const LockedFolder aside = make_aside(item_folder(unit));
  const fs::path file = aside.path() / "failure.json";
  write_result(file, Json{{"unit", unit.id()}, {"message", message}}.dump(2, ' ', false,
                                                                          Json::error_handler_t::replace));
  std::error_code ignored;  // the report holds the failure as well
  fs::rename(file, failure_file(unit), ignored);
}

}  // namespace waymark::pipeline
