#include "tests/support/reference_probe.h"

#include <algorithm>
#include <cmath>

#include "renderer/lights/registry.h"
#include "renderer/phase/registry.h"
#include "renderer/sampling/warps.h"
#include "renderer/scene/volume.h"
#include "tests/support/reference_medium.h"

namespace brume {

const char* name_of(DistanceSampling mode) {
  switch (mode) {
    case DistanceSampling::Density:
      return "density";
    case DistanceSampling::Equiangular:
      return "equi_angular";
    case DistanceSampling::Mis:
      return "mis";
    case DistanceSampling::Product:
      return "product";
  }
  return "";
}

namespace {

/// Gives `node` all numbers of `kind` under the keys that its table has for them.
/// @param renamed  keys of the file that have another name in the table
Result<void> copy_numbers(const ReferenceKind& kind, Node& node,
                          const std::map<std::string, std::string>& renamed = {}) {
  for (const auto& [file_key, numbers] : kind.numbers) {
    const auto other = renamed.find(file_key);
    const std::string key = other == renamed.end() ? file_key : other->second;
    const Param* param = node.table().find(key);
    if (!param) return bad_input("the " + node.kind() + " has no " + key);
    Value value = numbers;
    if (param->type == ParamType::Number) value = numbers.at(0);
    if (param->type == ParamType::Bool) value = numbers.at(0) != 0;
    if (param->type == ParamType::Choice)
      value = std::string(1, static_cast<char>('x' + static_cast<int>(numbers.at(0))));
    if (const auto ok = node.set(key, value); !ok) return ok;
  }
  return {};
}

Numbers list_of(const Channels& c) { return {c[0], c[1], c[2]}; }

Result<void> add_volume_of(const ReferenceCase& c, Node& scene) {
  const std::string shader = c.density.type == "constant" ? "homogeneous" : c.density.type;
  const ParamTable* table = volume_family().find(shader);
  if (!table) return bad_input("there is no shader \"" + shader + "\"");
  Node volume(*table);
  if (const auto ok = copy_numbers(c.density, volume, {{"phase", "phase_offset"}}); !ok) return ok;
  const ParamTable* shape = volume.table().find_slot("bounds")->family->find(c.bounds.type);
  if (!shape) return bad_input("there is no shape \"" + c.bounds.type + "\"");
  volume.child("bounds") = Node(*shape);
  if (const auto ok = copy_numbers(c.bounds, volume.child("bounds")); !ok) return ok;

  if (const auto ok = volume.set("density_scale", 1.0); !ok) return ok;
  if (const auto ok = volume.set("sigma_s", list_of(c.sigma_s)); !ok) return ok;
  if (const auto ok = volume.set("sigma_a", list_of(c.sigma_a)); !ok) return ok;
  if (c.emission != Channels{}) {
    if (const auto ok = volume.set("emission_scale", 1.0); !ok) return ok;
    if (const auto ok = volume.set("emission_color", list_of(c.emission)); !ok) return ok;
  }
  if (c.phase_g != 0) {
    volume.child("phase") = Node(*phase_family().find("henyey_greenstein"));
    // The phase function's range ends at 0.9999; the data allow that to be clamped.
    if (const auto ok = volume.child("phase").set("g", std::clamp(c.phase_g, -0.9999, 0.9999)); !ok) return ok;
  }
  scene.list("volumes").push_back(std::move(volume));
  return {};
}

Result<void> add_light_of(const ReferenceCase& c, bool visible, Node& scene) {
  if (c.light.type.empty()) return {};
  const ParamTable* table = light_family().find(c.light.type);
  if (!table) return bad_input("there is no light \"" + c.light.type + "\"");
  Node light(*table);
  if (const auto ok = copy_numbers(c.light, light); !ok) return ok;
  if (const auto ok = light.set("visible_to_camera", visible); !ok) return ok;
  scene.list("lights").push_back(std::move(light));
  return {};
}

}  // namespace

Result<Node> describe(const ReferenceCase& c, const ReferenceQuantity& quantity, const ReferenceSettings& settings) {
  Node scene(*scene_family().tables.front());
  Node& render = scene.child("render");
  const ParamTable* integrator = scene_family().tables.front()->find_slot("render")->family->find(settings.integrator);
  if (!integrator) return bad_input("there is no integrator \"" + settings.integrator + "\"");
  render = Node(*integrator);
  const bool has_modes = integrator->find("distance_sampling"), marches = integrator->find("step_size");
  const auto steps = {
      add_volume_of(c, scene),
      quantity.measured == Measured::OpticalDepth ? Result<void>() : add_light_of(c, quantity.background, scene),
      has_modes ? render.set("distance_sampling", std::string(name_of(settings.distance_sampling))) : Result<void>(),
      render.set("bounces", std::int64_t{quantity.bounces}),
      render.set("light_samples", std::int64_t{1}),
      render.set("sampler", std::string(settings.sampler == SamplerKind::Sobol ? "sobol" : "independent")),
      render.set("seed", static_cast<std::int64_t>(settings.seed)),
      settings.step_size > 0 && marches ? render.set("step_size", settings.step_size) : Result<void>(),
  };
  for (const auto& step : steps)
    if (!step) return step.error();
  return scene;
}

Channels ReferenceEstimate::relative_deviation() const {
  Channels out = {};
  for (std::size_t k = 0; k < 3; ++k)
    if (mean[k] != 0) out[k] = standard_error[k] * std::sqrt(static_cast<double>(samples)) / std::abs(mean[k]);
  return out;
}

Result<ReferenceProbe> ReferenceProbe::make(const ReferenceCase& c, const ReferenceQuantity& quantity,
                                            const ReferenceSettings& settings) {
  const auto description = describe(c, quantity, settings);
  if (!description) return description.error();
  SceneCache cache;
  auto scene = commit(*description, cache, {});
  if (!scene) return scene.error();

  ReferenceProbe probe;
  probe.scene_ = std::move(*scene);
  probe.integrator_ = make_integrator(*probe.scene_);
  probe.arena_ = std::make_unique<Arena>();
  const ReferenceRay& ray = quantity.ray;
  probe.ray_ = {Vec3(ray.origin - probe.scene_->origin),
                Vec3(ray.direction),
                {static_cast<float>(ray.tmin), static_cast<float>(ray.tmax)}};
  // The background is where the ray ends at no surface; all media end before tmax in the data.
  if (quantity.background) probe.ray_.span.end = std::numeric_limits<float>::infinity();
  probe.scale_ = quantity.scale;
  const bool takes_turns = settings.integrator == "decoupled" && settings.distance_sampling == DistanceSampling::Mis &&
                           probe.scene_->needs.equiangular;
  probe.passes_ = takes_turns ? 2 : 1;
  return probe;
}

namespace {

/// Three running means in one.
struct Accumulator {
  double count = 0;
  Channels mean = {}, m2 = {};
  void add(const Channels& x) {
    ++count;
    for (std::size_t k = 0; k < 3; ++k) {
      const double delta = x[k] - mean[k];
      mean[k] += delta / count;
      m2[k] += delta * (x[k] - mean[k]);
    }
  }
  ReferenceEstimate estimate(std::uint64_t non_finite) const {
    ReferenceEstimate out{mean, {}, static_cast<std::uint64_t>(count), non_finite, 0};
    for (std::size_t k = 0; k < 3; ++k)
      out.standard_error[k] =
          count > 1 ? std::sqrt(m2[k] / (count * (count - 1))) : std::numeric_limits<double>::infinity();
    return out;
  }
};

}  // namespace

namespace {

/// Mean of `sample` over `samples` samples of `passes` passes each.
/// @param sample  Color(SampleContext&)
template <class F>
ReferenceEstimate estimate(const Scene& scene, Arena& arena, std::uint64_t samples, int passes, double scale,
                           const F& sample) {
  Accumulator sum;
  RayStatistics statistics;
  std::uint64_t non_finite = 0;
  for (std::uint64_t i = 0; i < samples; ++i) {
    Channels total = {};
    bool finite = true;
    for (int p = 0; p < passes; ++p) {
      // A sampler counts 2^32 passes of a pixel; enough for any run.
      const Sampler sampler(scene.render.sampler, scene.render.seed, 0, static_cast<std::uint32_t>(i) * passes + p);
      SampleContext context{scene, sampler, arena, statistics};
      const Color c = sample(context);
      finite &= is_finite(c);
      for (int k = 0; k < 3; ++k) total[static_cast<std::size_t>(k)] += scale * static_cast<double>(c[k]) / passes;
    }
    if (finite)
      sum.add(total);
    else
      ++non_finite;
  }
  ReferenceEstimate result = sum.estimate(non_finite);
  const double work = static_cast<double>(statistics.rays + statistics.shadow_rays) +
                      static_cast<double>(statistics.march.lookups) / 16;
  result.work = work / static_cast<double>(samples);
  return result;
}

}  // namespace

ReferenceEstimate ReferenceProbe::radiance(std::uint64_t samples) {
  return estimate(*scene_, *arena_, samples, passes_, scale_,
                  [&](SampleContext& context) { return integrator_->radiance(ray_, context); });
}

ReferenceEstimate ReferenceProbe::flux(std::uint64_t samples) {
  const Frame frame(ray_.direction);
  const Vec3 entry = ray_.at(1);  // the ray begins one unit before the face
  return estimate(*scene_, *arena_, samples, passes_, scale_, [&](SampleContext& context) {
    const Vec2 disc = uniform_disc(context.sampler.u2(Decision::Pixel));
    const float up = std::sqrt(std::max(1e-6f, 1 - disc.x * disc.x - disc.y * disc.y));
    const Vec3 direction = frame.to_world({disc.x, disc.y, up});
    return integrator_->radiance({entry - direction, direction, ray_.span}, context);
  });
}

ReferenceEstimate ReferenceProbe::transmittance(std::uint64_t samples) {
  return estimate(*scene_, *arena_, samples, 1, 1, [&](SampleContext& context) {
    RayDiagnostics met;
    context.diagnostics = &met;
    static_cast<void>(integrator_->radiance(ray_, context));
    return met.transmittance;
  });
}

ReferenceEstimate ReferenceProbe::optical_depth(std::uint64_t offsets) {
  Accumulator sum;
  RayStatistics statistics;
  for (std::uint64_t i = 0; i < offsets; ++i) {
    const Sampler sampler(scene_->render.sampler, scene_->render.seed, 0, static_cast<std::uint32_t>(i));
    RayDiagnostics met;
    SampleContext context{*scene_, sampler, *arena_, statistics, &met};
    static_cast<void>(integrator_->radiance(ray_, context));
    Channels sample = {};
    for (int k = 0; k < 3; ++k) sample[static_cast<std::size_t>(k)] = static_cast<double>(met.optical_depth[k]);
    sum.add(sample);
  }
  return sum.estimate(0);
}

}  // namespace brume
