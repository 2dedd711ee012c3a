// SPDX-License-Identifier: Apache-2.0
// `waymark reconstruct --work`: a killed run goes on, and a changed one does only what is missing.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <map>
#include <thread>

#include "tests/apps/photo_flight.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::SizeIs;

class ReconstructResume : public PhotoFlight {
 protected:
  std::vector<std::string> words(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> all{"reconstruct", folder_ / "images", "-o", folder_ / out, "-q"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Finished results of a step, with the times when they were written.
  std::map<std::string, fs::file_time_type> kept(const std::string& step) const {
    std::map<std::string, fs::file_time_type> found;
    std::error_code gone;  // folders of a running process come and go
    for (fs::recursive_directory_iterator at(folder_ / ("work/" + step), gone), end; !gone && at != end;
         at.increment(gone))
      if (at->path().filename() == "manifest.json" &&
          at->path().string().find("/.waymark-") == std::string::npos)
        found[at->path().string()] = fs::last_write_time(at->path());
    return found;
  }
  /// Starts a run and kills it as soon as the step has a result.
  void kill_after(const std::string& step) const {
    const pid_t run = start_waymark(words("killed", {"--work", folder_ / "work"}));
    for (int i = 0; i < 60'000 && kept(step).empty() && waitpid(run, nullptr, WNOHANG) == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(run, SIGKILL);
    waitpid(run, nullptr, 0);
  }
};

constexpr const char* kSteps[] = {"find_features", "match_images", "solve_poses", "georeference",
                                  "sweep_heights"};
constexpr const char* kProducts[] = {"cameras.json", "dem.tif",     "orthophoto.tif",   "points.las",
                                     "job.json",     "report.html", "colmap/images.txt"};

TEST_F(ReconstructResume, AKilledRunGoesOnToTheSameProducts) {
  write_good(6, true);
  ASSERT_EQ(waymark(words("whole")).code, 0);
  std::map<std::string, fs::file_time_type> before;
  for (const char* step : kSteps) {
    kill_after(step);
    const auto found = kept(step);
    EXPECT_FALSE(found.empty()) << step;
    before.insert(found.begin(), found.end());
  }
  const Outcome last = waymark(words("killed", {"--work", folder_ / "work"}));
  ASSERT_EQ(last.code, 0) << last.err;
  for (const auto& [file, time] : before) EXPECT_EQ(fs::last_write_time(file), time) << file;
  for (const char* product : kProducts)
    EXPECT_EQ(text_of(folder_ / ("whole/" + std::string(product))),
              text_of(folder_ / ("killed/" + std::string(product))))
        << product;
}

TEST_F(ReconstructResume, AnotherCellRepeatsTheSweepAlone) {
  write_good(6, true);
  ASSERT_EQ(waymark(words("a", {"--work", folder_ / "work", "--cell", "4"})).code, 0);
  const auto sweeps = kept("sweep_heights");
  const Outcome other = waymark(words("b", {"--work", folder_ / "work", "--cell", "5"}));
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_THAT(kept("find_features"), SizeIs(6));
  EXPECT_THAT(kept("georeference"), SizeIs(1));
  EXPECT_GT(kept("sweep_heights").size(), sweeps.size());
}

TEST_F(ReconstructResume, AChangedPictureRepeatsWhatDependsOnIt) {
  write_good(6, true);
  ASSERT_EQ(waymark(words("a", {"--work", folder_ / "work", "--until", "poses"})).code, 0);
  for (unsigned char& grey : pictures_[2].grey) grey = static_cast<unsigned char>(grey / 2 + 20);
  write_good(6, true);
  ASSERT_EQ(waymark(words("a", {"--work", folder_ / "work", "--until", "poses"})).code, 0);
  EXPECT_THAT(kept("find_features"), SizeIs(7));
  EXPECT_THAT(kept("match_images"), SizeIs(2));
  EXPECT_THAT(kept("georeference"), SizeIs(2));
}

TEST_F(ReconstructResume, WarningsAreRepeated) {
  write_good(5, true);
  PhotoExif far = positions_[5];
  *far.lat += 0.01;  // a kilometre
  write_photo(image(names_[5]), pictures_[5], far);
  const std::vector<std::string> run{"reconstruct",   folder_ / "images", "-o",
                                     folder_ / "out", "--until",          "poses",
                                     "--work",        folder_ / "work"};
  const Outcome first = waymark(run), second = waymark(run);
  EXPECT_THAT(first.err, testing::HasSubstr("warning"));
  EXPECT_EQ(first.err, second.err);
}

}  // namespace
}  // namespace waymark::test
