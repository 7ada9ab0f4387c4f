#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace brume {
namespace {

using Json = nlohmann::json;

constexpr const char* kSmoke = BRUME_SOURCE_DIR "/scenes/vdb/smoke_plume_96_f050.vdb";

class InfoCommand : public ProgramTest {
 protected:
  Json info(const std::string& file) const {
    const Outcome o = run({"info", file, "--json"});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    return Json::parse(o.out, nullptr, false);
  }
};

TEST_F(InfoCommand, ListsTheGridsOfAFile) {
  const Json j = info(kSmoke);
  EXPECT_EQ(j["density_grid"], "density");
  ASSERT_EQ(j["grids"].size(), 5u);
  for (const Json& grid : j["grids"]) {
    if (grid["name"] == "density") {
      // As vdb_print tells, see shared/data/README.md.
      EXPECT_EQ(grid["type"], "float");
      EXPECT_EQ(grid["class"], "fog volume");
      EXPECT_NEAR(grid["voxel_size"][0].get<double>(), 0.0364583, 1e-6);
      EXPECT_EQ(grid["active_voxels"], 70422);
      EXPECT_EQ(grid["index_bounds"]["min"], (Json{6, 1, 1}));
      EXPECT_EQ(grid["index_bounds"]["max"], (Json{53, 49, 86}));
      EXPECT_NEAR(grid["bounds"]["min"][0].get<double>(), 0.2005, 1e-4);
      EXPECT_NEAR(grid["bounds"]["max"][2].get<double>(), 3.1536, 1e-4);
      EXPECT_NEAR(grid["max"].get<double>(), 0.811, 1e-3);
      EXPECT_GT(grid["memory_bytes"].get<int>(), 70422 * 4);
      EXPECT_EQ(grid["non_finite_voxels"], 0);
      EXPECT_EQ(grid["usable"], true);
    } else if (grid["name"] == "velocity") {
      EXPECT_EQ(grid["usable"], false);
      EXPECT_TRUE(grid["why_not"].is_string());
    }
  }
}

TEST_F(InfoCommand, TheTableNamesEveryGrid) {
  const Outcome o = run({"info", kSmoke});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  for (const char* word :
       {"density", "flame", "shadow", "temperature", "velocity", "voxel size", "range", "memory", "not usable: "})
    EXPECT_NE(o.out.find(word), std::string::npos) << word;
}

TEST_F(InfoCommand, TellsWhatASceneHolds) {
  const Json j = info("scene.json");
  EXPECT_EQ(j["description"]["volumes"][0]["name"], "fog");
  EXPECT_EQ(j["description"]["lights"].size(), 2u);
  EXPECT_EQ(j["description"]["camera"]["position"], (Json{0, -6, 0}));
  EXPECT_EQ(j["resolved"]["volumes"][0]["bounds"]["max"], (Json{1, 1, 1}));
  EXPECT_TRUE(j["resolved"]["step_size"].is_number());
  EXPECT_EQ(j["resolved"]["needs"]["channels"], 1);
  EXPECT_EQ(j["resolved"]["enabled_lights"], 2);
  const Outcome text = run({"info", "scene.json"});
  EXPECT_EQ(text.exit_code, 0);
  for (const char* word : {"fog", "sun", "lamp", "point", "homogeneous", "camera", "needs", "bounces 1"})
    EXPECT_NE(text.out.find(word), std::string::npos) << word << "\n" << text.out;
}

TEST_F(InfoCommand, BrokenFilesAreRefused) {
  const std::string smoke = content_of(kSmoke);
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{4}, std::size_t{300}, smoke.size() / 2, smoke.size() - 10}) {
    put_file(path("cut.vdb"), smoke.substr(0, length));
    expect_refused({"info", "cut.vdb"}, "cut.vdb");
    expect_refused({"info", "cut.vdb", "--json"}, "cut.vdb");
  }
}

}  // namespace
}  // namespace brume
