// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <sys/resource.h>
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>
namespace waymark::test {

/// A folder that is gone when the test ends.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(TempFolder&&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Of a file in it.
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

/// How a program ended and what it said.
struct Outcome {
  int code = -1;  ///< 128 + signal where it was killed
  std::string out, err;
};

/// Runs the built program with these words after its name.
Outcome waymark(const std::vector<std::string>& words);
/// Runs a line of bash in which $WAYMARK is the program.
Outcome bash(const std::string& line);

/// Starts the program and does not wait; nothing it says is kept.
pid_t start_waymark(const std::vector<std::string>& words);
/// Runs the program, which must succeed, and returns what it took.
rusage usage_of_waymark(const std::vector<std::string>& words);

/// Exit code of view_browser.py where there is no Chromium.
inline constexpr int kNoBrowser = 77;

std::string text_of(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace waymark::test
