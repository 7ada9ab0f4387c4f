#include "tests/support/reference_case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/lights/registry.h"
#include "renderer/phase/registry.h"
#include "renderer/sampling/warps.h"
#include "renderer/scene/volume.h"

namespace brume {
namespace {

using Json = nlohmann::json;

// ---- Reading --------------------------------------------------------------------------------------------------------

std::vector<double> numbers_of(const Json& value) {
  if (value.is_array()) return value.get<std::vector<double>>();
  if (value.is_boolean()) return {value.get<bool>() ? 1.0 : 0.0};
  return {value.get<double>()};
}

ReferenceKind kind_of(const Json& object) {
  ReferenceKind kind;
  if (object.is_null()) return kind;
  for (const auto& [key, value] : object.items()) {
    if (key == "type")
      kind.type = value.get<std::string>();
    else
      kind.numbers[key] = numbers_of(value);
  }
  return kind;
}

Vec3d vec_of(const Json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

/// Three channels; a single number stands for three equal ones.
Channels channels_of(const Json& value) {
  if (value.is_number()) return {value.get<double>(), value.get<double>(), value.get<double>()};
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

ReferenceRay ray_of(const Json& value) {
  return {vec_of(value.at("origin")), vec_of(value.at("direction")), value.at("tmin").get<double>(),
          value.at("tmax").get<double>()};
}

bool given(const Json& object, const char* key) { return object.contains(key) && !object.at(key).is_null(); }

/// "orders 1..3" and so on from a list of radiances by order: a render with B bounces holds orders 1 to B + 1.
void add_orders(ReferenceCase& c, const ReferenceRay& ray, const Json& expected, double relative_error,
                const std::string& where) {
  if (given(expected, "radiance_by_order")) {
    const auto by_order = expected.at("radiance_by_order").get<std::vector<double>>();
    std::vector<double> deviations(by_order.size(), 0.0);
    if (given(expected, "std_error_by_order"))
      deviations = expected.at("std_error_by_order").get<std::vector<double>>();
    double sum = 0, variance = 0;
    for (std::size_t k = 0; k < by_order.size(); ++k) {
      sum += by_order[k];
      variance += deviations[k] * deviations[k];
      ReferenceQuantity q;
      q.name = where + (k == 0 ? "order 1" : "orders 1.." + std::to_string(k + 1));
      q.ray = ray;
      q.expected = {sum, sum, sum};
      q.reference_error = given(expected, "std_error_by_order") ? 0 : relative_error;
      q.reference_deviation = std::sqrt(variance);
      q.bounces = static_cast<int>(k);
      c.quantities.push_back(q);
    }
  }
  for (const bool background : {false, true}) {
    const char* key = background ? "radiance_total_with_background" : "radiance_total";
    if (!given(expected, key)) continue;
    ReferenceQuantity q;
    q.name = where + (background ? "all orders + background" : "all orders");
    q.ray = ray;
    q.expected = channels_of(expected.at(key));
    q.reference_error = given(expected, "std_error_total") ? 0 : relative_error;
    if (given(expected, "std_error_total")) q.reference_deviation = expected.at("std_error_total").get<double>();
    q.bounces = kUnlimitedBounces;
    q.background = background;
    c.quantities.push_back(q);
  }
}

/// Fluxes of a slab 0 <= z <= b, and the radiances that tables of slabs print as R(mu), T(mu): R mu0 E / pi.
void add_fluxes(ReferenceCase& c, const Json& expected, double relative_error) {
  if (c.light.type != "directional" || c.bounds.type != "box" || !given(expected, "R_total")) return;
  const double top = c.bounds.numbers.at("min")[2], bottom = c.bounds.numbers.at("max")[2];
  const double mu0 = c.light.numbers.at("direction")[2], irradiance = c.light.numbers.at("irradiance")[0];
  const auto quantity = [&](const std::string& name, bool reflected, double mu, double value, int bounces) {
    ReferenceQuantity q;
    q.name = name;
    const double face = reflected ? top : bottom, towards = reflected ? 1.0 : -1.0;
    const Vec3d direction{std::sqrt(1 - mu * mu), 0, mu * towards};
    q.ray = {Vec3d(0, 0, face) - direction, direction, 0, 1e9};
    q.expected = {value, value, value};
    q.reference_error = relative_error;
    q.bounces = bounces;
    return q;
  };
  const auto flux = [&](const std::string& name, bool reflected, double value, int bounces) {
    ReferenceQuantity q = quantity(name, reflected, 1, value, bounces);
    q.measured = Measured::Flux;
    q.scale = 3.14159265358979323846 / (mu0 * irradiance);
    c.quantities.push_back(q);
  };
  const char* const totals[2] = {"R_total", "T_diffuse"};
  const char* const by_order[2] = {"R_by_order", "T_diffuse_by_order"};
  for (const bool reflected : {true, false}) {
    const std::string name = reflected ? "R" : "T";
    if (given(expected, totals[reflected ? 0 : 1]))
      flux("flux " + name + ", all orders", reflected, expected.at(totals[reflected ? 0 : 1]).get<double>(),
           kUnlimitedBounces);
    if (given(expected, by_order[reflected ? 0 : 1])) {
      double sum = 0;
      int order = 0;
      for (const double v : expected.at(by_order[reflected ? 0 : 1]).get<std::vector<double>>()) {
        sum += v;
        ++order;
        flux("flux " + name + ", orders 1.." + std::to_string(order), reflected, sum, order - 1);
      }
    }
    for (const auto& [key, value] : expected.items()) {
      if (!key.starts_with(name + "_mu_")) continue;
      const double mu = std::stod(key.substr(5));
      ReferenceQuantity q = quantity(key + ", all orders", reflected, mu, value.get<double>(), kUnlimitedBounces);
      q.scale = 3.14159265358979323846 / (mu0 * irradiance);
      c.quantities.push_back(q);
    }
  }
}

ReferenceCase case_of(const Json& j) {
  ReferenceCase c;
  c.id = j.at("id").get<std::string>();
  c.description = j.value("description", "");
  c.tags = j.value("tags", std::vector<std::string>());
  c.property = j.value("property", "");
  const Json& medium = j.at("medium");
  c.bounds = kind_of(medium.at("bounds"));
  c.density = kind_of(medium.at("density"));
  c.sigma_s = channels_of(medium.at("sigma_s"));
  c.sigma_a = channels_of(medium.at("sigma_a"));
  if (given(medium, "emission")) c.emission = channels_of(medium.at("emission"));
  if (given(j, "light")) c.light = kind_of(j.at("light"));
  c.phase_g = given(j, "phase_g") ? j.at("phase_g").get<double>() : 0.0;
  if (given(j, "ray")) c.ray = ray_of(j.at("ray"));
  if (!c.property.empty() || !given(j, "expected")) return c;
  const Json& expected = j.at("expected");
  const double error = given(j, "relative_error_bound") ? j.at("relative_error_bound").get<double>() : 0.0;

  if (given(j, "ray")) {
    const ReferenceRay ray = ray_of(j.at("ray"));
    ReferenceQuantity q;
    q.ray = ray;
    q.reference_error = error;
    if (given(expected, "optical_depth")) {
      q.name = "optical_depth";
      q.measured = Measured::OpticalDepth;
      q.expected = channels_of(expected.at("optical_depth"));
      c.quantities.push_back(q);
      q.measured = Measured::Radiance;
    }
    if (given(expected, "radiance")) {
      q.name = j.at("order") == 0 ? "emission" : "order 1";
      q.expected = channels_of(expected.at("radiance"));
      c.quantities.push_back(q);
    }
    if (given(expected, "radiance_with_background")) {
      q.name = "order 1 + background";
      q.expected = channels_of(expected.at("radiance_with_background"));
      q.background = true;
      c.quantities.push_back(q);
    }
    add_orders(c, ray, expected, error, "");
  }
  add_fluxes(c, expected, error);
  if (given(expected, "rays"))
    for (const Json& view : expected.at("rays")) {
      char where[64];
      std::snprintf(where, sizeof where, "%s mu %g, ", view.at("side").get<std::string>().c_str(),
                    view.at("mu").get<double>());
      add_orders(c, ray_of(view.at("ray")), view, error, where);
    }
  return c;
}

// ---- Numbers of a kind ----------------------------------------------------------------------------------------------

double real(const ReferenceKind& kind, const char* key) { return kind.numbers.at(key).at(0); }

Vec3d vec(const ReferenceKind& kind, const char* key) {
  const auto& v = kind.numbers.at(key);
  return {v.at(0), v.at(1), v.at(2)};
}

}  // namespace

bool ReferenceCase::has_tag(const std::string& tag) const {
  return std::find(tags.begin(), tags.end(), tag) != tags.end();
}

Result<std::vector<ReferenceCase>> read_reference_cases(const std::string& path) {
  std::ifstream file(path);
  if (!file) return bad_input("found no readable file, expected reference cases", {path, 0, 0, ""});
  try {
    std::vector<ReferenceCase> cases;
    const Json document = Json::parse(file);
    for (const Json& j : document.at("cases")) cases.push_back(case_of(j));
    return cases;
  } catch (const std::exception& e) {
    return bad_input(std::string("found ") + e.what() + ", expected reference cases", {path, 0, 0, ""});
  }
}

// ---- The medium in double -------------------------------------------------------------------------------------------

double reference_density(const ReferenceCase& c, Vec3d x) {
  const ReferenceKind& d = c.density;
  if (d.type == "constant") return 1;
  if (d.type == "exponential")
    return std::exp(-(x[static_cast<int>(real(d, "axis"))] - real(d, "y0")) / real(d, "scale_height"));
  if (d.type == "gaussian")
    return std::exp(-length_squared(x - vec(d, "center")) / (2 * real(d, "sigma") * real(d, "sigma")));
  if (d.type == "linear") return real(d, "offset") + dot(vec(d, "gradient"), x);
  if (d.type == "slabs") {
    const auto& edges = d.numbers.at("edges");
    const double at = x[static_cast<int>(real(d, "axis"))];
    for (std::size_t i = 0; i + 1 < edges.size(); ++i)
      if (at >= edges[i] && at < edges[i + 1]) return d.numbers.at("values")[i];
    return 0;
  }
  if (d.type == "shell") {
    const double r = length(x - vec(d, "center"));
    return r >= real(d, "r_inner") && r <= real(d, "r_outer") ? 1 : 0;
  }
  if (d.type == "sinusoid")
    return 1 + real(d, "amplitude") *
                   std::sin(2 * 3.14159265358979323846 * dot(vec(d, "wavevector"), x) + real(d, "phase"));
  return std::nan("");
}

namespace {

/// @param grow  added to the bounds on all sides
ReferenceSpan span_of(const ReferenceCase& c, const ReferenceRay& ray, double grow) {
  ReferenceSpan span{ray.tmin, ray.tmax};
  if (c.bounds.type == "sphere") {
    const Vec3d to_center = vec(c.bounds, "center") - ray.origin;
    const double middle = dot(to_center, ray.direction), radius = real(c.bounds, "radius") + grow;
    const double rest = radius * radius - length_squared(to_center - ray.direction * middle);
    if (rest <= 0) return {0, 0};
    return {std::max(span.begin, middle - std::sqrt(rest)), std::min(span.end, middle + std::sqrt(rest))};
  }
  const Vec3d low = vec(c.bounds, "min") - Vec3d(grow), high = vec(c.bounds, "max") + Vec3d(grow);
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (o < low[axis] || o > high[axis]) return {0, 0};
      continue;
    }
    const double a = (low[axis] - o) / d, b = (high[axis] - o) / d;
    span.begin = std::max(span.begin, std::min(a, b));
    span.end = std::min(span.end, std::max(a, b));
  }
  return span;
}

/// Half a unit in the last place of a float near v.
double half_ulp(double v) { return std::abs(v) * 0x1p-24; }

}  // namespace

ReferenceSpan reference_span(const ReferenceCase& c, const ReferenceRay& ray) { return span_of(c, ray, 0); }

double density_variation(const ReferenceCase& c, const ReferenceRay& ray) {
  const ReferenceSpan span = reference_span(c, ray);
  if (!c.heterogeneous() || span.length() == 0) return 0;
  constexpr int kPoints = 100000;  // far finer than any profile of the data: 64 cycles per unit over 2 units
  double sum = 0, last = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = span.begin + (i + 0.5) / kPoints * span.length();
    const double density = reference_density(c, ray.origin + ray.direction * t);
    if (i > 0) sum += std::abs(density - last);
    last = density;
  }
  return sum;
}

