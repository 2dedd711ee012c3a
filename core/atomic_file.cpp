// SPDX-License-Identifier: Apache-2.0
#include "core/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/error.hpp"
#include "core/output_error.hpp"

namespace waymark::inline core {
namespace {

namespace fs = std::filesystem;

/// Descriptor that is closed by the destructor.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags, ::mode_t mode = 0)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }
  /// Returns 0 or an errno; some file systems report late errors only here.
  int close() { return ::close(std::exchange(number_, -1)) == 0 ? 0 : errno; }

 private:
  int number_;
};

/// Flushes a file or folder. Some file systems cannot flush folders.
void flush(const fs::path& path, const fs::path& output) {
  const Descriptor file(path, O_RDONLY);
  if (!file.is_open()) fail_output(output, errno);
  if (::fsync(file.number()) != 0 && errno != EINVAL && errno != ENOTSUP) fail_output(output, errno);
}

void rename_or_fail(const fs::path& from, const fs::path& to, const fs::path& output) {
  if (::rename(from.c_str(), to.c_str()) != 0) fail_output(output, errno);
}

int write_whole(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ::ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return errno;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// Returns the file that a symbolic link stands for, whether it exists or not.
fs::path follow_links(fs::path path) {
  std::error_code unknown;
  for (int link = 0; link < 40 && fs::is_symlink(path, unknown); ++link)
    path = folder_of(path) / fs::read_symlink(path, unknown);
  return path;
}

bool is_stream(const fs::path& path) {
  std::error_code unknown;
  const fs::file_type type = fs::status(path, unknown).type();
  return type == fs::file_type::fifo || type == fs::file_type::character || type == fs::file_type::socket;
}

void copy_to_stream(const fs::path& from, const fs::path& to) {
  const Descriptor in(from, O_RDONLY), out(to, O_WRONLY);
  if (!in.is_open() || !out.is_open()) fail_output(to, errno);
  std::array<char, 1 << 16> piece;
  for (;;) {
    const ::ssize_t got = ::read(in.number(), piece.data(), piece.size());
    if (got < 0) fail_output(to, errno);
    if (got == 0) return;
    if (const int failed = write_whole(out.number(), {piece.data(), static_cast<std::size_t>(got)}))
      fail_output(to, failed);
  }
}

// How a set is moved. Everything is in a locked folder beside the targets, which is at any time in one state:
//   new/     being written: dropped if the process is dead
//   ready/   complete and flushed: older data sets that a rename cannot replace are removed
//   moving/  the rest of it is moved
// Each step may be repeated, so a dead process's set is finished by the next one.
constexpr const char *kNew = "new", *kReady = "ready", *kMoving = "moving";

/// Files that carry one data set together with a main file of the same stem. Readers open the main file.
struct FileFamily {
  std::string_view main;
  std::vector<std::string_view> others;
};

const std::vector<FileFamily>& file_families() {
  static const std::vector<FileFamily> all = {
      {".shp", {".shx", ".dbf", ".prj", ".cpg", ".qix", ".sbn", ".sbx", ".idm", ".ind", ".qpj", ".shp.xml"}},
      {".tab", {".dat", ".map", ".id", ".ind"}},
      {".mif", {".mid"}}};
  return all;
}

bool is_main_file(const fs::path& file) {
  return std::ranges::find(file_families(), file.extension().string(), &FileFamily::main) !=
         file_families().end();
}

/// Returns whether a folder is one data set, not a folder of files.
bool is_data_set(const fs::path& folder) {
  return folder.extension() == ".gdb";
}

/// Returns the entries of a folder, main files last.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries(fs::directory_iterator(folder), {});
  std::ranges::sort(entries);
  std::stable_partition(entries.begin(), entries.end(),
                        [](const fs::path& file) { return !is_main_file(file); });
  return entries;
}

/// Throws before anything has changed if a folder stands where a file goes, or the other way round.
void check_targets(const fs::path& from, const fs::path& to, const fs::path& output) {
  for (const fs::path& entry : entries_of(from)) {
    const fs::path target = to / entry.filename();
    std::error_code unknown;
    const fs::file_status old = fs::status(target, unknown);
    if (!fs::exists(old)) continue;
    if (fs::is_directory(entry) != fs::is_directory(old))
      fail_output(
          fs::is_directory(entry) ? output : target,
          fs::is_directory(old) ? "it is a folder" : "a file has the name of its folder " + target.string());
    if (fs::is_directory(entry) && !is_data_set(entry)) check_targets(entry, target, output);
  }
}

void flush_all(const fs::path& folder, const fs::path& output) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) flush(entry.path(), output);
  flush(folder, output);
}

