// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "pipeline/engine/artifact.hpp"
#include "pipeline/engine/port.hpp"
namespace waymark::pipeline {

/// Step of a workflow whose result is kept: what a Unit is to a stage.
struct KeptStep {
  std::string name;        ///< [a-z][a-z0-9_]*: the folder of its results
  std::string item;        ///< "all", or the name of an image or chunk
  int version = 1;         ///< raised when the same input gives another result
  std::string depends_on;  ///< bytes of all that determines the result

  /// Returns what identifies the result: the start of the SHA-256 of all members.
  std::string fingerprint() const;
};

/// Results of steps in a work folder, so that a workflow that was killed goes on where it was. The steps are
/// no stages, since they run inside one process; the folder is an ArtifactStore. Thread-safe.
class KeptResults {
 public:
  /// `folder` empty: nothing is kept. Throws Error{output} if it cannot be created.
  explicit KeptResults(std::filesystem::path folder);
  ~KeptResults();
  KeptResults(KeptResults&&) noexcept;
  KeptResults& operator=(KeptResults&&) noexcept;

  bool enabled() const { return store_ != nullptr; }

  /// Returns the kept result of the step, or that of `compute`, which is then kept. Warnings that `compute`
  /// adds to its argument are kept too and returned in `warnings`.
  template <class T>
  T get(const KeptStep& step, const std::function<T(std::vector<std::string>& warnings)>& compute,
        std::vector<std::string>& warnings) const {
    const OutputPort port{Out<T>{"result"}};
    if (std::optional<Result> found = find(step, port)) {
      warnings.insert(warnings.end(), found->warnings.begin(), found->warnings.end());
      return move_or_copy<T>(std::move(found->value));
    }
    std::vector<std::string> said;
    auto made = std::make_shared<T>(compute(said));
    if (enabled()) save(step, port, {made, said});
    warnings.insert(warnings.end(), said.begin(), said.end());
    return std::move(*made);
  }
  /// The same for a step without warnings.
  template <class T>
  T get(const KeptStep& step, const std::function<T()>& compute) const {
    std::vector<std::string> none;
    return get<T>(
        step, [&](std::vector<std::string>&) { return compute(); }, none);
  }

 private:
  struct Result {
    Artifact::Value value;
    std::vector<std::string> warnings;
  };
  std::optional<Result> find(const KeptStep& step, const OutputPort& port) const;
  void save(const KeptStep& step, const OutputPort& port, const Result& result) const;

  std::unique_ptr<class ArtifactStore> store_;
};

}  // namespace waymark::pipeline
