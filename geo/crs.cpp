// SPDX-License-Identifier: Apache-2.0
#include "geo/crs.hpp"

#include <fmt/format.h>
#include <proj.h>
#include <proj_experimental.h>  // proj_crs_demote_to_2D

#include <cmath>

#include "core/error.hpp"
#include "core/units.hpp"
#include "geo/proj_object.hpp"

namespace waymark::inline geo {

struct Crs::Definition {
  CrsKind kind = CrsKind::local;
  std::string name, authority, code, wkt2, wkt1;
  double metres_per_unit = 1;
  Body body;
};

namespace {

pj_ctx* context() {
  return ProjContext::current().get();
}

std::string text_or_empty(const char* text) {
  return text ? text : "";
}

[[noreturn]] void refuse(std::string_view definition, const std::string& why) {
  const std::string shown(definition.substr(0, 120));
  throw Error(ErrorCode::input, "cannot understand the coordinate reference system: " + why, shown,
              "give it as EPSG:4326, IAU_2015:49900, a PROJ string or WKT");
}

// Returns the horizontal part of compound, bound and three-dimensional systems.
ProjObject horizontal_part(ProjObject crs) {
  for (;;) {
    PJ* part = nullptr;
    switch (proj_get_type(crs.get())) {
      case PJ_TYPE_COMPOUND_CRS:
        part = proj_crs_get_sub_crs(context(), crs.get(), 0);
        break;
      case PJ_TYPE_BOUND_CRS:
        part = proj_get_source_crs(context(), crs.get());
        break;
      case PJ_TYPE_GEOGRAPHIC_3D_CRS:
        part = proj_crs_demote_to_2D(context(), nullptr, crs.get());
        break;
      default:
        return crs;
    }
    crs.reset(part);
    if (!crs) return crs;
  }
}

ProjObject parse(std::string_view definition) {
  ProjContext& proj = ProjContext::current();
  proj.take_message();
  std::string text(definition);
  if (text.starts_with('+') && text.find("+type=crs") == std::string::npos)
    text += " +type=crs";  // else: an operation
  ProjObject crs(proj_create(proj.get(), text.c_str()));
  if (crs) crs = horizontal_part(std::move(crs));
  if (!crs) {
    const std::string why = proj.take_message();
    refuse(definition, why.empty() ? "PROJ does not know it" : why);
  }
  return crs;
}

struct Axis {
  std::string direction, unit;
  double factor = 1;  ///< to metres or radians
};

Axis axis_of(const PJ* crs, int index) {
  const ProjObject system(proj_crs_get_coordinate_system(context(), crs));
  const char* direction = nullptr;
  const char* unit = nullptr;
  Axis axis;
  if (!system || !proj_cs_get_axis_info(context(), system.get(), index, nullptr, nullptr, &direction,
                                        &axis.factor, &unit, nullptr, nullptr))
    return axis;
  return {text_or_empty(direction), text_or_empty(unit), axis.factor};
}

bool are_equivalent(const PJ* a, const PJ* b) {
  return proj_is_equivalent_to_with_ctx(context(), a, b, PJ_COMP_EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS);
}

// Returns whether two projected CRSs have the same numbers whatever their axes are called: of one in a
// GeoTIFF about a pole, east is "north along the meridian of 90 degrees".
bool are_same_projection(const PJ* a, const PJ* b) {
  if (proj_get_type(a) != PJ_TYPE_PROJECTED_CRS || proj_get_type(b) != PJ_TYPE_PROJECTED_CRS) return false;
  const ProjObject conversion_a(proj_crs_get_coordoperation(context(), a));
  const ProjObject conversion_b(proj_crs_get_coordoperation(context(), b));
  const ProjObject base_a(proj_crs_get_geodetic_crs(context(), a));
  const ProjObject base_b(proj_crs_get_geodetic_crs(context(), b));
  return conversion_a && conversion_b && base_a && base_b &&
         are_equivalent(conversion_a.get(), conversion_b.get()) &&
         are_equivalent(base_a.get(), base_b.get()) && axis_of(a, 0).factor == axis_of(b, 0).factor;
}

// Restores the code of a planetary CRS, which GeoTIFF drops. Only a match in every number and in name is
// accepted.
ProjObject catalogued(ProjObject crs) {
  if (proj_get_id_code(crs.get(), 0)) return crs;
  int* confidence = nullptr;
  const std::unique_ptr<PJ_OBJ_LIST, decltype(&proj_list_destroy)> found(
      proj_identify(context(), crs.get(), nullptr, nullptr, &confidence), &proj_list_destroy);
  const std::unique_ptr<int, decltype(&proj_int_list_destroy)> owner(confidence, &proj_int_list_destroy);
  if (!found) return crs;
  const std::string name = text_or_empty(proj_get_name(crs.get()));
  for (int i = 0; i < proj_list_get_count(found.get()); ++i) {
    ProjObject one(proj_list_get(context(), found.get(), i));
    if ((i == 0 && confidence[0] == 100) ||
        (text_or_empty(proj_get_name(one.get())) == name && are_same_projection(crs.get(), one.get())))
      return one;
  }
  return crs;
}

Body body_of(const PJ* crs) {
  const ProjObject ellipsoid(proj_get_ellipsoid(context(), crs));
  double equatorial = 0, inverse_flattening = 0;  // 0 for a sphere
  if (!ellipsoid || !proj_ellipsoid_get_parameters(context(), ellipsoid.get(), &equatorial, nullptr, nullptr,
                                                   &inverse_flattening))
    return {};
  return identify_body(text_or_empty(proj_get_name(ellipsoid.get())), equatorial,
                       inverse_flattening == 0 ? 0 : 1 / inverse_flattening);
}

CrsKind kind_of(const PJ* crs, std::string_view definition) {
  switch (proj_get_type(crs)) {
    case PJ_TYPE_GEOGRAPHIC_2D_CRS:
      return CrsKind::geographic;
    case PJ_TYPE_PROJECTED_CRS:
      return CrsKind::projected;
    case PJ_TYPE_ENGINEERING_CRS:
      return CrsKind::local;
    default:
      refuse(definition, "'" + text_or_empty(proj_get_name(crs)) + "' is neither geographic nor projected");
  }
}

void check_degrees(const PJ* crs, std::string_view definition) {
  for (int i = 0; i < 2; ++i) {
    const Axis axis = axis_of(crs, i);
    if (std::abs(axis.factor / kRadiansPerDegree - 1) > 1e-9)
      refuse(definition, "its angles are in " + axis.unit + ", not in degrees");
    if (axis.direction == "west" || axis.direction == "south")
      refuse(definition, "its coordinates increase to the " + axis.direction);
  }
}

std::string wkt_of(const PJ* crs, PJ_WKT_TYPE version) {
  const char* const options[] = {"MULTILINE=NO", nullptr};
  return text_or_empty(proj_as_wkt(context(), crs, version, options));
}

}  // namespace

Crs::Crs(std::shared_ptr<const Definition> definition) : definition_(std::move(definition)) {}

Crs Crs::from_text(std::string_view definition) {
  if (definition == "local") return local();
  const ProjObject crs = catalogued(parse(definition));
  auto known = std::make_shared<Definition>();
  known->kind = kind_of(crs.get(), definition);
  known->name = text_or_empty(proj_get_name(crs.get()));
  known->authority = text_or_empty(proj_get_id_auth_name(crs.get(), 0));
  if (known->authority == "IAU") known->authority = "IAU_2015";  // as WKT spells it: ID["IAU",49900,2015]
  known->code = text_or_empty(proj_get_id_code(crs.get(), 0));
  known->wkt2 = wkt_of(crs.get(), PJ_WKT2_2019);
  known->wkt1 = wkt_of(crs.get(), PJ_WKT1_GDAL);
  if (known->kind == CrsKind::geographic) check_degrees(crs.get(), definition);
  known->metres_per_unit = known->kind == CrsKind::geographic ? 0 : axis_of(crs.get(), 0).factor;
  if (known->kind != CrsKind::local) known->body = body_of(crs.get());
  ProjContext::current().take_message();  // discards messages about WKT1
  return Crs(std::move(known));
}

Crs Crs::local() {
  static const auto definition = [] {
    Definition local;
    local.name = "local";
    local.wkt2 =
        R"(ENGCRS["local",EDATUM["local"],CS[Cartesian,2],AXIS["x",east,ORDER[1],LENGTHUNIT["metre",1]],)"
        R"(AXIS["y",north,ORDER[2],LENGTHUNIT["metre",1]]])";
    local.wkt1 = R"(LOCAL_CS["local",UNIT["metre",1],AXIS["x",EAST],AXIS["y",NORTH]])";
    return std::make_shared<const Definition>(std::move(local));
  }();
  return Crs(definition);
}

CrsKind Crs::kind() const {
  return definition_->kind;
}
const std::string& Crs::name() const {
  return definition_->name;
}
const std::string& Crs::authority() const {
  return definition_->authority;
}
const std::string& Crs::code() const {
  return definition_->code;
}
std::string Crs::id() const {
  return code().empty() ? name() : authority() + ":" + code();
}
const std::string& Crs::wkt2() const {
  return definition_->wkt2;
}
const std::string& Crs::wkt1() const {
  return definition_->wkt1;
}
double Crs::metres_per_unit() const {
  return definition_->metres_per_unit;
}
const Body& Crs::body() const {
  return definition_->body;
}

bool Crs::same_as(const Crs& other) const {
  if (wkt2() == other.wkt2()) return true;
  if (kind() != other.kind()) return false;
  const ProjObject a = parse(wkt2()), b = parse(other.wkt2());
  return are_equivalent(a.get(), b.get()) || are_same_projection(a.get(), b.get());
}

Crs geographic_crs(const Crs& crs) {
  if (crs.kind() == CrsKind::geographic) return crs;
  if (crs.kind() == CrsKind::local)
    throw Error(ErrorCode::input, "a local CRS has no longitude and latitude", crs.name(),
                "pass --crs to say where the data lies");
  const ProjObject whole = parse(crs.wkt2());
  const ProjObject geodetic(proj_crs_get_geodetic_crs(context(), whole.get()));
  return Crs::from_text(wkt_of(geodetic.get(), PJ_WKT2_2019));
}

}  // namespace waymark::inline geo
