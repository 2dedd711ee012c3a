// SPDX-License-Identifier: Apache-2.0
// Preloaded into the program by tests: counts the system calls that change files below WAYMARK_FAULT_FOLDER,
// and at call number WAYMARK_FAULT_AT
//   WAYMARK_FAULT=kill   kills the process,
//   WAYMARK_FAULT=interrupt  sends SIGINT to the process, whose call then does not return,
//   WAYMARK_FAULT=once   lets this call fail with EIO,
//   WAYMARK_FAULT=full   lets this and every later call fail that needs space, with ENOSPC,
//   WAYMARK_FAULT=short  lets this call write half of its bytes.
// WAYMARK_FAULT=rename lets rename number WAYMARK_FAULT_AT fail with EIO.
// WAYMARK_FAULT=slow lets every call wait as on a network, for up to WAYMARK_FAULT_WAIT microseconds, by the
// seed WAYMARK_FAULT_AT.
// WAYMARK_FAULT=read lets read number WAYMARK_FAULT_AT of files below WAYMARK_FAULT_READS fail with EIO,
// WAYMARK_FAULT=reads every later one, too.
// The numbers of calls, renames and reads are written to WAYMARK_FAULT_COUNT when the process ends.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

enum class Need { space, none };  ///< whether the call needs space on the disk

struct Plan {
  std::string folder, reads, fault;
  long at = 0;
  unsigned long wait = 1;  ///< longest wait of a slow call, microseconds
};

const Plan& plan() {
  static const Plan made = [] {
    const auto text = [](const char* name) { return std::getenv(name) ? std::getenv(name) : ""; };
    return Plan{text("WAYMARK_FAULT_FOLDER"), text("WAYMARK_FAULT_READS"), text("WAYMARK_FAULT"),
                std::atol(text("WAYMARK_FAULT_AT")),
                std::max(1UL, std::strtoul(text("WAYMARK_FAULT_WAIT"), nullptr, 10))};
  }();
  return made;
}

std::atomic<long> calls = 0, renames = 0, reads = 0;

bool is_below(const char* path, const std::string& folder = plan().folder) {
  return !folder.empty() && path != nullptr && std::strncmp(path, folder.c_str(), folder.size()) == 0;
}

bool is_below(int descriptor, const std::string& folder = plan().folder) {
  char link[64], path[PATH_MAX];
  if (folder.empty()) return false;
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const long length = ::readlink(link, path, sizeof path - 1);
  if (length < 0) return false;
  path[length] = 0;
  return is_below(path, folder);
}

/// Counts a read of a file below the folder of reads. Returns true, with errno, if it must fail.
bool read_fails(int descriptor) {
  if (!is_below(descriptor, plan().reads)) return false;
  const long number = ++reads;
  const bool failed = plan().fault == "read"    ? number == plan().at
                      : plan().fault == "reads" ? number >= plan().at
                                                : false;
  return failed && (errno = EIO, true);
}

/// Waits as a network does, by the seed and the number of the call.
void wait_for_network(long number) {
  const unsigned long mixed = static_cast<unsigned long>(number + 1000 * plan().at) * 2654435761UL;
  ::usleep(static_cast<useconds_t>(mixed / 65536 % plan().wait));
}

/// Counts a call. Returns true, with errno, if it must fail.
bool fails(Need need) {
  const long number = ++calls;
  const Plan& p = plan();
  if (p.fault == "slow") return wait_for_network(number), false;
  if (p.at == 0 || number < p.at) return false;
  if (p.fault == "kill") ::syscall(SYS_kill, ::getpid(), SIGKILL);
  if (p.fault == "interrupt" && number == p.at) {
    ::kill(::getpid(), SIGINT);
    for (;;) ::pause();
  }
  if (p.fault == "once" && number == p.at) return errno = EIO, true;
  if (p.fault == "full" && need == Need::space) return errno = ENOSPC, true;
  return false;
}

/// Returns whether the planned fault ends the process.
bool is_an_end() {
  return plan().fault == "kill" || plan().fault == "interrupt";
}

/// Counts a rename. Returns true, with errno, if it must fail.
bool rename_fails() {
  const bool failed = fails(Need::none);
  if (++renames == plan().at && plan().fault == "rename") return errno = EIO, true;
  return failed;
}

/// Returns how many bytes the call that was just counted may write.
size_t allowed(size_t count) {
  return plan().fault == "short" && calls == plan().at && count > 1 ? count / 2 : count;
}

template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

struct WriteCount {
  ~WriteCount() {
    const char* file = std::getenv("WAYMARK_FAULT_COUNT");
    if (file == nullptr) return;
    const std::string text = std::to_string(calls.load()) + ' ' + std::to_string(renames.load()) + ' ' +
                             std::to_string(reads.load());
    const long out = ::syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::syscall(SYS_write, out, text.data(), text.size());
  }
} write_count;

