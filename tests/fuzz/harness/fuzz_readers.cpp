// SPDX-License-Identifier: Apache-2.0
// libFuzzer's harness of every reader: WAYMARK_FUZZ_READER names one (tests/fuzz/readers.cpp). A refusal is
// an Error with a sound message; all else is a fault, on which the fuzzer ends and keeps the input.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "core/atomic_file.hpp"
#include "core/locked_folder.hpp"
#include "tests/fuzz/readers.hpp"
#include "tests/support/reader_faults.hpp"

namespace waymark::test {
namespace {

[[noreturn]] void end(const std::string& fault) {
  std::fprintf(stderr, "fault: %s\n", fault.c_str());
  std::abort();
}

const Reader& reader() {
  static const Reader& chosen = [&]() -> const Reader& {
    const char* name = std::getenv("WAYMARK_FUZZ_READER");
    for (const Reader& one : readers())
      if (name != nullptr && one.name == name) return one;
    std::fprintf(stderr, "WAYMARK_FUZZ_READER is one of:\n");
    for (const Reader& one : readers()) std::fprintf(stderr, "%s\n", one.name.c_str());
    std::exit(2);
  }();
  return chosen;
}

/// Folder in memory that holds the input and what stands beside it.
const std::filesystem::path& folder() {
  static const LockedFolder made("/dev/shm");
  static const bool ready = [] {
    for (const auto& [name, content] : reader().beside)
      if (write_aside(made.path() / name, content) != 0) end("cannot write to " + made.path().string());
    return true;
  }();
  static_cast<void>(ready);
  return made.path();
}

}  // namespace
}  // namespace waymark::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace waymark::test;
  const std::filesystem::path path = folder() / reader().file;
  const std::string_view content(reinterpret_cast<const char*>(bytes), size);
  if (waymark::write_aside(path, content) != 0) end("cannot write " + path.string());
  try {
    reader().read(path.string());
  } catch (const waymark::Error& error) {
    if (const std::string fault = fault_of_text(error, content); !fault.empty()) end(fault);
  } catch (const std::exception& error) {
    end(std::string("a foreign exception: ") + error.what());
  }
  return 0;
}
