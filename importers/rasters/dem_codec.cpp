// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/dem_codec.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/json_text.hpp"
#include "geo/plane_dem.hpp"
#include "importers/rasters/dem.hpp"
#include "importers/rasters/nodata_policy.hpp"

namespace waymark::importers {

std::string encode_dem(const DemHandle& dem) {
  if (const auto* plane = dynamic_cast<const PlaneDem*>(dem.get())) {
    const Crs& crs = plane->geometry().where.crs;
    return nlohmann::json{{"plane", plane->height()},
                          {"height_sd", plane->height_sd()},
                          {"crs", crs.kind() == CrsKind::local ? "local" : crs.wkt2()}}
        .dump();
  }
  const auto* imported = dynamic_cast<const ImportedDem*>(dem.get());
  if (!imported) throw std::logic_error("only a DEM opened by import_dem can be stored in a work folder");
  const DemImport& import = imported->import();
  return nlohmann::json{{"files", import.files},
                        {"nodata", to_string(import.nodata)},
                        {"crs", import.crs},
                        {"band", import.band},
                        {"height_unit", import.height_unit},
                        {"height_scale", import.height_scale},
                        {"fill_distance", import.fill_distance},
                        {"area", import.area},
                        {"memory_bytes", import.memory_bytes},
                        {"height_sd", import.height_sd.value},
                        {"metric", import.metric}}
      .dump();
}

DemHandle decode_dem(std::string_view bytes) {
  const auto json = nlohmann::json::parse(checked_json(bytes, "DEM"));
  if (json.contains("plane")) {
    const std::string crs = json.at("crs");
    return std::make_shared<PlaneDem>(crs == "local" ? Crs::local() : Crs::from_text(crs), json.at("plane"),
                                      json.at("height_sd"));
  }
  return import_dem({.files = json.at("files"),
                     .nodata = nodata_policy(json.at("nodata").get<std::string>()),
                     .crs = json.at("crs"),
                     .band = json.value("band", 0),
                     .height_unit = json.value("height_unit", ""),
                     .height_scale = json.value("height_scale", 1.0),
                     .area = json.value("area", ""),
                     .fill_distance = json.value("fill_distance", 100),
                     .memory_bytes = json.at("memory_bytes"),
                     .height_sd = Meters{json.at("height_sd")},
                     .metric = json.value("metric", false),
                     .inspect = false});
}

}  // namespace waymark::importers
