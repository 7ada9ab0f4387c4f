#include "renderer/scene_io/scene_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/unit/scene_io/test_tables.h"

namespace brume {
namespace {

namespace fs = std::filesystem;
using test_tables::studio;
using test_tables::studio_family;

/// A folder that is gone after the test.
class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "brume_scene_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string make(const std::string& name, const std::string& bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }
  std::string content(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  static std::string message(const std::string& file) {
    const auto node = read_scene_file(file, studio_family());
    return node.ok() ? "no error" : node.error().message;
  }

  fs::path folder_;
};

std::string text_error(std::string_view text) {
  const auto node = read_scene_text(text, "s.json", "/base", studio_family());
  return node.ok() ? "no error" : node.error().to_string();
}

TEST(SceneText, NeedsTheFormatVersion) {
  EXPECT_EQ(text_error("{\"brume\": 1}"), "no error");
  EXPECT_EQ(text_error("{\"film\": {}, \"brume\": 1.0}"), "no error");
  EXPECT_EQ(text_error("\n {}"), "s.json:2:2: this is not a Brume scene: expected \"brume\": 1");
  EXPECT_EQ(text_error("{\"asset\": {}}"), "s.json:1:1: this is not a Brume scene: expected \"brume\": 1");
  EXPECT_EQ(text_error("[1]"),
            "s.json:1:1: this is not a Brume scene: found a list of 1 value, expected an object with \"brume\": 1");
  EXPECT_EQ(text_error("{\"brume\": \"1\"}"), "s.json:1:11: brume: found the text \"1\", expected \"brume\": 1");
  EXPECT_EQ(text_error("{\"brume\": 0}"), "s.json:1:11: brume: found 0, expected \"brume\": 1");
  EXPECT_EQ(text_error("{\"brume\": 1.5}"), "s.json:1:11: brume: found 1.5, expected \"brume\": 1");
}

TEST(SceneText, ANewerFormatIsToldBeforeAnythingElse) {
  EXPECT_EQ(text_error("{\"hologram\": 1, \"brume\": 2}"),
            "s.json:1:26: brume: made by a newer Brume (format 2, this one reads 1)");
}

TEST(SceneText, OtherErrorsKeepTheirPlaces) {
  EXPECT_EQ(text_error("{\"brume\": 1,\n \"flim\": {}}"),
            "s.json:2:2: flim: unknown key \"flim\"; did you mean film? (valid: film, volumes, lights)");
  EXPECT_EQ(text_error("{\"brume\": 1,}"), "s.json:1:12: found a comma before }, expected none behind the last member");
}

TEST(SceneText, WritesTheVersionFirst) {
  EXPECT_EQ(*write_scene_text(studio(), "/base"), "{\n  \"brume\": 1\n}\n");
  Node s = studio();
  ASSERT_TRUE(s.child("film").set("exposure", 1.0).ok());
  EXPECT_EQ(*write_scene_text(s, "/base"), "{\n  \"brume\": 1,\n  \"film\": {\"exposure\": 1}\n}\n");
}

TEST(SceneText, EveryTruncationIsAnErrorAndNoCrash) {
  const std::string text =
      R"({ "brume": 1, // scene
  "film": {"resolution": [640, 480]},
  "volumes":[{"name": "plume", "shader": "vdb", "file": "smoke.vdb", "density_scale": 2e1, "step": "auto",
              "albedo": [0.9, 0.9, 0.9], "phase": {"type": "lobe", "g": -0.2}}],
  "lights": [{"name": "key", "type": "point", "position": [3, 1, 3], "intensity": 40}]})";
  ASSERT_EQ(text_error(text), "no error");
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto node = read_scene_text(text.substr(0, n), "s.json", "/base", studio_family());
    ASSERT_FALSE(node.ok()) << n;
    EXPECT_GE(node.error().source.line, 1);
    EXPECT_GE(node.error().source.column, 1);
  }
}

TEST_F(SceneFile, ReadsWhatItWrote) {
  Node s = studio();
  s.list("volumes").emplace_back(*test_tables::volume_family().tables[0]);
  ASSERT_TRUE(s.list("volumes")[0].set("file", path("smoke.vdb")).ok());
  ASSERT_TRUE(s.list("volumes")[0].set("fire", std::string("/far/away/fire.vdb")).ok());
  ASSERT_TRUE(write_scene_file(path("a.json"), s).ok());
  EXPECT_NE(content("a.json").find("\"file\": \"smoke.vdb\""), std::string::npos);
  const auto again = read_scene_file(path("a.json"), studio_family());
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(*again, s);
}

TEST_F(SceneFile, AMovedFolderTakesItsFilesAlong) {
  Node s = studio();
  s.list("volumes").emplace_back(*test_tables::volume_family().tables[0]);
  fs::create_directory(path("old"));
  ASSERT_TRUE(s.list("volumes")[0].set("file", path("old/smoke.vdb")).ok());
  ASSERT_TRUE(write_scene_file(path("old/a.json"), s).ok());
  fs::rename(path("old"), path("new"));
  const auto again = read_scene_file(path("new/a.json"), studio_family());
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(again->list("volumes")[0].text("file"), path("new/smoke.vdb"));
}

