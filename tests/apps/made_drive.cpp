// SPDX-License-Identifier: Apache-2.0
#include "made_drive.hpp"

#include <filesystem>
#include <sstream>

#include "core/random.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

struct Seen {
  std::size_t rock;
  double range, bearing, radius;
};
struct Moment {
  double t, x, y, yaw, v, omega;
  std::vector<Seen> seen;
};

std::vector<Moment> drive(const MadeDrive& how) {
  const auto rocks = made_rocks();
  Random random(4, "drive");
  std::vector<Moment> all;
  double x = 0, y = -6, yaw = 0;
  for (int i = 0; i < how.steps; ++i) {
    Moment m{.t = 100 + 0.5 * i,
             .x = x,
             .y = y,
             .yaw = yaw,
             .v = how.speed * (1 + 0.05 * random.normal()),
             .omega = how.turn + 0.01 * random.normal(),
             .seen = {}};
    for (std::size_t k = 0; k < rocks.size(); ++k) {
      const double dx = rocks[k].x - x, dy = rocks[k].y - y, range = std::hypot(dx, dy);
      const double bearing = std::remainder(std::atan2(dy, dx) - yaw, 2 * M_PI);
      if (range > how.reach || range < 0.5) continue;
      m.seen.push_back({k, range + 0.05 * random.normal(), bearing + 0.01 * random.normal(),
                        rocks[k].radius * (1 + 0.05 * random.normal())});
    }
    all.push_back(m);
    x += 0.5 * how.speed * std::cos(yaw + how.turn / 4);
    y += 0.5 * how.speed * std::sin(yaw + how.turn / 4);
    yaw = std::remainder(yaw + 0.5 * how.turn, 2 * M_PI);
  }
  return all;
}

}  // namespace

std::vector<Rock> made_rocks() {
  Random random(2, "rocks");
  std::vector<Rock> all;
  for (int i = 0; i < 90; ++i)
    all.push_back({random.uniform(-25, 25), random.uniform(-25, 25), random.log_uniform(0.2, 1)});
  return all;
}

std::string rocks_csv(double east, double north) {
  std::ostringstream text;
  text.precision(9);
  text << "uid,x,y,radius,position_sd\n";
  const auto rocks = made_rocks();
  for (std::size_t i = 0; i < rocks.size(); ++i)
    text << "r" << i << ',' << rocks[i].x + east << ',' << rocks[i].y + north << ',' << rocks[i].radius
         << ",0.03\n";
  return text.str();
}

std::string drive_log(const MadeDrive& how) {
  std::ostringstream text;
  const auto line = [&](int step, const std::string& kind, const std::string& words) {
    const std::string changed = how.change ? how.change(step, kind, words) : words;
    if (!changed.empty()) text << changed << '\n';
  };
  const auto moments = drive(how);
  std::ostringstream head;
  head << R"({"kind":"header","version":1)" << how.header;
  if (how.start)
    head << R"(,"start":{"x":)" << moments[0].x << R"(,"y":)" << moments[0].y << R"(,"yaw":)"
         << moments[0].yaw << "}";
  head << "}";
  line(0, "header", head.str());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Moment& m = moments[i];
    const int step = static_cast<int>(i);
    std::ostringstream odometry, truth, items;
    odometry << R"({"kind":"odometry","t":)" << m.t << R"(,"v":)" << m.v << R"(,"omega":)" << m.omega << "}";
    line(step, "odometry", odometry.str());
    truth << R"({"kind":"truth","t":)" << m.t << R"(,"x":)" << m.x << R"(,"y":)" << m.y << R"(,"yaw":)"
          << m.yaw << "}";
    if (how.truth) line(step, "truth", truth.str());
    items << R"({"kind":"sightings","t":)" << m.t << R"(,"items":[)";
    for (std::size_t k = 0; k < m.seen.size(); ++k) {
      const Seen& s = m.seen[k];
      items << (k ? "," : "") << R"({"type":"rock","range":)" << s.range << R"(,"bearing":)" << s.bearing
            << R"(,"range_sd":0.05,"bearing_sd":0.01)";
      if (how.features) items << R"(,"features":{"radius":)" << s.radius << "}";
      if (how.named) items << R"(,"landmark":"r)" << s.rock << "\"";
      items << "}";
    }
    items << "]}";
    line(step, "sightings", items.str());
  }
  return text.str();
}

void write_mrclam(const std::string& folder) {
  namespace fs = std::filesystem;
  fs::create_directories(folder);
  std::ostringstream codes, places, truth, odometry, seen;
  for (std::ostringstream* text : {&codes, &places, &truth, &odometry, &seen}) {
    text->precision(9);
    *text << "# made by a test\n";
  }
  // Subjects 1 to 5 are robots; the code of subject n is 100 + n.
  for (int subject = 1; subject <= 5; ++subject) codes << subject << '\t' << 100 + subject << '\n';
  const auto rocks = made_rocks();
  for (std::size_t i = 0; i < rocks.size(); ++i) {
    codes << 6 + i << '\t' << 106 + i << '\n';
    places << 6 + i << '\t' << rocks[i].x << '\t' << rocks[i].y << "\t0.001\t0.001\n";
  }
  MadeDrive how;
  how.steps = 200;
  for (const Moment& m : drive(how)) {
    truth << m.t << '\t' << m.x << '\t' << m.y << '\t' << m.yaw << '\n';
    // Commands are obeyed late and in part, and the camera takes its time to find a code: the reader knows.
    odometry << m.t - 0.2 << '\t' << m.v / 0.93 << '\t' << m.omega / 0.89 << '\n';
    for (const Seen& s : m.seen)
      seen << m.t + 0.05 << '\t' << 106 + s.rock << '\t' << s.range << '\t' << s.bearing << '\n';
    seen << m.t + 0.05 << "\t102\t1.5\t0.1\n";  // another robot
  }
  const auto write = [&](const char* name, const std::ostringstream& text) {
    write_text(fs::path(folder) / name, text.str());
  };
  write("Barcodes.dat", codes);
  write("Landmark_Groundtruth.dat", places);
  write("Robot1_Groundtruth.dat", truth);
  write("Robot1_Odometry.dat", odometry);
  write("Robot1_Measurement.dat", seen);
}

}  // namespace waymark::test
