// SPDX-License-Identifier: Apache-2.0
#include "importers/dem_codec.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "importers/dem.hpp"
#include "importers/nodata_policy.hpp"

namespace waymark {

std::string Codec<DemHandle>::encode(const DemHandle& dem) {
  const auto* imported = dynamic_cast<const ImportedDem*>(dem.get());
  if (!imported) throw std::logic_error("only a DEM that import_dem opened can be kept in a work folder");
  const DemImport& import = imported->import();
  return nlohmann::json{{"files", import.files},
                        {"nodata", to_string(import.nodata)},
                        {"crs", import.crs},
                        {"memory_bytes", import.memory_bytes},
                        {"height_sd", import.height_sd}}
      .dump();
}

DemHandle Codec<DemHandle>::decode(std::string_view bytes) {
  const auto json = nlohmann::json::parse(bytes);
  return import_dem({.files = json.at("files"),
                     .nodata = nodata_policy(json.at("nodata").get<std::string>()),
                     .crs = json.at("crs"),
                     .memory_bytes = json.at("memory_bytes"),
                     .height_sd = json.at("height_sd"),
                     .inspect = false});
}

}  // namespace waymark
