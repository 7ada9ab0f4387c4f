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
  return *this;
}

const std::vector<IntegratorType>& integrator_types() {
  static const std::vector<IntegratorType> types{decoupled_integrator_type()};
  return types;
}

std::unique_ptr<const Integrator> make_integrator(const std::string& key) {
  for (const IntegratorType& t : integrator_types())
    if (t.table.key == key) return t.make();
  BRUME_CHECK(key, ==, "an integrator");
  return nullptr;
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