double column_rounding(const ReferenceCase& c, const ReferenceRay& ray) {
  const ReferenceSpan span = reference_span(c, ray);
  double size = 1e-30;  // of the coordinates that the medium is known by
  for (const auto& [key, value] : c.bounds.numbers)
    for (const double v : value) size = std::max(size, std::abs(v));

  // Length of the span: one rounded coordinate of the ray after the other, and the bounds.
  double length_error = 2 * half_ulp(span.end);  // its ends are floats
  for (int axis = 0; axis < 3; ++axis) {
    ReferenceRay moved = ray;
    moved.origin[axis] += half_ulp(ray.origin[axis]);
    length_error += std::abs(reference_span(c, moved).length() - span.length());
    moved = ray;
    moved.direction[axis] += half_ulp(ray.direction[axis]);
    length_error += std::abs(reference_span(c, moved).length() - span.length());
  }
  length_error += std::abs(span_of(c, ray, half_ulp(size)).length() - span.length());

  // A displacement of every look-up by e changes the integral by at most e times the variation of the density.
  double peak = 0;
  for (const double t : {span.begin, span.end})
    peak = std::max(peak, reference_density(c, ray.origin + ray.direction * t));
  const double displacement = 2 * half_ulp(span.end) + 2 * half_ulp(size);
  return length_error * (c.heterogeneous() ? peak : 1.0) + displacement * density_variation(c, ray);
}

