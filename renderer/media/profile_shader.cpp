#include "renderer/media/profile_shader.h"

#include "renderer/media/registry.h"

namespace brume {

void ProfileShader::density(const PointBatch& points, float* density) const {
  for (int i = 0; i < points.n; ++i)
    density[i] = std::max(0.0f, profile_.density(local_from_scene_.point({points.x[i], points.y[i], points.z[i]})));
}

float ProfileShader::max_density(const Bounds3& box) const {
  const double bound = profile_.bound(transform_bounds(local_from_scene_.cast<double>(), box));
  return static_cast<float>(std::max(0.0, bound)) * 1.00001f;  // both are rounded
}

namespace {

/// Where in the box the point nearest to p is, and the distance of the farthest.
double nearest_distance(const Bounds3& box, Vec3d p) { return length(p - min(max(p, box.low), box.high)); }
double farthest_distance(const Bounds3& box, Vec3d p) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += std::pow(std::max(std::abs(p[k] - box.low[k]), std::abs(p[k] - box.high[k])), 2);
  return std::sqrt(sum);
}

}  // namespace

ProfileShader::Profile exponential_profile(int axis, float y0, float scale_height) {
  return {[=](Vec3 p) { return std::exp(-(p[axis] - y0) / scale_height); },
          [=](const Bounds3& box) {
            return std::exp(-(box.low[axis] - static_cast<double>(y0)) / static_cast<double>(scale_height));
          }};
}

ProfileShader::Profile gaussian_profile(Vec3 center, float sigma) {
  return {[=](Vec3 p) { return std::exp(-length_squared(p - center) / (2 * sigma * sigma)); },
          [=](const Bounds3& box) {
            return std::exp(-0.5 * std::pow(nearest_distance(box, Vec3d(center)) / static_cast<double>(sigma), 2));
          }};
}

ProfileShader::Profile linear_profile(Vec3 gradient, float offset) {
  return {[=](Vec3 p) { return offset + dot(gradient, p); },
          [=](const Bounds3& box) {
            const Vec3d g(gradient);
            double sum = static_cast<double>(offset);
            for (int k = 0; k < 3; ++k) sum += std::max(g[k] * box.low[k], g[k] * box.high[k]);
            return sum;
          }};
}

ProfileShader::Profile slabs_profile(int axis, std::vector<float> edges, std::vector<float> values) {
  auto density = [=](Vec3 p) {
    const auto above = std::upper_bound(edges.begin(), edges.end(), p[axis]);
    if (above == edges.begin() || above == edges.end()) return 0.0f;
    return values[static_cast<std::size_t>(above - edges.begin()) - 1];
  };
  auto bound = [=](const Bounds3& box) {
    float largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (static_cast<double>(edges[i]) <= box.high[axis] && static_cast<double>(edges[i + 1]) >= box.low[axis])
        largest = std::max(largest, values[i]);
    return static_cast<double>(largest);
  };
  return {density, bound};
}

ProfileShader::Profile shell_profile(Vec3 center, float inner, float outer) {
  return {[=](Vec3 p) {
            const float r2 = length_squared(p - center);
            return r2 >= inner * inner && r2 <= outer * outer ? 1.0f : 0.0f;
          },
          [=](const Bounds3& box) {
            const double rounding = 1e-5 * static_cast<double>(outer);
            const bool misses = nearest_distance(box, Vec3d(center)) > static_cast<double>(outer) + rounding ||
                                farthest_distance(box, Vec3d(center)) < static_cast<double>(inner) - rounding;
            return misses ? 0.0 : 1.0;
          }};
}

ProfileShader::Profile sinusoid_profile(float amplitude, Vec3 wavevector, float phase) {
  return {[=](Vec3 p) { return 1 + amplitude * std::sin(2 * kPi * dot(wavevector, p) + phase); },
          [=](const Bounds3&) { return 1 + std::abs(static_cast<double>(amplitude)); }};
}

namespace {

Param axis_param() {
  return param::choice("axis", "Axis", "z", {{"x", "x", ""}, {"y", "y", ""}, {"z", "z", ""}})
      .says("Axis along which the density changes.");
}

int axis_of(const Node& n) { return n.text("axis")[0] - 'x'; }
float real(const Node& n, const char* key) { return static_cast<float>(n.number(key)); }
Vec3 vec(const Node& n, const char* key) { return Vec3(n.vec3(key)); }

std::vector<float> floats(const Node& n, const char* key) {
  const Numbers& v = n.numbers(key);
  return {v.begin(), v.end()};
}

Result<MadeShader> made(const ShaderContext& context, float finest_scale, ProfileShader::Profile profile) {
  return MadeShader{
      std::make_shared<ProfileShader>(context.local_from_scene.cast<float>(), finest_scale, std::move(profile))};
}

}  // namespace

