// Scenes that cannot be rendered: one sentence with file and key, exit code 2, no picture.
#include "renderer/film/image_io.h"
#include "tests/cli/program.h"

namespace brume {
namespace {

class SceneErrors : public ProgramTest {
 protected:
  /// The sentence names the scene's file, or the one that it could not use.
  /// @param lists  of the scene: "lights": [...], ...
  void expect_scene_refused(const std::string& lists, const std::string& text) const {
    put_file(path("bad.json"), "{ \"brume\": 1,\n" + lists + " }");
    expect_refused({"render", "bad.json", "-o", "a.png"}, text);
    const Outcome o = run({"render", "bad.json", "-o", "a.png"});
    const std::string first_word = o.err.substr(0, o.err.find(": ", std::string("brume: error: ").size()));
    EXPECT_NE(first_word.find('.'), std::string::npos) << o.err;
    EXPECT_FALSE(exists("a.png"));
  }
  void expect_light_refused(const std::string& light, const std::string& text) const {
    expect_scene_refused("\"lights\": [" + light + "]", text);
  }
  void expect_surface_refused(const std::string& surface, const std::string& text) const {
    expect_scene_refused("\"surfaces\": [" + surface + "]", text);
  }
};

const char* const kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(SceneErrors, UnknownLightTypesAndNegativeIntensities) {
  expect_light_refused(R"({"type": "pont"})", "did you mean point?");
  expect_light_refused(R"({"type": "laser"})", "valid: point, spot, directional, quad, disc, sphere, mesh");
  const std::pair<const char*, const char*> amounts[] = {
      {"point", "intensity"}, {"spot", "intensity"},  {"directional", "irradiance"}, {"quad", "radiance"},
      {"disc", "radiance"},   {"sphere", "radiance"}, {"environment", "radiance"}};
  for (const auto& [type, key] : amounts)
    expect_light_refused(std::string("{\"type\": \"") + type + "\", \"name\": \"x\", \"" + key + "\": [1, -2, 1]}",
                         key);
  expect_light_refused(R"({"type": "sphere", "radius": 0})", "radius");
  expect_light_refused(R"({"type": "disc", "radius": -1})", "radius");
  expect_light_refused(R"({"type": "disc", "name": "d", "normal": [0, 0, 0]})", "lights.d.normal: found [0, 0, 0]");
  expect_light_refused(R"({"type": "spot", "name": "s", "direction": [0, 0, 0]})", "lights.s.direction");
  expect_light_refused(R"({"type": "spot", "cone_deg": 91})", "cone_deg");
  expect_light_refused(R"({"type": "directional", "angular_diameter_deg": 181})", "angular_diameter_deg");
}

TEST_F(SceneErrors, EnvironmentsThatAreNoPicture) {
  expect_light_refused(R"({"type": "image_environment", "name": "sky"})", "file");
  expect_light_refused(R"({"type": "image_environment", "name": "sky", "file": "none.hdr"})", "there is no such file");
  put_file(path("sky.hdr"), "not light");
  expect_light_refused(R"({"type": "image_environment", "name": "sky", "file": "sky.hdr"})", "sky.hdr");
  expect_light_refused(R"({"type": "image_environment", "name": "sky", "file": "sky.jpg"})", "expected a picture in");
}

TEST_F(SceneErrors, MeshesThatAreMissingOrNoMesh) {
  put_file(path("text.obj"), "smoke\n");
  put_file(path("text.ply"), "smoke\n");
  put_file(path("line.obj"), "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  const std::pair<const char*, const char*> cases[] = {{"none.obj", "there is no such file"},
                                                       {"none.stl", "expected a mesh in .obj or .ply"},
                                                       {"text.obj", "found no triangle"},
                                                       {"text.ply", "expected a mesh that begins with"}};
  for (const auto& [file, text] : cases) {
    const std::string named = std::string("\"name\": \"m\", \"file\": \"") + file + "\"";
    expect_surface_refused("{\"type\": \"mesh\", " + named + "}", "surfaces.m.file");
    expect_surface_refused("{\"type\": \"mesh\", " + named + "}", text);
    expect_light_refused("{\"type\": \"mesh\", " + named + "}", text);
    expect_scene_refused(
        "\"volumes\": [{\"shader\": \"homogeneous\", \"name\": \"v\", \"bounds\": {\"type\": \"mesh\", "
        "\"file\": \"" +
            std::string(file) + "\"}}]",
        text);
  }
  expect_surface_refused(R"({"type": "mesh", "name": "m"})", "file");
  expect_light_refused(R"({"type": "mesh", "name": "m", "file": "line.obj"})", "found triangles without area");
}

TEST_F(SceneErrors, AnOpenMeshBoundsNothing) {
  put_file(path("open.obj"), kTriangle);
  expect_scene_refused(R"("volumes": [{"shader": "homogeneous", "name": "fog",
                          "bounds": {"type": "mesh", "file": "open.obj"}}])",
                       "volumes.fog.bounds.file: found 3 open edges");
}

TEST_F(SceneErrors, SurfacesThatCannotBe) {
  expect_surface_refused(R"({"type": "plane", "name": "p", "normal": [0, 0, 0]})", "surfaces.p.normal");
  expect_surface_refused(R"({"type": "plane", "name": "p", "material": {"type": "emissive"}})", "surfaces.p.material");
  expect_surface_refused(R"({"type": "sphere", "radius": 0})", "radius");
  expect_surface_refused(R"({"type": "sphere", "material": {"type": "glass"}})", "valid: diffuse, emissive, holdout");
  expect_surface_refused(R"({"type": "sphere", "material": {"type": "diffuse", "albedo": [2, 0, 0]}})", "albedo");
  put_file(path("t.obj"), kTriangle);
  expect_surface_refused(R"({"type": "mesh", "name": "m", "file": "t.obj", "transform": {"scale": [1, 0, 1]}})",
                         "surfaces.m.transform.scale");
}

TEST_F(SceneErrors, ALampInsideABallIsExplained) {
  put_file(path("ball.json"), R"({ "brume": 1, "film": {"resolution": [8, 6]},
    "surfaces": [{"type": "sphere", "center": [0, 0, 3], "radius": 0.3}],
    "lights": [{"type": "point", "position": [0, 0, 3]}],
    "volumes": [{"shader": "homogeneous"}] })");
  const Outcome o = run({"render", "ball.json", "-o", "a.png", "--spp", "1"});
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_TRUE(o.error_says("Surfaces keep all light away")) << o.err;
}

TEST_F(SceneErrors, ASceneOfAllOfThemIsRendered) {
  put_file(path("t.obj"), kTriangle);
  put_file(path("good.json"), R"({ "brume": 1, "film": {"resolution": [8, 6]},
    "surfaces": [{"type": "plane"}, {"type": "sphere", "material": {"type": "emissive"}},
                 {"type": "mesh", "file": "t.obj", "material": {"type": "holdout"}}],
    "lights": [{"type": "mesh", "file": "t.obj"}],
    "volumes": [{"shader": "homogeneous"}] })");
  const Outcome o = run({"render", "good.json", "-o", "a.png", "--spp", "1"});
  EXPECT_EQ(o.exit_code, 0) << o.err;
  const Outcome info = run({"info", "good.json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("surfaces: 3"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("surfaces (Embree)"), std::string::npos) << info.out;
}

}  // namespace
}  // namespace brume
