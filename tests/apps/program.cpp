// SPDX-License-Identifier: Apache-2.0
#include "program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

namespace waymark::test {
namespace {

[[noreturn]] void become(const std::vector<std::string>& words, const std::string& out,
                         const std::string& err) {
  const auto redirect = [](const std::string& file, int descriptor) {
    dup2(open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), descriptor);
  };
  redirect(out, STDOUT_FILENO);
  redirect(err, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const auto& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

Outcome run(const std::vector<std::string>& words) {
  const TempFolder folder;
  const std::string out = folder / "out", err = folder / "err";
  const pid_t child = fork();
  if (child == 0) become(words, out, err);
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out), text_of(err)};
}

std::vector<std::string> after_program(std::vector<std::string> words) {
  words.insert(words.begin(), WAYMARK_PROGRAM);
  return words;
}

}  // namespace

TempFolder::TempFolder() {
  std::string pattern = testing::TempDir() + "/waymark_XXXXXX";
  path_ = mkdtemp(pattern.data());
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Outcome waymark(const std::vector<std::string>& words) {
  return run(after_program(words));
}

Outcome bash(const std::string& line) {
  setenv("WAYMARK", WAYMARK_PROGRAM, 1);
  return run({"/bin/bash", "-c", line});
}

pid_t start_waymark(const std::vector<std::string>& words) {
  const pid_t child = fork();
  if (child == 0) become(after_program(words), "/dev/null", "/dev/null");
  return child;
}

rusage usage_of_waymark(const std::vector<std::string>& words) {
  const pid_t process = start_waymark(words);
  int status = 0;
  rusage usage{};
  EXPECT_EQ(::wait4(process, &status, 0, &usage), process);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << words[0];
  return usage;
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace waymark::test
