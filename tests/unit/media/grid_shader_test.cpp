#include "renderer/media/grid_shader.h"

#include <gtest/gtest.h>

#include "renderer/core/blackbody.h"
#include "renderer/media/registry.h"
#include "renderer/sampling/sampler.h"

namespace brume {
namespace {

const std::string kFire = std::string(BRUME_SOURCE_DIR) + "/scenes/vdb/fire_80_f036.vdb";

class FireShader : public testing::Test {
 protected:
  std::shared_ptr<const Shader> make(const std::string& grid, const std::string& amount, const std::string& heat,
                                     double scale = 900, double offset = 30) {
    const ShaderType type = vdb_shader_type();
    const ParamTable table{type.key, type.label, type.doc, type.params, {}};
    Node node(table);
    EXPECT_TRUE(node.set("file", kFire).ok() && node.set("grid", grid).ok() && node.set("emission_grid", amount).ok() &&
                node.set("temperature_grid", heat).ok() && node.set("temperature_scale", scale).ok() &&
                node.set("temperature_offset", offset).ok());
    auto made = type.make(node, {Affined{}, grids_, {}});
    EXPECT_TRUE(made.ok()) << made.error().to_string();
    return made->shader;
  }
  std::vector<float> density(const Shader& shader) const {
    std::vector<float> values(kN);
    shader.density(points(), values.data());
    return values;
  }
  std::vector<Color> emission(const Shader& shader) const {
    std::vector<float> rgb[3];
    for (auto& c : rgb) c.resize(kN);
    shader.emission(points(), {rgb[0].data(), rgb[1].data(), rgb[2].data()});
    std::vector<Color> colors;
    for (std::size_t i = 0; i < kN; ++i) colors.push_back({rgb[0][i], rgb[1][i], rgb[2][i]});
    return colors;
  }
  void SetUp() override {
    for (std::uint32_t i = 0; i < kN; ++i) {
      const Sampler sampler(SamplerKind::Independent, 1, 0, i);
      const Vec2 u = sampler.u2(Decision::Pixel);
      x_.push_back(0.3f + 1.4f * u.x), y_.push_back(0.1f + 1.4f * u.y);
      z_.push_back(3.5f * sampler.u1(Decision::Flight));
    }
  }

  static constexpr std::size_t kN = 1024;

 private:
  PointBatch points() const { return {x_.data(), y_.data(), z_.data(), kN, 0}; }
  std::vector<float> x_, y_, z_;
  GridCache grids_;
};

TEST_F(FireShader, TemperatureColoursWhatTheFlameGives) {
  const auto flame = density(*make("flame", "", "")), heat = density(*make("temperature", "", ""));
  const auto both = emission(*make("density", "flame", "temperature"));
  const auto hot = emission(*make("", "", "temperature")), plain = emission(*make("density", "flame", ""));
  int glowing = 0;
  for (std::size_t i = 0; i < kN; ++i) {
    const Color expected = heat[i] > 0 ? blackbody_glow(900 * heat[i] + 30) : Color{};
    EXPECT_EQ(hot[i], expected);
    EXPECT_EQ(both[i], flame[i] * expected);
    EXPECT_EQ(plain[i], Color(flame[i]));
    glowing += !is_black(both[i]);
  }
  EXPECT_GT(glowing, 50) << "the points miss the fire";
}

TEST_F(FireShader, OutsideOfTheTemperatureGridNothingGlowsWhateverTheOffset) {
  const auto heat = density(*make("temperature", "", ""));
  const auto hot = emission(*make("", "", "temperature", 900, 2000));
  int outside = 0;
  for (std::size_t i = 0; i < kN; ++i) {
    if (heat[i] != 0) continue;
    EXPECT_EQ(hot[i], Color());
    ++outside;
  }
  EXPECT_GT(outside, 50);
}

}  // namespace
}  // namespace brume
