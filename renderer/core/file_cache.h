// Things read from files, each read once.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "renderer/core/error.h"

namespace brume {

/// Keeps what was read from every file, as long as the file does not change. Any thread; a second thread that asks
/// while a file is being read waits for it.
template <class T> class FileCache {
 public:
  /// @param read  Result<std::shared_ptr<const T>>(path).  @param part  of the file, where it holds several
  template <class Read>
  Result<std::shared_ptr<const T>> load(const std::string& path, const Read& read, const std::string& part = "") {
    const std::lock_guard lock(mutex_);
    std::error_code no_file;  // a missing file is reported by `read`, in better words
    const auto modified = std::filesystem::last_write_time(path, no_file).time_since_epoch().count();
    Entry& entry = entries_[{path, part}];
    if (entry.value && entry.modified == modified) return entry.value;
    auto value = read(path);
    if (value) entry = {*value, modified};
    return value;
  }

  /// Forgets what nobody else holds.
  void drop_unused() {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const auto& e) { return e.second.value.use_count() <= 1; });
  }

 private:
  struct Entry {
    std::shared_ptr<const T> value;
    std::int64_t modified = 0;
  };
  std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Entry> entries_;
};

}  // namespace brume
