// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/laser_rocks.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/solve.hpp"
#include "localization/detectors/scan_segments.hpp"

namespace waymark::localization {
namespace {

// range = a + b u + c u^2 over u in [-1, 1] from end to end; c > 0 if the middle is nearer.
struct Arc {
  double front = 0, bulge = 0, residual = 0;
};
Arc fit_arc(std::span<const double> ranges) {
  const auto n = static_cast<Eigen::Index>(ranges.size());
  Eigen::MatrixX3d design(n, 3);
  Eigen::VectorXd r(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = n > 1 ? 2.0 * static_cast<double>(i) / static_cast<double>(n - 1) - 1 : 0;
    design.row(i) << 1, u, u * u;
    r(i) = ranges[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d normal = design.transpose() * design;
  const Eigen::Vector3d fit = solve_symmetric<3>(normal, design.transpose() * r);
  Arc arc;
  arc.bulge = fit(2);
  arc.front = fit(0);
  if (fit(2) > 0) {
    const double u = std::clamp(-fit(1) / (2 * fit(2)), -1.0, 1.0);
    arc.front = fit(0) + u * (fit(1) + u * fit(2));
  }
  arc.residual = std::sqrt((design * fit - r).squaredNorm() / static_cast<double>(n));
  return arc;
}

}  // namespace

std::vector<LaserRock> find_rocks(const LaserScan& scan, const LaserRockOptions& options) {
  std::vector<LaserRock> rocks;
  const std::vector<double> ranges = bridge_outliers(scan, options.jump);
  const std::size_t n = ranges.size();
  for (const BeamSegment& run : split_at_jumps(ranges, options.jump)) {
    const auto [begin, last] = run;
    const std::size_t beams = run.beams();
    if (static_cast<int>(beams) < std::max(options.min_beams, 3) || begin == 0 || last + 1 >= n) continue;
    const double ends = std::max(ranges[begin], ranges[last]);
    if (!(ends < options.max_range) || !(ranges[begin - 1] > ranges[begin] + options.clear) ||
        !(ranges[last + 1] > ranges[last] + options.clear))
      continue;
    const Arc arc = fit_arc({ranges.data() + begin, beams});
    const double radius = cylinder_radius(arc.front, angular_width(scan, beams));
    const double width = 2 * radius;
    if (!(width >= options.min_width && width <= options.max_width) ||
        !(arc.residual <= options.roughness * width) || !(arc.bulge >= options.min_bulge * width))
      continue;
    LaserRock rock;
    rock.beams = static_cast<int>(beams);
    rock.bulge = arc.bulge;
    rock.radius = radius;
    rock.bearing = scan.first_angle + scan.angle_step * 0.5 * static_cast<double>(begin + last);
    rock.range = arc.front + 0.9 * radius;
    // Rocks are not round: the distance from front to centre is known to a fraction of the radius.
    const double beam = scan.angle_step * rock.range;
    rock.range_sd = std::sqrt(0.03 * 0.03 + 0.0625 * radius * radius);
    rock.bearing_sd = std::sqrt(beam * beam / 6 + 0.03 * radius * radius) / rock.range + 0.003;
    rocks.push_back(rock);
  }
  return rocks;
}

SightingSet sightings_of_rocks(const LaserScan& scan, const LaserRockOptions& options) {
  SightingSet set{scan.robot_from_sensor, {}};
  for (const LaserRock& rock : find_rocks(scan, options)) {
    SeenLandmark s;
    s.type = options.type;
    const auto [range, bearing] = level_range_bearing(scan, rock.range, rock.bearing);
    s.range = range;
    s.range_sd = rock.range_sd;
    s.bearing = wrap_angle(bearing);
    s.bearing_sd = rock.bearing_sd;
    if (options.type) {
      const double radius = options.taper * rock.radius, beam = scan.angle_step * rock.range;
      s.features.value[0] = radius;
      s.features.variance[0] = std::pow(options.radius_spread * radius, 2) + beam * beam / 24;
    }
    set.sightings.push_back(s);
  }
  return set;
}

}  // namespace waymark::localization