int open_with(const char* name, const char* path, int flags, ::mode_t mode) {
  static auto* const call = real<int(const char*, int, ...)>(name);
  if ((flags & (O_CREAT | O_TRUNC)) != 0 && is_below(path) && fails(Need::space)) return -1;
  return call(path, flags, mode);
}

::mode_t mode_of(int flags, std::va_list more) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, ::mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const ::mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_with("open", path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const ::mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_with("open64", path, flags, mode);
}
FILE* fopen64(const char* path, const char* how) {
  static auto* const call = real<FILE*(const char*, const char*)>("fopen64");
  if (how[0] != 'r' && is_below(path) && fails(Need::space)) return nullptr;
  return call(path, how);
}
FILE* fopen(const char* path, const char* how) {
  static auto* const call = real<FILE*(const char*, const char*)>("fopen");
  if (how[0] != 'r' && is_below(path) && fails(Need::space)) return nullptr;
  return call(path, how);
}
ssize_t write(int file, const void* bytes, size_t count) {
  static auto* const call = real<ssize_t(int, const void*, size_t)>("write");
  const bool below = is_below(file);
  return below && fails(Need::space) ? -1 : call(file, bytes, below ? allowed(count) : count);
}
ssize_t writev(int file, const struct iovec* parts, int count) {
  static auto* const call = real<ssize_t(int, const struct iovec*, int)>("writev");
  return is_below(file) && fails(Need::space) ? -1 : call(file, parts, count);
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t at) {
  static auto* const call = real<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  const bool below = is_below(file);
  return below && fails(Need::space) ? -1 : call(file, bytes, below ? allowed(count) : count, at);
}
ssize_t pwrite64(int file, const void* bytes, size_t count, off64_t at) {
  static auto* const call = real<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  const bool below = is_below(file);
  return below && fails(Need::space) ? -1 : call(file, bytes, below ? allowed(count) : count, at);
}
size_t fwrite(const void* bytes, size_t size, size_t count, FILE* file) {
  static auto* const call = real<size_t(const void*, size_t, size_t, FILE*)>("fwrite");
  const bool failed = is_below(::fileno(file)) && fails(Need::space);
  return failed ? 0 : call(bytes, size, count, file);  // the C library itself finishes a short write
}
ssize_t read(int file, void* bytes, size_t count) {
  static auto* const call = real<ssize_t(int, void*, size_t)>("read");
  return read_fails(file) ? -1 : call(file, bytes, count);
}
ssize_t pread(int file, void* bytes, size_t count, off_t at) {
  static auto* const call = real<ssize_t(int, void*, size_t, off_t)>("pread");
  return read_fails(file) ? -1 : call(file, bytes, count, at);
}
ssize_t pread64(int file, void* bytes, size_t count, off64_t at) {
  static auto* const call = real<ssize_t(int, void*, size_t, off64_t)>("pread64");
  return read_fails(file) ? -1 : call(file, bytes, count, at);
}
size_t fread(void* bytes, size_t size, size_t count, FILE* file) {
  static auto* const call = real<size_t(void*, size_t, size_t, FILE*)>("fread");
  return read_fails(::fileno(file)) ? 0 : call(bytes, size, count, file);
}
int fsync(int file) {
  static auto* const call = real<int(int)>("fsync");
  return is_below(file) && fails(Need::none) ? -1 : call(file);
}
int fdatasync(int file) {
  static auto* const call = real<int(int)>("fdatasync");
  return is_below(file) && fails(Need::none) ? -1 : call(file);
}
int rename(const char* from, const char* to) {
  static auto* const call = real<int(const char*, const char*)>("rename");
  return is_below(to) && rename_fails() ? -1 : call(from, to);
}
int mkdir(const char* path, mode_t mode) {
  static auto* const call = real<int(const char*, mode_t)>("mkdir");
  // A kernel says that a folder exists before it asks for space.
  const bool is_new = ::access(path, F_OK) != 0;
  return is_new && is_below(path) && fails(Need::space) ? -1 : call(path, mode);
}
char* mkdtemp(char* pattern) {
  static auto* const call = real<char*(char*)>("mkdtemp");
  return is_below(pattern) && fails(Need::space) ? nullptr : call(pattern);
}
// Only killed and interrupted here: what cannot be removed is no fault of a write.
int unlink(const char* path) {
  static auto* const call = real<int(const char*)>("unlink");
  if (is_below(path) && is_an_end()) fails(Need::none);
  return call(path);
}
int remove(const char* path) {
  static auto* const call = real<int(const char*)>("remove");
  if (is_below(path) && is_an_end()) fails(Need::none);
  return call(path);
}
int unlinkat(int folder, const char* path, int flags) {
  static auto* const call = real<int(int, const char*, int)>("unlinkat");
  if (is_below(folder) && is_an_end()) fails(Need::none);
  return call(folder, path, flags);
}

}  // extern "C"