/// Removes older data sets, the main file first, so that there is none rather than parts of two.
void remove_older(const fs::path& from, const fs::path& to) {
  for (const fs::path& entry : entries_of(from)) {
    const fs::path target = to / entry.filename();
    std::error_code ignored;  // what cannot be removed cannot be replaced either, which fails later
    if (fs::is_directory(entry)) {
      if (is_data_set(entry))
        fs::remove_all(target, ignored);
      else
        remove_older(entry, target);
    } else if (is_main_file(entry)) {
      fs::remove(target, ignored);
      for (const std::string_view other :
           std::ranges::find(file_families(), entry.extension().string(), &FileFamily::main)->others)
        fs::remove(fs::path(target).replace_extension(other), ignored);
    }
  }
}

void move_all(const fs::path& from, const fs::path& to, const fs::path& output) {
  for (const fs::path& entry : entries_of(from)) {
    const fs::path target = to / entry.filename();
    if (fs::is_directory(entry) && !is_data_set(entry)) {
      std::error_code failed;
      fs::create_directory(target, failed);
      if (failed) fail_output(output, failed.message());
      move_all(entry, target, output);
    } else {
      rename_or_fail(entry, target, output);
    }
  }
  flush(to, output);
}

/// Finishes the commit of a set; does nothing for what is not complete.
void finish_set(const fs::path& aside, const fs::path& folder, const fs::path& output) {
  if (!fs::exists(aside / kReady) && !fs::exists(aside / kMoving)) return;
  const Descriptor turn(folder, O_RDONLY | O_DIRECTORY);  // one set after another
  if (turn.is_open()) ::flock(turn.number(), LOCK_EX);
  if (fs::exists(aside / kReady)) {
    remove_older(aside / kReady, folder);
    flush(folder, output);
    rename_or_fail(aside / kReady, aside / kMoving, output);
  }
  move_all(aside / kMoving, folder, output);
}

void check_is_folder(const fs::path& folder, const fs::path& output) {
  std::error_code unknown;
  if (!fs::is_directory(folder, unknown))
    throw Error(ErrorCode::output,
                "cannot write " + output.filename().string() + ": its folder does not exist", folder.string(),
                "create the folder, or write elsewhere");
}

fs::path checked_target(const fs::path& output) {
  const fs::path target = follow_links(output);
  check_is_folder(folder_of(target), output);
  std::error_code unknown;
  if (fs::is_directory(target, unknown)) fail_output(output, "it is a folder");
  return target;
}

const fs::path& checked_folder(const fs::path& folder, const fs::path& output) {
  check_is_folder(folder, output);
  return folder;
}

/// Makes a folder for what is aside, and finishes or removes what dead processes left.
LockedFolder make_aside(const fs::path& folder, const fs::path& output) try {
  return LockedFolder(folder, [&](const fs::path& dead) { finish_set(dead, folder, folder); });
} catch (const fs::filesystem_error& error) {
  fail_output(output, error.code().value());
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& output)
    : output_(output),
      target_(checked_target(output)),
      is_stream_(is_stream(target_)),
      aside_(make_aside(is_stream_ ? fs::temp_directory_path() : folder_of(target_), output)),
      path_(aside_.path() / target_.filename()) {}

void AtomicFile::commit() {
  if (is_stream_) return copy_to_stream(path_, target_);
  struct stat old {};
  if (::stat(target_.c_str(), &old) == 0) ::chmod(path_.c_str(), old.st_mode & 07777);
  flush(path_, output_);
  rename_or_fail(path_, target_, output_);
  flush(folder_of(target_), output_);
}

AtomicFileSet::AtomicFileSet(fs::path folder, fs::path output)
    : folder_(std::move(folder)),
      output_(std::move(output)),
      aside_(make_aside(checked_folder(folder_, output_), output_)),
      path_(aside_.path() / kNew) {
  std::error_code failed;
  fs::create_directory(path_, failed);
  if (failed) fail_output(output_, failed.value());
}

std::vector<fs::path> AtomicFileSet::commit() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path_)) files.push_back(folder_ / entry.path().filename());
  std::ranges::sort(files);
  check_targets(path_, folder_, output_);
  flush_all(path_, output_);
  rename_or_fail(path_, aside_.path() / kReady, output_);
  flush(aside_.path(), output_);
  aside_.abandon();  // older files go now: if this process ends before it is done, the next one finishes it
  finish_set(aside_.path(), folder_, output_);
  aside_.reclaim();
  return files;
}

Error with_final_path(const Error& error, const fs::path& aside, const fs::path& final_path) {
  // A library may name the whole path of what it was given from the working folder.
  const std::string& where = error.where();
  for (const std::string& name : {aside.string(), fs::absolute(aside).lexically_normal().string()})
    if (where.starts_with(name))
      return {error.code(), error.problem(), final_path.string() + where.substr(name.size()), error.hint()};
  return error;
}

int write_aside(const fs::path& file, std::string_view content) {
  Descriptor out(file, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (!out.is_open()) return errno;
  if (const int failed = write_whole(out.number(), content)) return failed;
  return out.close();
}

void write_file(const fs::path& output, std::string_view content) {
  AtomicFile file(output);
  if (const int failed = write_aside(file.path(), content)) fail_output(output, failed);
  file.commit();
}

}  // namespace waymark::inline core
