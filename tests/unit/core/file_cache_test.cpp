#include "renderer/core/file_cache.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

namespace brume {
namespace {

namespace fs = std::filesystem;

class FileCacheTest : public testing::Test {
 protected:
  using Text = std::shared_ptr<const std::string>;

  void SetUp() override {
    std::string pattern = testing::TempDir() + "brume_cache_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Writes a file whose time of change is `hour` hours after all files' first: no test waits for the clock to tick.
  void put(const std::string& name, const std::string& text, int hour) const {
    std::ofstream(path(name), std::ios::binary) << text;
    fs::last_write_time(path(name), fs::file_time_type(std::chrono::hours(hour)));
  }

  Result<Text> load(const std::string& name) {
    return cache_.load(path(name), [this](const std::string& p) -> Result<Text> {
      ++reads_;
      std::ifstream file(p, std::ios::binary);
      std::string text{std::istreambuf_iterator<char>(file), {}};
      if (!file.is_open() || text == "broken") return bad_input("cannot read", {p, 0, 0, ""});
      return std::make_shared<const std::string>(std::move(text));
    });
  }

  fs::path folder_;
  FileCache<std::string> cache_;
  std::atomic<int> reads_ = 0;
};

TEST_F(FileCacheTest, AFileIsReadOnce) {
  put("a", "one", 0), put("b", "two", 0);
  const auto first = load("a"), again = load("a"), other = load("b");
  ASSERT_TRUE(first.ok() && again.ok() && other.ok());
  EXPECT_EQ(**first, "one");
  EXPECT_EQ(**other, "two");
  EXPECT_EQ(*first, *again) << "the very same object";
  EXPECT_EQ(reads_, 2);
}

TEST_F(FileCacheTest, AChangedFileIsReadAgainAndTheOldValueLivesOnWithItsHolders) {
  put("a", "one", 1);
  const auto first = load("a");
  put("a", "changed", 2);
  const auto second = load("a");
  ASSERT_TRUE(first.ok() && second.ok());
  EXPECT_EQ(**first, "one");
  EXPECT_EQ(**second, "changed");
  put("a", "from a backup", 0);  // an older time is a change, too
  EXPECT_EQ(**load("a"), "from a backup");
  EXPECT_EQ(**load("a"), "from a backup");
  EXPECT_EQ(reads_, 3);
}

TEST_F(FileCacheTest, ErrorsAreNotKept) {
  const auto missing = load("a");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().source.file, path("a"));
  EXPECT_FALSE(load("a").ok());
  EXPECT_EQ(reads_, 2) << "asked again, as it may have come into being";
  put("a", "broken", 1);
  EXPECT_FALSE(load("a").ok());
  put("a", "whole", 1);  // the same time: an error has none to compare with
  const auto whole = load("a");
  ASSERT_TRUE(whole.ok());
  EXPECT_EQ(**whole, "whole");
  EXPECT_EQ(reads_, 4);
}

TEST_F(FileCacheTest, AFileThatBecameUnreadableIsAnErrorAndNotItsOldValue) {
  put("a", "one", 1);
  ASSERT_TRUE(load("a").ok());
  put("a", "broken", 2);
  EXPECT_FALSE(load("a").ok());
  EXPECT_FALSE(load("a").ok());
  fs::remove(path("a"));
  EXPECT_FALSE(load("a").ok());
  put("a", "two", 3);
  EXPECT_EQ(**load("a"), "two");
}

TEST_F(FileCacheTest, DropUnusedForgetsWhatNobodyElseHolds) {
  put("held", "one", 0), put("free", "two", 0);
  const auto held = load("held");
  std::weak_ptr<const std::string> free = *load("free");
  EXPECT_FALSE(load("missing").ok());
  EXPECT_FALSE(free.expired()) << "kept by the cache";
  cache_.drop_unused();
  EXPECT_TRUE(free.expired());
  EXPECT_EQ(reads_, 3);
  EXPECT_EQ(*load("held"), *held);
  EXPECT_EQ(reads_, 3) << "held and still known";
  EXPECT_EQ(**load("free"), "two");
  EXPECT_EQ(reads_, 4);
}

TEST_F(FileCacheTest, ThreadsThatAskAtTheSameTimeShareOneReading) {
  put("a", "one", 0);
  std::vector<Text> got(8);
  std::vector<std::thread> threads;
  for (Text& mine : got) threads.emplace_back([&] { mine = *load("a"); });
  for (std::thread& t : threads) t.join();
  for (const Text& text : got) EXPECT_EQ(text, got[0]);
  EXPECT_EQ(reads_, 1);
}

}  // namespace
}  // namespace brume
