// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <numbers>
#include <sstream>

#include "core/random.hpp"
#include "tests/apps/made_pose.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(GraphCommand, SolvesAGraphWithoutAMap) {
  const TempFolder folder;
  write_text(folder / "square.txt",
             "ODOMETRY 0 1 1 0 1.5707963 10 0 0 10 0 10\n"
             "ODOMETRY 1 2 1 0 1.5707963 10 0 0 10 0 10\n"
             "ODOMETRY 2 3 1.1 0 1.5707963 10 0 0 10 0 10\n"
             "ODOMETRY 3 0 1 0 1.5707963 10 0 0 10 0 10\n");
  const Outcome o = waymark({"localize", "none", folder / "square.txt", "-o", folder / "t.csv", "--method",
                             "graph", "--log-format", "isam"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("chi2"), HasSubstr("converged            true")));
  EXPECT_THAT(text_of(folder / "t.csv"), HasSubstr("t,x,y,z,roll,pitch,yaw,var_x"));
  write_text(folder / "bad.g2o", "VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0\n");
  const Outcome bad =
      waymark({"localize", "none", folder / "bad.g2o", "-o", folder / "u.csv", "--method", "graph"});
  EXPECT_EQ(bad.code, 1);
  EXPECT_THAT(bad.err, AllOf(HasSubstr("line 2"), HasSubstr("cut off")));
  EXPECT_EQ(text_of(folder / "u.csv"), "");
}

/// Ten rounds of a square of 200 poses each; each pose is tied to the one a round before.
struct Rounds {
  std::vector<MadePose> truth;
  struct Edge {
    int from, to;
    MadePose step;
  };
  std::vector<Edge> edges;

  explicit Rounds(int poses) {
    Random random(11, "rounds");
    MadePose at;
    for (int i = 0; i < poses; ++i) {
      truth.push_back(at);
      at = at * MadePose{1, 0, i % 50 == 49 ? std::numbers::pi / 2 : 0};
    }
    const auto tie = [&](int from, int to) {
      const MadePose step = truth[std::size_t(from)].to(truth[std::size_t(to)]);
      edges.push_back({from,
                       to,
                       {step.x + 0.02 * random.normal(), step.y + 0.02 * random.normal(),
                        step.yaw + 0.005 * random.normal()}});
    };
    for (int i = 1; i < poses; ++i) {
      tie(i - 1, i);
      if (i >= 200) tie(i, i - 200);
    }
  }
  std::vector<MadePose> guess() const {
    std::vector<MadePose> all{truth[0]};
    for (const Edge& e : edges)
      if (e.to == e.from + 1) all.push_back(all.back() * e.step);
    return all;
  }
};

std::vector<MadePose> poses_of(const std::string& track) {
  std::istringstream rows(track);
  std::string row;
  std::getline(rows, row);
  std::vector<MadePose> all;
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    all.push_back({v[1], v[2], v[6]});
  }
  return all;
}

TEST(GraphCommand, TwoThousandPosesOfG2oToroAndIsamAreOneGraph) {
  const Rounds made(2000);
  const auto guess = made.guess();
  std::ostringstream g2o, toro, isam;
  for (std::ostringstream* text : {&g2o, &toro, &isam}) text->precision(12);
  for (std::size_t i = 0; i < guess.size(); ++i) {
    g2o << "VERTEX_SE2 " << i << ' ' << guess[i].x << ' ' << guess[i].y << ' ' << guess[i].yaw << '\n';
    toro << "VERTEX2 " << i << ' ' << guess[i].x << ' ' << guess[i].y << ' ' << guess[i].yaw << '\n';
  }
  for (const Rounds::Edge& e : made.edges) {
    const MadePose& s = e.step;
    g2o << "EDGE_SE2 " << e.from << ' ' << e.to << ' ' << s.x << ' ' << s.y << ' ' << s.yaw
        << " 2500 0 0 2500 0 40000\n";
    // TORO: xx xy yy aa xa ya.
    toro << "EDGE2 " << e.from << ' ' << e.to << ' ' << s.x << ' ' << s.y << ' ' << s.yaw
         << " 2500 0 2500 40000 0 0\n";
    isam << "EDGE2 " << e.from << ' ' << e.to << ' ' << s.x << ' ' << s.y << ' ' << s.yaw
         << " 50 0 0 50 0 200\n";
  }
  const TempFolder folder;
  std::vector<std::vector<MadePose>> solved;
  for (const auto& [name, text] : {std::pair{"g2o", g2o.str()}, {"toro", toro.str()}, {"isam", isam.str()}}) {
    write_text(folder / name, text);
    const Outcome o = waymark({"localize", "none", folder / name, "-o", folder / "t.csv", "--method", "graph",
                               "--log-format", name});
    ASSERT_EQ(o.code, 0) << name << o.err;
    EXPECT_THAT(o.out, HasSubstr("converged            true")) << name;
    solved.push_back(poses_of(text_of(folder / "t.csv")));
    ASSERT_EQ(solved.back().size(), made.truth.size()) << name;
  }
  double worst = 0;
  for (std::size_t i = 0; i < made.truth.size(); ++i) {
    worst = std::max(worst, solved[0][i].away(made.truth[i]));
    for (std::size_t k = 1; k < solved.size(); ++k)
      ASSERT_LT(solved[0][i].away(solved[k][i]), 1e-3) << i << ' ' << k;
  }
  EXPECT_LT(worst, 2) << "odometry alone is " << guess.back().away(made.truth.back()) << " m off";
}

}  // namespace
}  // namespace waymark::test
