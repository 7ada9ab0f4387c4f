#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace brume {
namespace {

class CommandLine : public ProgramTest {};

TEST_F(CommandLine, HelpNamesEveryCommandAndExits0) {
  for (const char* flag : {"--help", "-h"}) {
    const Outcome o = run({flag});
    EXPECT_EQ(o.exit_code, 0);
    EXPECT_EQ(o.err, "");
    for (const char* word : {"render", "probe", "snapshot", "info", "schema", "docs", "Examples"})
      EXPECT_NE(o.out.find(word), std::string::npos) << word;
  }
}

TEST_F(CommandLine, HelpOfEachCommandListsItsFlags) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> flags{
      {"render",
       {"--output", "--spp", "--time", "--size", "--threads", "--seed", "--set", "--stats", "default 16", "seconds"}},
      {"probe", {"--ray", "--tmin", "--tmax", "--samples", "--seed", "--set", "independent", "world units"}},
      {"snapshot", {"--output", "--size", "--spp", "--set", "1400"}},
      {"info", {"--json"}},
      {"schema", {"Usage"}},
      {"docs", {"Usage"}}};
  for (const auto& [command, words] : flags) {
    const Outcome o = run({command, "--help"});
    EXPECT_EQ(o.exit_code, 0);
    for (const std::string& word : words) EXPECT_NE(o.out.find(word), std::string::npos) << command << ": " << word;
  }
}

TEST_F(CommandLine, VersionIsOneLine) {
  const Outcome o = run({"--version"});
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_TRUE(o.out.starts_with("brume ")) << o.out;
  EXPECT_EQ(o.out.find('\n'), o.out.size() - 1);
}

TEST_F(CommandLine, MisspeltCommandsAndFlagsAreSuggested) {
  expect_refused({"rendr", "scene.json", "-o", "a.png"}, "did you mean render?");
  expect_refused({"render", "scene.json", "-o", "a.png", "--sppp", "4"}, "did you mean --spp?");
  expect_refused({"probe", "scene.json", "--rai=0,0,0,0,0,1"}, "did you mean --ray?");
  expect_refused({"--versoin"}, "did you mean --version?");
}

TEST_F(CommandLine, UsageErrorsPointAtTheHelp) {
  expect_refused({"render", "-o", "a.png"}, "see brume render --help");
  expect_refused({"render", "scene.json"}, "see brume render --help");
  expect_refused({"probe", "scene.json"}, "see brume probe --help");
  expect_refused({"render", "scene.json", "-o", "a.png", "surplus"}, "\"surplus\"");
  expect_refused({"render", "scene.json", "-o", "a.png", "--spp"}, "--spp: expected one value; see ");
  expect_refused({"render", "scene.json", "-o", "a.png", "--spp", "2", "--spp", "3"},
                 "--spp: expected one value; see ");
  expect_refused({"probe", "scene.json", "--set"}, "--set");
  expect_refused({"schema", "surplus"}, "\"surplus\"");
}

TEST_F(CommandLine, MissingFilesAreNamed) {
  expect_refused({"missing.json"}, "missing.json");
  expect_refused({"folder/missing"}, "folder/missing");
  for (const char* name : {"missing.json", "missing.vdb", "missing.nvdb", "missing.exr", "missing.png"}) {
    expect_refused({"render", name, "-o", "a.png"}, name);
    expect_refused({"info", name}, name);
    expect_refused({"probe", name, "--ray=0,0,0,0,0,1"}, name);
  }
}

TEST_F(CommandLine, UnknownSimdLevelIsRefused) {
  setenv("BRUME_SIMD", "mmx", 1);
  expect_refused({"schema"}, "BRUME_SIMD: ");
  setenv("BRUME_SIMD", "auto", 1);
  EXPECT_EQ(run({"schema"}).exit_code, 0);
  unsetenv("BRUME_SIMD");
}

