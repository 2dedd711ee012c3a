// SPDX-License-Identifier: Apache-2.0
#include "workflows/records/make_stac.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/keep_inputs.hpp"
#include "core/output_error.hpp"
#include "pipeline/engine/runner.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using exporters::RecordFacts;

bool is_time(const std::string& text) {
  constexpr std::string_view form = "dddd-dd-ddTdd:dd:ddZ";
  if (text.size() != form.size()) return false;
  for (std::size_t i = 0; i < form.size(); ++i)
    if (form[i] == 'd' ? text[i] < '0' || text[i] > '9' : text[i] != form[i]) return false;
  return true;
}

std::string address_of(const StacRequest& request, const fs::path& file, const fs::path& folder) {
  if (!request.href.empty())
    return request.href + (request.href.ends_with('/') ? "" : "/") + file.filename().string();
  const fs::path relative =
      fs::absolute(file).lexically_normal().lexically_proximate(fs::absolute(folder).lexically_normal());
  return relative.begin()->string() == ".." ? relative.string() : "./" + relative.string();
}

RecordFacts facts_of(const StacRequest& request, const std::string& file, const fs::path& folder) {
  RecordFacts facts = fs::path(file).extension() == ".gpkg" ? facts_of_map(file) : facts_of_raster(file);
  const InputFile content = pipeline::hash_plain_file(file);
  exporters::RecordAsset& asset = facts.assets.front();
  asset.href = address_of(request, file, folder);
  asset.bytes = static_cast<std::int64_t>(content.bytes);
  asset.sha256 = content.sha256;
  if (!request.datetime.empty() && facts.first_image.empty())
    facts.first_image = facts.last_image = request.datetime;
  if (facts.created.empty()) facts.created = facts.first_image;
  return facts;
}

void check_request(const StacRequest& request) {
  if (!request.datetime.empty() && !is_time(request.datetime))
    throw Error(ErrorCode::usage, fmt::format("'{}' is not a time", request.datetime), "--datetime",
                "write it in UTC: 2026-11-24T10:00:00Z");
  const bool one_item = fs::path(request.output).extension() == ".json";
  if (one_item && request.files.size() != 1)
    throw Error(ErrorCode::usage,
                fmt::format("{} files cannot share the item {}", request.files.size(), request.output), "",
                "name a folder: it gets an item for each file");
  if (one_item && !request.collection.empty())
    throw Error(ErrorCode::usage, "--collection names the records of a folder, and the output is one item",
                request.output, "name a folder");
  std::set<std::string> ids;
  for (const std::string& file : request.files) {
    const std::string id = fs::path(file).stem();
    if (id == "collection" || !ids.insert(id).second)
      throw Error(ErrorCode::usage,
                  fmt::format("the id '{}' is taken: items are named after their files", id), file,
                  "rename the file or give it a folder of its own");
  }
}

}  // namespace

StacResult make_stac(const StacRequest& request, const Callbacks& callbacks) {
  check_request(request);
  keep_inputs(request.output, request.files);
  if (fs::path(request.output).extension() == ".json") {
    RecordFacts facts = facts_of(request, request.files.front(), fs::absolute(request.output).parent_path());
    facts.description = request.description;
    write_file(request.output, exporters::stac_item(facts));
    callbacks.summary(fmt::format("{}: item {}\n", request.output, facts.id));
    return {.items = {request.output}, .collection = {}, .id = facts.id};
  }
  const fs::path folder = request.output;
  std::vector<RecordFacts> items;
  for (const std::string& file : request.files) items.push_back(facts_of(request, file, folder));
  const fs::path named = fs::absolute(folder / ".").lexically_normal().parent_path().filename();
  const std::string id = request.collection.empty() ? named.string() : request.collection;
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) fail_output(folder, failed.message());
  StacResult result{.items = {}, .collection = (folder / "collection.json").string(), .id = id};
  for (const RecordFacts& facts : items) {
    result.items.push_back((folder / (facts.id + ".json")).string());
    write_file(result.items.back(), exporters::stac_item(facts, id));
  }
  const std::string description =
      request.description.empty() ? "Maps and rasters of " + id : request.description;
  write_file(result.collection, exporters::stac_collection(id, description, items));
  callbacks.summary(fmt::format("{}: collection {}, {} items\n", result.collection, id, items.size()));
  return result;
}

}  // namespace waymark::workflows
