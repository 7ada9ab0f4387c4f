#include "renderer/core/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace brume {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "brume_atomic_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// While it lives, no file of this process can grow beyond `bytes`: the same as a full disk, but harmless.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int);
};

TEST_F(AtomicFile, HoldsExactlyTheGivenBytes) {
  const std::string bytes("a\0b\r\n\xff", 6);
  ASSERT_TRUE(write_text_atomically(path("new.bin"), bytes));
  EXPECT_EQ(content(path("new.bin")), bytes);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, MayBeEmpty) {
  put(path("old"), "something");
  ASSERT_TRUE(write_text_atomically(path("old"), ""));
  EXPECT_EQ(content(path("old")), "");
}

TEST_F(AtomicFile, ReplacesAFileAndKeepsItsPermissions) {
  put(path("old"), "long old content");
  ASSERT_EQ(chmod(path("old").c_str(), 0640), 0);
  ASSERT_TRUE(write_text_atomically(path("old"), "new"));
  EXPECT_EQ(content(path("old")), "new");
  struct stat status {};
  ASSERT_EQ(stat(path("old").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST_F(AtomicFile, NewFilesHaveThePermissionsOfAnyNewFile) {
  put(path("ordinary"), "");
  ASSERT_TRUE(write_text_atomically(path("atomic"), "x"));
  EXPECT_EQ(fs::status(path("atomic")).permissions(), fs::status(path("ordinary")).permissions());
}

TEST_F(AtomicFile, OldContentIsSeenUntilTheWriterIsDone) {
  put(path("old"), "old");
  std::string seen, temporary_folder;
  ASSERT_TRUE(write_file_atomically(path("old"), [&](const std::string& temporary) -> Result<void> {
    put(temporary, "new");
    seen = content(path("old"));
    temporary_folder = fs::path(temporary).parent_path().string();
    return {};
  }));
  EXPECT_EQ(seen, "old");
  EXPECT_EQ(temporary_folder, folder_.string());
  EXPECT_EQ(content(path("old")), "new");
}

TEST_F(AtomicFile, FailedWriterLeavesTheOldFileAndNothingElse) {
  put(path("old"), "old");
  const Result<void> result = write_file_atomically(path("old"), [](const std::string& temporary) -> Result<void> {
    put(temporary, "half");
    return bad_input("the writer's own reason");
  });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "the writer's own reason");
  EXPECT_EQ(content(path("old")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, ThrowingWriterBecomesAnError) {
  put(path("old"), "old");
  const Result<void> result = write_file_atomically(
      path("old"), [](const std::string&) -> Result<void> { throw std::runtime_error("out of ink"); });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().to_string(), path("old") + ": cannot write this file: out of ink");
  EXPECT_EQ(content(path("old")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, FullDiskLeavesTheOldFileAndNothingElse) {
  put(path("old"), "old");
  Result<void> result;
  {
    const FileSizeLimit limit(1000);
    result = write_text_atomically(path("old"), std::string(100000, 'x'));
  }
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("File too large"), std::string::npos) << result.error().to_string();
  EXPECT_EQ(result.error().source.file, path("old"));
  EXPECT_EQ(content(path("old")), "old");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, ErrorNamesThePathAndTheSystemsReason) {
  const std::string missing = path("no/such/folder/file.txt");
  const Result<void> result = write_text_atomically(missing, "x");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::BadInput);
  EXPECT_EQ(result.error().to_string(), missing + ": cannot write this file: No such file or directory");
}

TEST_F(AtomicFile, FileInPlaceOfAFolderIsAnError) {
  put(path("file"), "x");
  const Result<void> result = write_text_atomically(path("file") + "/inside", "x");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("Not a directory"), std::string::npos) << result.error().message;
}

TEST_F(AtomicFile, FolderIsNotReplaced) {
  fs::create_directory(path("folder"));
  EXPECT_FALSE(write_text_atomically(path("folder"), "x"));
  EXPECT_TRUE(fs::is_directory(path("folder")));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, PipesAndDevicesAreNotReplaced) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_FALSE(write_text_atomically(path("pipe"), "x"));
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(AtomicFile, EmptyPathIsAnError) {
  EXPECT_FALSE(write_text_atomically("", "x"));
  EXPECT_FALSE(write_text_atomically(std::string("a\0b", 3), "x"));
}

TEST_F(AtomicFile, SymbolicLinkIsFollowed) {
  fs::create_directory(path("elsewhere"));
  put(path("elsewhere/target"), "old");
  fs::create_symlink("elsewhere/target", path("link"));
  ASSERT_TRUE(write_text_atomically(path("link"), "new"));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content(path("elsewhere/target")), "new");
}

TEST_F(AtomicFile, NameMayBeNonAsciiAndAsLongAsTheSystemAllows) {
  const std::string name = "Nebel über Zürich 雲 ☁.txt";
  ASSERT_TRUE(write_text_atomically(path(name), "x"));
  EXPECT_EQ(content(path(name)), "x");
  const std::string longest(255, 'n');
  ASSERT_TRUE(write_text_atomically(path(longest), "y"));
  EXPECT_EQ(content(path(longest)), "y");
}

TEST_F(AtomicFile, NameWithoutFolderIsInTheWorkingFolder) {
  const std::string name = "brume_atomic_file_test_" + std::to_string(getpid()) + ".txt";
  ASSERT_TRUE(write_text_atomically(name, "here"));
  EXPECT_EQ(content((fs::current_path() / name).string()), "here");
  fs::remove(name);
}

TEST_F(AtomicFile, WritersAtTheSameTimeLeaveOneCompleteFile) {
  constexpr int kWriters = 4, kRounds = 20;
  constexpr std::size_t kLength = 50000;
  put(path("shared"), std::string(kLength, '.'));
  std::vector<int> failures(kWriters), torn(kWriters);
  std::vector<std::thread> threads;
  for (int writer = 0; writer < kWriters; ++writer)
    threads.emplace_back([&, writer] {
      const auto own = static_cast<std::size_t>(writer);
      for (int round = 0; round < kRounds; ++round) {
        if (!write_text_atomically(path("shared"), std::string(kLength, static_cast<char>('a' + writer))))
          ++failures[own];
        const std::string seen = content(path("shared"));
        if (seen.size() != kLength || seen.find_first_not_of(seen[0]) != std::string::npos) ++torn[own];
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failures, std::vector<int>(kWriters));
  EXPECT_EQ(torn, std::vector<int>(kWriters));
  EXPECT_EQ(file_count(), 1u);
}

}  // namespace
}  // namespace brume