TEST_F(SceneFile, NonAsciiPathsWork) {
  const std::string name = "h\xC3\xB6he \xE7\x85\x99.json";
  ASSERT_TRUE(write_scene_file(path(name), studio()).ok());
  const auto again = read_scene_file(path(name), studio_family());
  ASSERT_TRUE(again.ok()) << again.error().to_string();
  EXPECT_EQ(*again, studio());
}

TEST_F(SceneFile, RelativePathsStartFromTheFolderOfTheFile) {
  make("a.json", R"({"brume": 1, "volumes": [{"file": "sub/../smoke.vdb"}]})");
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  const auto node = read_scene_file("a.json", studio_family());
  fs::current_path(before);
  ASSERT_TRUE(node.ok()) << node.error().to_string();
  EXPECT_EQ(fs::path(node->list("volumes")[0].text("file")).filename(), "smoke.vdb");
  EXPECT_TRUE(fs::path(node->list("volumes")[0].text("file")).is_absolute());
}

TEST_F(SceneFile, SaysClearlyWhatIsNoScene) {
  using namespace std::string_literals;
  EXPECT_EQ(message(path("missing.json")), "this file does not exist");
  EXPECT_EQ(message(path("missing/a.json")), "this file does not exist");
  EXPECT_EQ(message(folder_.string()), "this is a folder, expected a scene file");
  EXPECT_EQ(message(make("empty.json", "")), "this file is empty, expected a scene");
  EXPECT_EQ(message(make("blank.json", " \n")), "found nothing, expected a value");
  EXPECT_EQ(message(make("smoke.vdb", " BDV\0\0\0\0\xE0\0\0\0 and so on"s)),
            "this is an OpenVDB file, expected a scene, which names such a file in a volume");
  EXPECT_EQ(message(make("picture.png", "\x89PNG\r\n\x1A\n\0\0\0\rIHDR"s)),
            "this is not a text file, expected a scene");
  EXPECT_EQ(message(make("late.json", "{\"brume\": 1}"s + std::string(100000, ' ') + '\0')),
            "this is not a text file, expected a scene");
  EXPECT_EQ(message(make("utf16.json", "\xFF\xFE{\0}\0"s)), "found UTF-16, expected UTF-8; save the file as UTF-8");
  EXPECT_EQ(message(make("huge.json", std::string((16u << 20) + 1, ' '))),
            "this file is larger than 16 MB, too large for a scene");
  EXPECT_EQ(message(make("model.obj", "v 0 0 0\n")), "found \"v\", expected a value; texts stand in double quotes");
  EXPECT_EQ(message(""), "found an empty file name, expected the path of a scene");
  EXPECT_EQ(message(make("part", "{}") + "/a.json"), "this file does not exist");
  EXPECT_EQ(message(path(std::string(300, 'x'))), "cannot read this file: File name too long");
}

TEST_F(SceneFile, ErrorsNameTheFile) {
  const std::string file = make("a.json", "{\"brume\": 1,\n \"film\": 5}");
  const auto node = read_scene_file(file, studio_family());
  ASSERT_FALSE(node.ok());
  EXPECT_EQ(node.error().to_string(), file + ":2:10: film: found 5, expected an object in braces");
  EXPECT_EQ(read_scene_file(path("missing.json"), studio_family()).error().to_string(),
            path("missing.json") + ": this file does not exist");
}

TEST_F(SceneFile, UnreadableFilesAreToldApart) {
  if (::geteuid() == 0) GTEST_SKIP() << "root reads everything";
  const std::string file = make("secret.json", "{\"brume\": 1}");
  ::chmod(file.c_str(), 0);
  EXPECT_EQ(message(file), "cannot read this file: Permission denied");
}

TEST_F(SceneFile, ReadsFromAPipe) {
  const std::string pipe = path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << "{\"brume\": 1}"; });
  EXPECT_EQ(message(pipe), "no error");
  writer.join();
}

TEST_F(SceneFile, TextsThatAreNotUtf8AreRefusedAndNothingIsWritten) {
  Node s = studio();
  s.list("volumes").emplace_back(*test_tables::volume_family().tables[0]);
  ASSERT_TRUE(s.list("volumes")[0].set("file", std::string("/base/h\xF6he.vdb")).ok());
  const auto done = write_scene_file(path("a.json"), s);
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().source.file, path("a.json"));
  EXPECT_EQ(done.error().source.key, "volumes[0].file");
  EXPECT_FALSE(fs::exists(path("a.json")));
}

TEST_F(SceneFile, WritingIntoAMissingFolderIsAnError) {
  const auto done = write_scene_file(path("missing/a.json"), studio());
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().source.file, path("missing/a.json"));
}

}  // namespace
}  // namespace brume
