// Runs the built program as a child process, in a folder of its own.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace brume {

struct Outcome {
  int exit_code = -1;  ///< 128 + the signal that ended the program
  std::string out, err;

  bool error_says(const std::string& text) const { return err.find(text) != std::string::npos; }
};

inline std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void put_file(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// A started program. wait() must be called.
class Child {
 public:
  /// @param file_size_limit  bytes that a file may grow to: the same as a full disk
  Child(const std::vector<std::string>& arguments, const std::string& folder,
        std::optional<rlim_t> file_size_limit = {})
      : out_(folder + "/stdout.txt"), err_(folder + "/stderr.txt") {
    std::vector<std::string> words{BRUME_EXECUTABLE};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    pid_ = fork();
    if (pid_ != 0) return;
    // The child: only what is safe between fork and exec.
    if (chdir(folder.c_str()) != 0) _exit(126);
    const int out = open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const int err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    const int none = open("/dev/null", O_RDONLY);
    dup2(none, STDIN_FILENO), dup2(out, STDOUT_FILENO), dup2(err, STDERR_FILENO);
    if (file_size_limit) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{*file_size_limit, *file_size_limit};
      setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(argv[0], argv.data());
    _exit(127);
  }

  pid_t pid() const { return pid_; }

  /// Whether the program has a handler of its own for the signal by now.
  bool handles(int signal) const {
    std::ifstream status("/proc/" + std::to_string(pid_) + "/status");
    std::string key, value;
    while (status >> key && std::getline(status, value))
      if (key == "SigCgt:") return std::stoull(value, nullptr, 16) >> (signal - 1) & 1;
    return false;
  }

  Outcome wait() const {
    int status = 0;
    waitpid(pid_, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), content_of(out_), content_of(err_)};
  }

 private:
  std::string out_, err_;
  pid_t pid_ = -1;
};

/// A test with a folder of its own, which is also the program's current one.
class ProgramTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "brume_cli_XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    put_file(path("scene.json"), kScene);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
  Outcome run(const std::vector<std::string>& arguments) const { return Child(arguments, folder_).wait(); }

  /// The arguments fail with exit code 2 and exactly one line on stderr, which holds `text`.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& text) const {
    const Outcome o = run(arguments);
    std::string line;
    for (const std::string& a : arguments) line += a + " ";
    EXPECT_EQ(o.exit_code, 2) << line << o.err;
    EXPECT_TRUE(o.error_says(text)) << line << "\n" << o.err << "expected: " << text;
    EXPECT_TRUE(o.err.starts_with("brume: error: ")) << o.err;
    EXPECT_EQ(o.err.find('\n'), o.err.size() - 1) << o.err;
    EXPECT_EQ(o.out, "");
  }

  /// A grey box of optical depth 1 across, lit from above and by a lamp outside.
  static constexpr const char* kScene = R"({ "brume": 1,
  "camera": {"position": [0, -6, 0], "look_at": [0, 0, 0]},
  "film": {"resolution": [32, 24]},
  "render": {"bounces": 1},
  "volumes": [{"name": "fog", "shader": "homogeneous", "density_scale": 0.5, "albedo": [0.8, 0.8, 0.8],
               "bounds": {"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]}, "phase": {"type": "isotropic"}}],
  "lights": [{"name": "sun", "type": "directional", "direction": [0, 0, -1], "irradiance": [3, 2, 1]},
             {"name": "lamp", "type": "point", "position": [0, 0, 2], "intensity": [5, 5, 5]}]})";

 private:
  std::string folder_;
};

}  // namespace brume
