// SPDX-License-Identifier: Apache-2.0
// Excerpts of the reference of waymark/robot.hpp.
#include <fstream>
#include <iostream>
#include <waymark/map.hpp>
#include <waymark/robot.hpp>
using namespace waymark;

namespace {

void drive() {
  std::ofstream("trees.csv") << "type,x,y,position_sd\ntree,8,2,0.05\ntree,10,-3,0.05\ntree,15,1,0.05\n";
  workflows::ImportRequest import{.table = "trees.csv", .map = "trees.gpkg"};
  import.options.table_crs = "local";
  workflows::import_landmarks(import);

  //! [begin]
  const workflows::LocalizeRequest request{.map = "trees.gpkg", .log = {}, .method = "ekf"};
  localization::RobotLog robot;            // what is known of the robot; no events
  importers::use_gyro_noise(robot, 1e-6);  // rad^2/s
  workflows::LiveLocalizer live(request, robot);
  live.restart(live.start_at({0, 0, 0}));  // metres and radians in the map frame
  //! [begin]

  //! [readings]
  importers::FrameTree frames;
  frames.place("laser", "base_link", Eigen::Isometry3d(Eigen::Translation3d(0.2, 0, 0.4)));
  const Eigen::Isometry3d place = frames.transform("base_link", "laser").value();
  localization::LaserScan scan = importers::laser_scan(-1.5, 0.01, 0.1F, 30, std::vector<float>(300, 30));
  if (importers::is_level(place)) importers::mount(scan, place);
  std::cout << importers::level_pose(place).x << " m ahead of the middle\n";
  const importers::Covariance3 covariance{4, 0, 0, 0, 4, 0, 0, 0, 9};  // m^2: east, north, up
  const localization::GnssFix fix =
      importers::fix_of_antenna(11, 48, importers::horizontal_covariance(covariance, 2), 0.3);
  std::cout << "fix of " << fix.sd << " m\n";
  //! [readings]

  //! [gyro]
  const std::vector<importers::TurnRate> rates{{.t = 0, .rate = 0.1, .variance = 1e-4},
                                               {.t = 1, .rate = 0.1, .variance = 1e-4}};
  const auto poses = importers::with_yaw_of_gyro({{0, {}}, {1, {0.5, 0, 0}}}, rates);
  const localization::Pose2 step = inverse(poses[0].pose) * poses[1].pose;
  std::cout << step.yaw << " rad, variance " << importers::yaw_variance_per_second(rates) << " rad^2/s\n";
  //! [gyro]

  //! [take]
  localization::RobotLog readings;
  readings.events = {{1, localization::StepReading{step}}, {1, scan}};
  live.take(readings);
  const localization::PoseEstimate now = live.replay().track().rows.back().at;
  std::cout << now.pose.at().transpose() << " m\n";
  live.forget_rows();  // of a drive that lasts for days
  //! [take]
}

}  // namespace

int main() {
  drive();
}
