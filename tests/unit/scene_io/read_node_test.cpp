#include "renderer/scene_io/read_node.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/unit/scene_io/test_tables.h"

namespace brume {
namespace {

Result<Node> read(std::string_view text, const Family& family = test_tables::studio_family(),
                  const std::string& base = "/base") {
  const auto json = parse_json(text, "s.json");
  if (!json.ok()) return json.error();
  return read_node(*json, family, {"s.json", base});
}

Node read_ok(std::string_view text, const Family& family = test_tables::studio_family(),
             const std::string& base = "/base") {
  auto node = read(text, family, base);
  EXPECT_TRUE(node.ok()) << node.error().to_string() << "\nin " << text;
  return node ? *node : Node(*family.tables.front());
}

std::string error_of(std::string_view text, const Family& family = test_tables::studio_family()) {
  const auto node = read(text, family);
  return node.ok() ? "no error" : node.error().to_string();
}

TEST(ReadNode, EmptyObjectIsAllDefaults) { EXPECT_EQ(read_ok("{}"), test_tables::studio()); }

TEST(ReadNode, ReadsEveryType) {
  const Node studio = read_ok(R"({
    "film": {"resolution": [320, 2e2], "exposure": -1, "seed": 4294967295},
    "volumes": [
      {"name": "smoke", "file": "/abs/smoke.vdb", "density_scale": 20, "step": "auto", "samples": 4.0,
       "sampling": "density", "albedo": 0.5, "phase": {"type": "lobe", "g": 0.2}},
      {"shader": "slabs", "edges": [], "scale": [1, 2, 3], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}
    ],
    "lights": [{"enabled": false, "intensity": [1, 2, 3]}, {"type": "sun", "direction": 1}]
  })");
  EXPECT_EQ(studio.child("film").numbers("resolution"), (Numbers{320, 200}));
  EXPECT_EQ(studio.child("film").number("exposure"), -1);
  EXPECT_EQ(studio.child("film").value("seed"), Value(std::int64_t{4294967295}));
  ASSERT_EQ(studio.list("volumes").size(), 2u);
  const Node& smoke = studio.list("volumes")[0];
  EXPECT_EQ(smoke.kind(), "vdb");
  EXPECT_EQ(smoke.text("name"), "smoke");
  EXPECT_EQ(smoke.text("file"), "/abs/smoke.vdb");
  EXPECT_EQ(smoke.text("fire"), "");
  EXPECT_EQ(smoke.number("density_scale"), 20);
  EXPECT_TRUE(smoke.is_auto("step"));
  EXPECT_EQ(smoke.integer("samples"), 4);
  EXPECT_EQ(smoke.text("sampling"), "density");
  EXPECT_EQ(smoke.numbers("albedo"), (Numbers{0.5, 0.5, 0.5}));
  EXPECT_EQ(smoke.child("phase").kind(), "lobe");
  EXPECT_EQ(smoke.child("phase").number("g"), 0.2);
  const Node& slabs = studio.list("volumes")[1];
  EXPECT_EQ(slabs.kind(), "slabs");
  EXPECT_TRUE(slabs.numbers("edges").empty());
  EXPECT_EQ(slabs.numbers("matrix").size(), 16u);
  EXPECT_FALSE(studio.list("lights")[0].flag("enabled"));
  EXPECT_EQ(studio.list("lights")[1].numbers("direction"), (Numbers{1, 1, 1}));
}

TEST(ReadNode, TheKindMayStandAnywhereInTheObject) {
  const Node lights = read_ok(R"({"lights": [{"direction": [1, 0, 0], "type": "sun"}]})");
  EXPECT_EQ(lights.list("lights")[0].kind(), "sun");
}

TEST(ReadNode, RelativeFilesBecomeAbsoluteAndNormal) {
  const auto file = [](const std::string& path, const std::string& base) {
    return read_ok("{\"file\": \"" + path + "\"}", test_tables::volume_family(), base).text("file");
  };
  EXPECT_EQ(file("smoke.vdb", "/base"), "/base/smoke.vdb");
  EXPECT_EQ(file("./a/../smoke.vdb", "/base/"), "/base/smoke.vdb");
  EXPECT_EQ(file("../other/smoke.vdb", "/base/x/."), "/base/other/smoke.vdb");
  EXPECT_EQ(file("/abs/./smoke.vdb", "/base"), "/abs/./smoke.vdb");
  EXPECT_EQ(file("\xC3\xA4/\xE7\x85\x99.vdb", "/b\xC3\xBC"), "/b\xC3\xBC/\xC3\xA4/\xE7\x85\x99.vdb");
  const std::string here = std::filesystem::current_path().string();
  EXPECT_EQ(file("smoke.vdb", ""), here + "/smoke.vdb");
  EXPECT_EQ(file("smoke.vdb", "sub"), here + "/sub/smoke.vdb");
  EXPECT_EQ(read_ok(R"({"file": "a", "fire": ""})", test_tables::volume_family()).text("fire"), "");
}

struct Fault {
  const char* text;
  const char* error;
};

TEST(ReadNode, ErrorsSayWhereWhatAndHow) {
  const Fault faults[] = {
      {"\n []", "s.json:2:2: found an empty list, expected an object in braces"},
      {"{\n  \"film\": null}", "s.json:2:11: film: found null, expected an object in braces"},
      {"{\"film\": [{}]}", "s.json:1:10: film: found a list of 1 value, expected an object in braces"},
      {"{\"lights\": {}}", "s.json:1:12: lights: found an object, expected a list of objects in square brackets"},
      {"{\"lights\": null}", "s.json:1:12: lights: found null, expected a list of objects in square brackets"},
      {"{\"lights\": [{}, 5]}",
       "s.json:1:17: lights[1]: found 5, expected an object in braces, such as {\"type\": \"point\"}"},
      {"{\"lights\": [\"sun\"]}",
       "s.json:1:13: lights[0]: found the text \"sun\", expected an object in braces, such as {\"type\": \"sun\"}"},
      // unknown kinds
      {"{\"lights\": [\n {\"type\": \"pont\"}]}",
       "s.json:2:11: lights[0].type: unknown light \"pont\"; did you mean point? (valid: point, sun)"},
      {"{\"lights\": [{\"type\": 3}]}", "s.json:1:22: lights[0].type: found 3, expected one of point, sun"},
      {"{\"film\": {\"type\": \"film\"}}",
       "s.json:1:11: film.type: unknown key \"type\" (valid: resolution, exposure, seed)"},
      // unknown keys
      {"{\"lihgts\": []}",
       "s.json:1:2: lihgts: unknown key \"lihgts\"; did you mean lights? (valid: film, volumes, lights)"},
      {"{\"lights\": [{},\n {\"intensty\": 3}]}",
       "s.json:2:3: lights[1].intensty: unknown key \"intensty\"; did you mean intensity? "
       "(valid: type, name, enabled, position, intensity)"},
      {"{\"lights\": [{\"direction\": 3}]}",
       "s.json:1:14: lights[0].direction: unknown key \"direction\" (valid: type, name, enabled, position, intensity); "
       "this is a point light, and that key belongs to sun"},
      {"{\"a\\nb\": 3}", "s.json:1:2: a\\nb: unknown key \"a\\nb\" (valid: film, volumes, lights)"},
      // missing
      {"{\"volumes\": [\n  {\"name\": \"x\"}]}",
       "s.json:2:3: volumes[0].file: \"file\" is missing, expected the path of a file"},
      {"{\"volumes\": [{\"file\": \"\"}]}", "s.json:1:23: volumes[0].file: found nothing, expected the path of a file"},
      {"{\"volumes\": [{\"file\": \"a\\u0000b\"}]}",
       "s.json:1:23: volumes[0].file: found the text \"a\\u0000b\", expected the path of a file"},
      // wrong types and ranges
      {"{\"film\": {\"seed\": 1.5}}", "s.json:1:19: film.seed: found 1.5, expected a whole number"},
      {"{\"film\": {\"seed\": \"1\"}}", "s.json:1:19: film.seed: found the text \"1\", expected a whole number"},
      {"{\"film\": {\"seed\": 1e30}}", "s.json:1:19: film.seed: found 1e+30, expected a whole number"},
      {"{\"film\": {\"exposure\": null}}", "s.json:1:23: film.exposure: found null, expected a number in [-20, 20]"},
      {"{\"film\": {\"exposure\": 20.5}}", "s.json:1:23: film.exposure: found 20.5, expected a number in [-20, 20]"},
      {"{\"film\": {\"exposure\": \"auto\"}}",
       "s.json:1:23: film.exposure: found the text \"auto\", expected a number in [-20, 20]"},
      {"{\"film\": {\"resolution\": 5}}",
       "s.json:1:25: film.resolution: found 5, expected two whole numbers in [1, 16384]"},
      {"{\"film\": {\"resolution\": [640]}}",
       "s.json:1:25: film.resolution: found [640], expected two whole numbers in [1, 16384]"},
      {"{\"film\": {\"resolution\": [640, 0]}}",
       "s.json:1:25: film.resolution: found [640, 0], expected two whole numbers in [1, 16384]"},
      {"{\"film\": {\"resolution\": [640, 1.5]}}",
       "s.json:1:25: film.resolution: found [640, 1.5], expected two whole numbers in [1, 16384]"},
      {"{\"film\": {\"resolution\": [640,\n \"480\"]}}",
       "s.json:2:2: film.resolution: found the text \"480\" in the list, expected two whole numbers in [1, 16384]"},
      {"{\"lights\": [{\"enabled\": 1}]}", "s.json:1:25: lights[0].enabled: found 1, expected true or false"},
      {"{\"lights\": [{\"name\": true}]}", "s.json:1:22: lights[0].name: found true, expected a text"},
      {"{\"lights\": [{\"position\": 1}]}", "s.json:1:26: lights[0].position: found 1, expected three numbers"},
      {"{\"lights\": [{\"intensity\": -1}]}",
       "s.json:1:27: lights[0].intensity: found [-1, -1, -1], expected three numbers at least 0"},
      {"{\"lights\": [{\"intensity\": [1, 2]}]}",
       "s.json:1:27: lights[0].intensity: found [1, 2], expected three numbers at least 0"},
      {"{\"volumes\": [{\"file\": \"a\", \"step\": 0}]}",
       "s.json:1:36: volumes[0].step: found 0, expected a number greater than 0, or auto"},
      {"{\"volumes\": [{\"file\": \"a\", \"step\": \"Auto\"}]}",
       "s.json:1:36: volumes[0].step: found the text \"Auto\", expected a number greater than 0, or auto"},
      {"{\"volumes\": [{\"file\": \"a\", \"sampling\": \"misc\"}]}",
       "s.json:1:40: volumes[0].sampling: found misc, expected one of density, equi_angular, mis; did you mean mis?"},
      {"{\"volumes\": [{\"file\": \"a\", \"phase\": {\"type\": \"lobe\", \"g\": 1}}]}",
       "s.json:1:59: volumes[0].phase.g: found 1, expected a number in [-0.99, 0.99]"},
      {"{\"volumes\": [{\"shader\": \"slabs\", \"matrix\": [1, 2]}]}",
       "s.json:1:44: volumes[0].matrix: found [1, 2], expected 16 numbers (a 4x4 matrix by rows) or an empty list"},
      // the first one in the file is told
      {"{\"volumes\": [{\"step\": 0, \"nonsense\": 1}], \"film\": 1}",
       "s.json:1:23: volumes[0].step: found 0, expected a number greater than 0, or auto"},
  };
  for (const Fault& f : faults) EXPECT_EQ(error_of(f.text), f.error) << "in " << f.text;
}

TEST(ReadNode, SourceHoldsFileLineColumnAndKey) {
  const auto node = read("{\"lights\": [{},\n {\"intensity\": \"red\"}]}");
  ASSERT_FALSE(node.ok());
  EXPECT_EQ(node.error().code, ErrorCode::BadInput);
  EXPECT_EQ(node.error().source.file, "s.json");
  EXPECT_EQ(node.error().source.line, 2);
  EXPECT_EQ(node.error().source.column, 16);
  EXPECT_EQ(node.error().source.key, "lights[1].intensity");
}

TEST(ReadNode, AnObjectLeftOutMustNotNeedAnything) {
  static const Family holder = [] {
    static const ParamTable table{
        "holder", "Holder", "", {}, {{"volume", "Volume", "", &test_tables::volume_family()}}};
    return Family{"holder", "", {&table}};
  }();
  EXPECT_EQ(error_of("\n{}", holder), "s.json:2:1: volume.file: \"file\" is missing, expected the path of a file");
  EXPECT_EQ(error_of("{\"volume\": {\"shader\": \"slabs\"}}", holder), "no error");
}

TEST(ReadNode, LongKeysDoNotFloodTheMessage) {
  const std::string message = error_of("{\"" + std::string(1000000, 'k') + "\": 1}");
  EXPECT_LT(message.size(), 400u);
}

}  // namespace
}  // namespace brume
