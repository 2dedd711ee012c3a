// SPDX-License-Identifier: Apache-2.0
#include <proj.h>

#include <cassert>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "geo/crs.hpp"
#include "geo/proj_object.hpp"

namespace waymark::inline geo {
namespace {

[[noreturn]] void refuse(const Crs& from, const Crs& to, const std::string& why, const std::string& hint) {
  throw Error(ErrorCode::input,
              "cannot convert coordinates from " + from.id() + " to " + to.id() + ": " + why, "", hint);
}

std::string place_of(const Crs& crs) {
  return crs.kind() == CrsKind::local ? "a local CRS" : crs.body().name;
}

// Figures of one body may differ slightly (sphere and ellipsoid), those of two bodies by more than 1 %.
bool same_body(const Body& a, const Body& b) {
  return std::abs(a.equatorial_radius / b.equatorial_radius - 1) < 0.01;
}

}  // namespace

struct CrsTransform::Pipeline {
  ProjContext context;   // not shared: the object may move between threads
  ProjObject operation;  // null: nothing to do
};

CrsTransform::CrsTransform(const Crs& from, const Crs& to) : pipeline_(std::make_unique<Pipeline>()) {
  const bool local = from.kind() == CrsKind::local;
  if (local != (to.kind() == CrsKind::local) || (!local && !same_body(from.body(), to.body())))
    refuse(from, to, place_of(from) + " is not " + place_of(to), "choose a CRS of the same body");
  if (from.same_as(to)) return;
  pj_ctx* const context = pipeline_->context.get();
  const ProjObject source(proj_create(context, from.wkt2().c_str()));
  const ProjObject target(proj_create(context, to.wkt2().c_str()));
  const ProjObject as_defined(
      proj_create_crs_to_crs_from_pj(context, source.get(), target.get(), nullptr, nullptr));
  if (as_defined) pipeline_->operation.reset(proj_normalize_for_visualization(context, as_defined.get()));
  if (!pipeline_->operation)
    refuse(from, to, pipeline_->context.take_message(), "convert the data with gdalwarp or ogr2ogr first");
}

CrsTransform::~CrsTransform() = default;
CrsTransform::CrsTransform(CrsTransform&&) noexcept = default;
CrsTransform& CrsTransform::operator=(CrsTransform&&) noexcept = default;

CrsTransform::XY CrsTransform::operator()(double x, double y) const {
  std::vector<double> xs{x}, ys{y};
  apply(xs, ys);
  return {xs[0], ys[0]};
}

void CrsTransform::apply(std::vector<double>& x, std::vector<double>& y) const {
  assert(x.size() == y.size());
  if (!pipeline_->operation) return;
  proj_trans_generic(pipeline_->operation.get(), PJ_FWD, x.data(), sizeof(double), x.size(), y.data(),
                     sizeof(double), y.size(), nullptr, 0, 0, nullptr, 0, 0);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) x[i] = y[i] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace waymark::inline geo
