#include "renderer/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

namespace brume {
namespace {

Error cannot_write(const std::string& path, const std::string& reason) {
  ErrorSource source;
  source.file = path;
  return bad_input("cannot write this file: " + reason, source);
}

Error cannot_write(const std::string& path, int system_error) {
  return cannot_write(path, std::generic_category().message(system_error));
}

/// An open file that closes itself; close() reports what the destructor cannot.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { close(); }

  bool ok() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  bool close() { return descriptor_ < 0 || ::close(std::exchange(descriptor_, -1)) == 0; }

 private:
  int descriptor_;
};

/// Removes the file when the scope is left, unless it was released.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  const std::string& path() const { return path_; }
  void release() { path_.clear(); }

 private:
  std::string path_;
};

/// Creates an empty file that nobody else has, in `folder`. Its short name does not depend on the final one, which may
/// already be as long as the file system allows. mkstemp() would ignore the umask.
Result<std::string> create_temporary(const std::filesystem::path& folder, const std::string& path) {
  std::random_device random;
  constexpr int kAttempts = 100;  // 64 random bits: a second attempt is already a sign of trouble
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    char name[40];
    std::snprintf(name, sizeof name, ".brume-%08x%08x.tmp", random(), random());
    const std::string candidate = (folder / name).string();
    OpenFile file(::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.ok()) return candidate;
    if (errno != EEXIST) return cannot_write(path, errno);
  }
  return cannot_write(path, EEXIST);
}

/// Waits until the data is on the disk: otherwise a power cut after the rename could leave an empty file.
Result<void> flush_to_disk(const std::string& temporary_path, const std::string& path) {
  OpenFile file(::open(temporary_path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.ok() || ::fsync(file.descriptor()) != 0 || !file.close()) return cannot_write(path, errno);
  return {};
}

Result<void> write_and_rename(const std::string& path, const std::function<Result<void>(const std::string&)>& write) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path target = path;
  if (fs::is_symlink(target, ignored)) {
    const fs::path resolved = fs::canonical(target, ignored);
    if (!ignored) target = resolved;
  }

  struct stat existing = {};
  const bool replaces = ::stat(target.c_str(), &existing) == 0;
  if (replaces && S_ISDIR(existing.st_mode)) return cannot_write(path, EISDIR);
  // rename() over a device such as /dev/null would remove it.
  if (replaces && !S_ISREG(existing.st_mode)) return cannot_write(path, "it is a device, pipe or socket");
  // A rename needs no permission on the file it replaces, but a read-only file is meant to stay.
  if (replaces && ::access(target.c_str(), W_OK) != 0) return cannot_write(path, errno);

  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  const Result<std::string> created = create_temporary(folder, path);
  if (!created) return created.error();
  TemporaryFile temporary(*created);

  if (const Result<void> written = write(temporary.path()); !written) return written;
  if (replaces && ::chmod(temporary.path().c_str(), existing.st_mode & 07777) != 0) return cannot_write(path, errno);
  if (const Result<void> flushed = flush_to_disk(temporary.path(), path); !flushed) return flushed;
  if (::rename(temporary.path().c_str(), target.c_str()) != 0) return cannot_write(path, errno);
  temporary.release();
  return {};
}

Result<void> write_all(const std::string& temporary_path, const std::string& path, std::string_view text) {
  OpenFile file(::open(temporary_path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  if (!file.ok()) return cannot_write(path, errno);
  while (!text.empty()) {
    const ssize_t count = ::write(file.descriptor(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return cannot_write(path, errno);
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  if (!file.close()) return cannot_write(path, errno);
  return {};
}

}  // namespace

Result<void> write_file_atomically(const std::string& path,
                                   const std::function<Result<void>(const std::string&)>& write) {
  if (path.empty()) return bad_input("found an empty file name, expected a path to write to");
  if (path.find('\0') != std::string::npos) return bad_input("found a zero byte in a file name, expected a path");
  try {
    return write_and_rename(path, write);
  } catch (const std::exception& exception) {
    return cannot_write(path, exception.what());
  } catch (...) {
    return cannot_write(path, "unknown exception");
  }
}

Result<void> write_text_atomically(const std::string& path, std::string_view text) {
  return write_file_atomically(
      path, [&](const std::string& temporary_path) { return write_all(temporary_path, path, text); });
}

}  // namespace brume
