// SPDX-License-Identifier: Apache-2.0
#include "workflows/file_access.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <cpl_vsi_virtual.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "pipeline/engine/step_options.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// File systems and drivers of GDAL 3.6 that open connections. Most file systems have a twin for streams.
constexpr std::array<std::string_view, 10> kFileSystems{"/vsicurl",    "/vsis3",    "/vsigs",    "/vsiaz",
                                                        "/vsiadls",    "/vsioss",   "/vsiswift", "/vsihdfs",
                                                        "/vsiwebhdfs", "/vsiplugin"};
constexpr std::array<std::string_view, 13> kPrefixes{
    "pg:",    "mysql:", "mssql:", "wms:",  "wmts:", "wcs:",      "wfs:",
    "oapif:", "csw:",   "ngw:",   "eeda:", "es:",   "mongodbv3:"};
/// Drivers that connect without GDAL's functions for HTTP.
constexpr const char* kDatabases =
    "PostgreSQL PostGISRaster MySQL MSSQLSpatial ODBC OCI MongoDBv3 HANA GeoRaster";

constexpr const char* kNotAllowed = "%s: it is on the network, which --allow-network permits";

/// Opens nothing, in place of a file system of the network.
void* refuse_file(void*, const char* file, const char*) {
  CPLError(CE_Failure, CPLE_OpenFailed, kNotAllowed, file);
  return nullptr;
}

/// Answers each request of GDAL with an error.
CPLHTTPResult* refuse_request(const char* address, CSLConstList, GDALProgressFunc, void*,
                              CPLHTTPFetchWriteFunc, void*, void*) {
  CPLError(CE_Failure, CPLE_OpenFailed, kNotAllowed, address);
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("the network is not allowed");
  return result;
}

/// Returns the texts of an option: one, or those of a list.
std::vector<std::string> texts_of(const Json& value) {
  if (value.is_string()) return {value.get<std::string>()};
  std::vector<std::string> all;
  if (value.is_array())
    for (const Json& one : value)
      if (one.is_string()) all.push_back(one.get<std::string>());
  return all;
}

fs::path real_path(const fs::path& path) {
  std::error_code failed;
  const fs::path real = fs::weakly_canonical(fs::absolute(path), failed);
  return failed ? fs::absolute(path).lexically_normal() : real;
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const fs::path inside = real_path(path).lexically_relative(folder);
  return !inside.empty() && *inside.begin() != "..";
}

/// Returns the file of a path that GDAL reads through other layers: /vsizip/a.zip/b.tif is in a.zip.
std::string file_within(std::string path) {
  while (path.starts_with("/vsi")) {
    const std::size_t slash = path.find('/', 1);
    if (slash == path.npos) break;
    path.erase(0, slash + 1);
  }
  return path;
}

}  // namespace

bool is_on_network(const std::string& path) {
  const std::string text = lower_case(path);
  return text.find("://") != text.npos ||
         std::ranges::any_of(kFileSystems,
                             [&](std::string_view name) { return text.find(name) != text.npos; }) ||
         std::ranges::any_of(kPrefixes, [&](std::string_view name) { return text.starts_with(name); });
}

bool names_network(std::span<const std::string> words) {
  return std::ranges::any_of(words, [](const std::string& word) {
    return is_on_network(word) || is_on_network(word.substr(word.find('=') + 1));
  });
}

void refuse_network() {
  CPLHTTPSetFetchCallback(refuse_request, nullptr);
  const std::unique_ptr<VSIFilesystemPluginCallbacksStruct, decltype(&VSIFreeFilesystemPluginCallbacksStruct)>
      callbacks(VSIAllocFilesystemPluginCallbacksStruct(), VSIFreeFilesystemPluginCallbacksStruct);
  callbacks->open = refuse_file;
  constexpr std::array kEnds{"/", "?", "_streaming/"};
  // GDAL forgets the handlers that are replaced: a leak, were they not kept here.
  static std::array<const VSIFilesystemHandler*, kFileSystems.size() * kEnds.size()> replaced;
  static std::array<std::string, replaced.size()> prefixes;  // GDAL keeps pointers to their characters
  std::size_t count = 0;
  for (const std::string_view name : kFileSystems)
    for (const char* end : kEnds) {
      const std::string& prefix = prefixes[count] = std::string(name) + end;
      replaced[count++] = VSIFileManager::GetHandler(prefix.c_str());
      VSIInstallPluginHandler(prefix.c_str(), callbacks.get());
    }
  for (const char* skip : {"GDAL_SKIP", "OGR_SKIP"}) CPLSetConfigOption(skip, kDatabases);
}

void require_files_inside(const pipeline::Pipeline& pipeline, const fs::path& job) {
  const fs::path folder = real_path(pipeline.base_folder.empty() ? "." : pipeline.base_folder);
  for (const auto& step : pipeline.steps()) {
    const Json options = Json::parse(options_as_json(pipeline::option_table(*step)));
    for (const auto& [option, value] : options.items())
      for (const std::string& text : texts_of(value)) {
        const std::string what = fmt::format("{}.{} = {}", step->spec().name, option, text);
        if (is_on_network(text))
          throw Error(ErrorCode::usage, "the job names a place on the network: " + what, job.string(),
                      "if you trust the job, leave out --confined and pass --allow-network");
        const std::string file = file_within(text);
        if (file.empty() || is_below(folder / file, folder)) continue;
        throw Error(ErrorCode::usage, "the job names a file outside its folder: " + what, job.string(),
                    "if you trust the job, leave out --confined; or put the file beside it");
      }
  }
}

}  // namespace waymark::workflows
