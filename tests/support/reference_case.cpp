#include "tests/support/reference_case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace brume {
namespace {

using Json = nlohmann::json;

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

}  // namespace

double real(const ReferenceKind& kind, const char* key) { return kind.numbers.at(key).at(0); }

Vec3d vec(const ReferenceKind& kind, const char* key) {
  const auto& v = kind.numbers.at(key);
  return {v.at(0), v.at(1), v.at(2)};
}

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

}  // namespace brume