// ---- Rendering ------------------------------------------------------------------------------------------------------

const char* name_of(DistanceSampling mode) {
  return mode == DistanceSampling::Density ? "density" : mode == DistanceSampling::Equiangular ? "equi_angular" : "mis";
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

// ---- Judging --------------------------------------------------------------------------------------------------------

std::string CaseResult::to_string() const {
  char text[512];
  std::snprintf(text, sizeof text,
                "%-34s %-24s %-12s %c  expected %.7g  mean %.7g +- %.2g (%.3f %%)  z %+.2f  allowed %.3g = %.3g noise "
                "+ %.3g float + %.3g "
                "reference + %.3g bias  %llu samples%s%s",
                id.c_str(), quantity.c_str(), mode.c_str(), "RGB"[channel], expected, mean, standard_error,
                expected != 0 ? 100 * standard_error / std::abs(expected) : 0.0, z, tolerance.total(),
                tolerance.statistical, tolerance.floating, tolerance.reference, tolerance.bias,
                static_cast<unsigned long long>(samples), non_finite ? "  NOT FINITE: " : "",
                non_finite ? std::to_string(non_finite).c_str() : "");
  return text;
}

CaseResult judge(const ReferenceCase& c, const ReferenceQuantity& quantity, const std::string& mode, int channel,
                 const ReferenceEstimate& estimate, double allowed_z, double floating, double bias) {
  const auto k = static_cast<std::size_t>(channel);
  CaseResult r;
  r.id = c.id;
  r.quantity = quantity.name;
  r.mode = mode;
  r.channel = channel;
  r.expected = quantity.expected[k];
  r.mean = estimate.mean[k];
  r.samples = estimate.samples;
  r.non_finite = estimate.non_finite;
  // The noise of a reference made by Monte Carlo adds to ours.
  r.standard_error = std::hypot(estimate.standard_error[k], quantity.reference_deviation);
  r.tolerance = {allowed_z * r.standard_error, floating, quantity.reference_error * std::abs(r.expected), bias};
  const double difference = r.mean - r.expected;
  const double excess = std::max(0.0, std::abs(difference) - (r.tolerance.total() - r.tolerance.statistical));
  r.z = excess == 0 ? 0 : std::copysign(r.standard_error > 0 ? excess / r.standard_error : 1e9, difference);
  r.passed = std::abs(difference) <= r.tolerance.total() && estimate.non_finite == 0;
  return r;
}

}  // namespace brume
