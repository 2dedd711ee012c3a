// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/rock_evidence.hpp"

#include <algorithm>
#include <cmath>
namespace waymark::pipeline {
namespace {

// Brightness above the ground at a position relative to the rock: `t` away from the sun, `s` across.
class Around {
 public:
  Around(const ShadowMap& map, const RockCandidate& rock, const LightFrame& light)
      : map_(map), rock_(rock), light_(light) {}

  double excess(double s, double t) const {
    const double x = rock_.x + light_.ux * t - light_.uy * s, y = rock_.y + light_.uy * t + light_.ux * s;
    const double u = std::clamp(x, 0.0, static_cast<double>(map_.alpha.columns() - 1));
    const double v = std::clamp(y, 0.0, static_cast<double>(map_.alpha.rows() - 1));
    const auto c = std::min(static_cast<std::int64_t>(u), map_.alpha.columns() - 2);
    const auto r = std::min(static_cast<std::int64_t>(v), map_.alpha.rows() - 2);
    const double fu = u - static_cast<double>(c), fv = v - static_cast<double>(r);
    const auto a = [&](std::int64_t dc, std::int64_t dr) {
      return static_cast<double>(map_.alpha(c + dc, r + dr));
    };
    return -((1 - fv) * ((1 - fu) * a(0, 0) + fu * a(1, 0)) + fv * ((1 - fu) * a(0, 1) + fu * a(1, 1)));
  }

  // Mean of three positions across.
  double band(double half_width, double t) const {
    return (excess(-half_width, t) + excess(0, t) + excess(half_width, t)) / 3;
  }

 private:
  const ShadowMap& map_;
  const RockCandidate& rock_;
  const LightFrame& light_;
};

// Samples a grid from before the lit face to behind the shadow.
void add_sample_grid(const Around& around, const RockCandidate& rock, RockEvidence& evidence) {
  const double middle = rock.size.offset;  // centre of the shadow, from that of the rock
  const double step_along = std::clamp(0.9 * std::sqrt(rock.shadow.along_variance), 1.0, 20.0);
  const double step_across = std::clamp(0.9 * std::sqrt(rock.shadow.across_variance), 1.0, 20.0);
  std::size_t next = kEvidenceCount - 45;
  for (int i = -5; i <= 3; ++i) {
    const double t = middle + i * step_along;
    evidence[next++] = around.excess(0, t);
    for (const double s : {step_across, 2 * step_across}) {
      const double left = around.excess(-s, t), right = around.excess(s, t);
      evidence[next++] = 0.5 * (left + right);
      evidence[next++] = std::abs(left - right);
    }
  }
}

}  // namespace

RockEvidence gather_evidence(const ShadowMap& map, const RockCandidate& rock, const LightFrame& light,
                             const SpotContext& context, const RockTable& table) {
  const Around around(map, rock, light);
  const double r = rock.size.radius, reach = rock.size.reach, tip = std::hypot(r, reach);
  const double root = r * r / tip;  // start of the shadow on the rock, from its centre
  const double mid = 0.5 * (root + tip);
  const double near_left = around.excess(-(r + 1), mid), near_right = around.excess(r + 1, mid);
  const double far_left = around.excess(-(2 * r + 2), mid), far_right = around.excess(2 * r + 2, mid);
  double lit_most = -1.5;
  for (const double t : {-1.1 * r, -0.7 * r, -0.3 * r, 0.1 * r})
    for (const double s : {-0.6 * r, 0.0, 0.6 * r}) lit_most = std::max(lit_most, around.excess(s, t));
  const double spread = std::sqrt(rock.shadow.along_variance * rock.shadow.across_variance);
  const double noise = std::max(1e-3, static_cast<double>(map.noise));
  const double texture = static_cast<double>(map.texture_at(rock.x, rock.y));
  const ShadowMeasure shape = shadow_measure(rock.shadow);
  RockEvidence evidence{
      rock.shadow.peak,
      std::log(r),
      rock.log_ratio_excess,
      spread > 0 ? std::abs(rock.shadow.covariance) / spread : 0,
      std::min(5.0, rock.size.misfit),
      std::clamp(std::log(rock.shadow.peak / noise), 0.0, 4.0),
      std::min(1.0, texture),
      around.band(0.5 * r, -(r + 1.5)),
      around.band(0.4 * r, -0.6 * r),
      lit_most,
      around.band(0.4 * r, mid),
      around.band(0.5 * r, tip + 1.0),
      around.band(0.5 * r, tip + r + 2.0),
      std::min(near_left, near_right),
      std::max(near_left, near_right),
      std::min(far_left, far_right),
      std::max(far_left, far_right),
      std::min(4.0, std::log(static_cast<double>(rock.catchment_cells) / std::max(1, rock.shadow.cells))),
      std::clamp(std::log(rock.shadow.peak / std::max(0.02, context.median_peak)), -2.0, 3.0),
      std::clamp(std::log(rock.shadow.peak / std::max(0.02, context.upper_decile)), -2.0, 3.0),
      std::log(0.2 + context.density),
      std::log(noise),
      table.log_tan_elevation(),
      table.elevation_known() ? 1.0 : 0.0,
      shape.log_area,
      shape.log_across,
      shape.log_along,
      std::log(rock.visible.along),
      rock.visible.deviation,
      rock.visible.displacement};
  add_sample_grid(around, rock, evidence);
  return evidence;
}

}  // namespace waymark::pipeline
