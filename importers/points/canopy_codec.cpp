// SPDX-License-Identifier: Apache-2.0
#include "importers/points/canopy_codec.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/json_text.hpp"
#include "importers/points/canopy.hpp"

namespace waymark::importers {

std::string encode_canopies(const Canopies& canopies) {
  nlohmann::json all = nlohmann::json::array();
  for (const auto& canopy : canopies) {
    const auto* raster = dynamic_cast<const ImportedCanopy*>(canopy.get());
    if (!raster) throw std::logic_error("only an imported canopy can be stored in a work folder");
    const CanopyImport& import = raster->import();
    all.push_back({{"chm", import.chm},
                   {"dsm", import.dsm},
                   {"dtm", import.dtm},
                   {"las", import.las},
                   {"resolution", import.resolution},
                   {"ground_square", import.ground_square},
                   {"forest_type", import.forest_type},
                   {"crs", import.crs},
                   {"area", import.area},
                   {"name", import.name},
                   {"memory_bytes", import.memory_bytes}});
  }
  return all.dump();
}

Canopies decode_canopies(std::string_view bytes) {
  Canopies canopies;
  for (const auto& json : nlohmann::json::parse(checked_json(bytes, "canopies")))
    canopies.push_back(import_canopy({.chm = json.at("chm"),
                                      .dsm = json.at("dsm"),
                                      .dtm = json.at("dtm"),
                                      .las = json.at("las"),
                                      .resolution = json.at("resolution"),
                                      .ground_square = json.at("ground_square"),
                                      .forest_type = json.at("forest_type"),
                                      .crs = json.at("crs"),
                                      .area = json.at("area"),
                                      .name = json.at("name"),
                                      .memory_bytes = json.at("memory_bytes"),
                                      .inspect = false}));
  return canopies;
}

}  // namespace waymark::importers