std::vector<ShaderType> profile_shader_types() {
  using namespace param;
  return {
      {"exponential",
       "Exponential fog",
       "Thins out exponentially with height: exp(-(height - y0) / scale_height).",
       {axis_param(), number("y0", "Height of density 1", 0).in("world units").says("Where the density is 1."),
        number("scale_height", "Scale height", 1)
            .more_than(0)
            .log_slider(0.01, 100)
            .in("world units")
            .says("Height over which the density falls to 1/e.")},
       false,
       [](const Node& n, const ShaderContext& c) {
         return made(c, real(n, "scale_height") / 8,
                     exponential_profile(axis_of(n), real(n, "y0"), real(n, "scale_height")));
       }},
      {"gaussian",
       "Gaussian ball",
       "A soft ball: exp(-r^2 / (2 sigma^2)).",
       {point("center", "Centre", 0, 0, 0).says("Centre of the ball."), number("sigma", "Sigma", 0.5)
                                                                            .more_than(0)
                                                                            .log_slider(0.01, 100)
                                                                            .in("world units")
                                                                            .says("Standard deviation of the ball.")},
       false,
       [](const Node& n, const ShaderContext& c) {
         return made(c, real(n, "sigma") / 8, gaussian_profile(vec(n, "center"), real(n, "sigma")));
       }},
      {"linear",
       "Linear ramp",
       "A density that rises linearly; 0 where it would be negative.",
       {vector("gradient", "Gradient", 0, 0, 1).in("1/world unit").says("Change of the density per world unit."),
        number("offset", "Offset", 1).says("Density at the origin.")},
       false,
       [](const Node& n, const ShaderContext& c) {
         const Vec3 g = vec(n, "gradient");
         return made(c, 1 / (8 * std::max(length(g), 1e-3f)), linear_profile(g, real(n, "offset")));
       }},
      {"slabs",
       "Slabs",
       "Layers of constant density.",
       {axis_param(),
        numbers("edges", "Edges", {-1, 0, 1})
            .in("world units")
            .says("Ascending borders of the layers, one more than values."),
        numbers("values", "Values", {1, 2}).at_least(0).says("Density of each layer.")},
       false,
       [](const Node& n, const ShaderContext& c) -> Result<MadeShader> {
         const auto edges = floats(n, "edges"), values = floats(n, "values");
         if (edges.size() != values.size() + 1 || values.empty())
           return bad_input("found " + std::to_string(edges.size()) + " edges and " + std::to_string(values.size()) +
                                " values, expected one edge more than values",
                            {"", 0, 0, "edges"});
         float thinnest = std::numeric_limits<float>::infinity();
         for (std::size_t i = 1; i < edges.size(); ++i) thinnest = std::min(thinnest, edges[i] - edges[i - 1]);
         if (!(thinnest > 0))
           return bad_input("found edges that do not ascend, expected each above the last", {"", 0, 0, "edges"});
         return made(c, thinnest, slabs_profile(axis_of(n), edges, values));
       }},
      {"shell",
       "Shell",
       "A hollow ball.",
       {point("center", "Centre", 0, 0, 0).says("Centre of the ball."),
        number("r_inner", "Inner radius", 0.8)
            .at_least(0)
            .slider(0, 10)
            .in("world units")
            .says("Radius of the hollow."),
        number("r_outer", "Outer radius", 1).more_than(0).slider(0, 10).in("world units").says("Radius of the ball.")},
       false,
       [](const Node& n, const ShaderContext& c) -> Result<MadeShader> {
         const float inner = real(n, "r_inner"), outer = real(n, "r_outer");
         if (!(inner < outer))
           return bad_input("found " + format_value(n.value("r_outer")) + ", expected more than r_inner",
                            {"", 0, 0, "r_outer"});
         return made(c, (outer - inner) / 2, shell_profile(vec(n, "center"), inner, outer));
       }},
      {"sinusoid",
       "Sinusoid",
       "Parallel waves: 1 + amplitude sin(2 pi wavevector.x + phase_offset).",
       {number("amplitude", "Amplitude", 0.9).between(-1, 1).says("Height of the waves over the mean density 1."),
        vector("wavevector", "Wave vector", 0, 0, 4)
            .in("cycles/world unit")
            .says("Direction and frequency of the waves."),
        number("phase_offset", "Phase", 0).slider(-3.14, 3.14).in("radians").says("Shift of the waves.")},
       false,
       [](const Node& n, const ShaderContext& c) {
         const Vec3 k = vec(n, "wavevector");
         return made(c, 1 / (8 * std::max(length(k), 1e-3f)),
                     sinusoid_profile(real(n, "amplitude"), k, real(n, "phase_offset")));
       }},
  };
}

}  // namespace brume