TEST_F(CommandLine, SchemaIsJsonAndDocsAreMarkdown) {
  const Outcome schema = run({"schema"});
  EXPECT_EQ(schema.exit_code, 0);
  const auto json = nlohmann::json::parse(schema.out, nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  EXPECT_TRUE(json.contains("$schema"));
  const Outcome docs = run({"docs"});
  EXPECT_EQ(docs.exit_code, 0);
  EXPECT_TRUE(docs.out.starts_with("#")) << docs.out.substr(0, 80);
  EXPECT_NE(docs.out.find("step_size"), std::string::npos);
}

TEST_F(CommandLine, ControlCharactersOfNamesDoNotReachTheTerminal) {
  const Outcome o = run({"render", "evil\x1b[2J\n.json", "-o", "a.png"});
  EXPECT_EQ(o.exit_code, 2);
  EXPECT_EQ(o.err.find('\x1b'), std::string::npos);
  EXPECT_EQ(o.err.find('\n'), o.err.size() - 1);
}

class SettingTest : public ProgramTest {
 protected:
  void expect_set_refused(const std::string& setting, const std::string& text) const {
    expect_refused({"render", "scene.json", "-o", "a.png", "--set", setting}, text);
    EXPECT_FALSE(exists("a.png"));
  }
};

TEST_F(SettingTest, ErrorsNameTheFlagTheKeyAndTheValidWords) {
  expect_set_refused("render.bounses=2", "--set render.bounses: ");
  expect_set_refused("render.bounses=2", "did you mean bounces?");
  expect_set_refused("lights.lmp.intensity=1,1,1", "did you mean lamp?");
  expect_set_refused("render.distance_sampling=miss", "did you mean mis?");
  expect_set_refused("render.step_size=-1", "a number greater than 0");
  expect_set_refused("render.step_size=nan", "found \"nan\"");
  expect_set_refused("lights.lamp.intensity=1,2", "three numbers");
  expect_set_refused("volumes=1", "--set volumes: ");
  expect_set_refused("render.bounces", "expected key=value");
  expect_set_refused("=3", "expected key=value");
}

TEST_F(SettingTest, LaterOnesWinAndShorthandsWinOverAll) {
  const Outcome o = run({"render", "scene.json", "-o", "a.png", "--spp", "1", "--size", "8x6", "--set",
                         "film.resolution=9,7", "--set", "render.bounces=2", "--set", "render.bounces=3"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto description = nlohmann::json::parse(run({"info", "a.png", "--json"}).out)["description"];
  EXPECT_EQ(description["render"]["bounces"], 3);
  EXPECT_EQ(description["film"]["resolution"], (nlohmann::json{8, 6}));
}

TEST_F(SettingTest, RelativeFilesAreMeantFromTheCurrentFolder) {
  std::filesystem::create_directory(path("scenes"));
  put_file(path("scenes/smoke.json"),
           R"({"brume": 1, "volumes": [{"name": "a", "shader": "vdb", "file": "other.vdb"}]})");
  std::filesystem::copy(BRUME_SOURCE_DIR "/scenes/vdb/smoke_plume_96_f050.vdb", path("smoke.vdb"));
  const std::vector<std::string> probe{"probe", "scenes/smoke.json", "--ray=1,-3,1,0,1,0", "--samples", "2"};
  expect_refused(probe, "scenes/other.vdb");
  auto mended = probe;
  mended.insert(mended.end(), {"--set", "volumes.a.file=smoke.vdb"});
  const Outcome o = run(mended);
  EXPECT_EQ(o.exit_code, 0) << o.err;
  const Outcome ui =
      run({"snapshot", "scenes/smoke.json", "-o", "ui.png", "--spp", "1", "--set", "volumes.a.file=smoke.vdb"});
  EXPECT_EQ(ui.exit_code, 0) << ui.err;
}

TEST_F(SettingTest, AVolumeThatBecomesAGridWantsAFile) {
  expect_refused({"render", "scene.json", "-o", "a.png", "--set", "volumes.fog.shader=vdb"},
                 "volumes.fog.file: found no file name");
}

}  // namespace
}  // namespace brume
