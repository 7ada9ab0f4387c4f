#include "renderer/integrators/registry.h"

#include "renderer/core/check.h"

namespace brume {

RayStatistics& RayStatistics::operator+=(const RayStatistics& other) {
  rays += other.rays;
  shadow_rays += other.shadow_rays;
  non_finite += other.non_finite;
  march.lookups += other.march.lookups;
  march.segments += other.march.segments;
  march.capped += other.march.capped;
  march.exceeded += other.march.exceeded;
  return *this;
}

const std::vector<IntegratorType>& integrator_types() {
  static const std::vector<IntegratorType> types{
      decoupled_integrator_type(),        ray_march_integrator_type(),      ray_march_cached_integrator_type(),
      stochastic_march_integrator_type(), delta_tracking_integrator_type(), delta_tracking_local_integrator_type(),
      null_scattering_integrator_type()};
  return types;
}

std::unique_ptr<const Integrator> make_integrator(const Scene& scene) {
  for (const IntegratorType& t : integrator_types())
    if (t.table.key == scene.render.integrator) return t.make(scene);
  BRUME_CHECK(scene.render.integrator, ==, "an integrator");
  return nullptr;
}

ParamTable integrator_table(std::string key, std::string label, std::string doc,
                            std::vector<std::vector<Param>> groups) {
  ParamTable table{std::move(key), std::move(label), std::move(doc), {}, {}};
  for (auto& group : groups)
    for (Param& p : group) table.params.push_back(std::move(p));
  return table;
}

const Family& scene_family() {
  static const Family render_family = [] {
    Family f{"integrator", "integrator", {}};
    for (const IntegratorType& t : integrator_types()) f.tables.push_back(&t.table);
    return f;
  }();
  static const ParamTable table = scene_table(render_family);
  static const Family family{"scene", "", {&table}};
  return family;
}

}  // namespace brume
