// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>
#include "core/grid.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Image of a reconstruction, with its pose in plan.
struct ReportedImage {
  std::string name = {};
  std::optional<Eigen::Vector3d> centre = {};
  std::vector<Eigen::Vector2d> footprint = {};  ///< corners on the terrain; empty: it sees the horizon
  std::size_t points = 0;                       ///< tie points; 0: unknown
  double rms = 0;                               ///< of their residuals, pixels
  double position_sd = 0, attitude_sd = 0;      ///< metres, degrees; 0: unknown
};

/// Surveyed point with its residuals.
struct ReportedPoint {
  std::string name = {};
  bool check = false, used = false;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< surveyed
  std::optional<Eigen::Vector3d> error = {};     ///< estimated - surveyed, metres; NaN: not surveyed
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();  ///< of the estimate, metres
  double mark_rms = 0;                           ///< pixels
  double statistic = 0;                          ///< of the blunder test, standard deviations
};

/// Decision about a lens parameter.
struct ReportedLensTerm {
  std::size_t lens = 0;
  std::string parameter = {};
  bool admitted = false;
  double value = 0, sd = 0;
  std::string reason = {};
};

/// Heights and orthophoto, reduced for display.
struct ReportedSurface {
  double west = 0, north = 0, cell = 1;                           ///< of the pictures, metres
  Grid<float> heights = {}, sd = {};                              ///< metres; NaN: none
  Grid<std::uint8_t> reasons = {};                                ///< codes
  Grid<float> brightness = {};                                    ///< of the orthophoto; empty: none
  double full_cell = 0;                                           ///< of dem.tif, metres
  std::vector<std::pair<std::string, std::int64_t>> counts = {};  ///< cells by code: text and number
};

/// Contents of the report of a reconstruction.
struct ReconstructionReport {
  std::string title = {};
  std::string frame = {};                                       ///< CRS, or that the scale is arbitrary
  bool metric = true;                                           ///< false: lengths have no unit
  std::optional<Crs> crs = {};                                  ///< of a metric frame
  std::vector<std::pair<std::string, std::string>> facts = {};  ///< number and what it counts
  std::vector<std::string> messages = {};
  std::vector<ReportedImage> images = {};
  std::vector<Eigen::Vector3d> points = {};  ///< tie points for the plan
  std::vector<ReportedPoint> control = {};
  std::vector<ReportedLensTerm> lenses = {};
  std::vector<std::pair<std::string, std::string>> failures = {};  ///< image and reason
  std::optional<ReportedSurface> surface = {};
};

/// Returns the report as one HTML page without scripts or external references.
std::string reconstruction_page(const ReconstructionReport& report);

/// Returns the plan of the images: footprints, centres, tie points, surveyed points and a scale bar, as SVG.
std::string plan_figure(const ReconstructionReport& report);

/// Returns the figures of heights, their standard deviations, reasons of no data, and the orthophoto.
std::string surface_figures(const ReportedSurface& surface, const std::optional<Crs>& crs);

}  // namespace waymark::exporters
