#include "renderer/phase/registry.h"

#include "renderer/core/check.h"
#include "renderer/phase/henyey_greenstein.h"
#include "renderer/phase/isotropic.h"

namespace brume {
namespace {

const ParamTable& isotropic_table() {
  static const ParamTable table{"isotropic", "Isotropic", "Scatters the same in all directions.", {}, {}};
  return table;
}

const ParamTable& henyey_greenstein_table() {
  static const ParamTable table{
      "henyey_greenstein",
      "Henyey-Greenstein",
      "One lobe whose mean cosine is g.",
      {param::number("g", "Mean cosine g", 0)
           .between(-0.999, 0.999)
           .says("Mean cosine of the scattering angle: above 0 light goes on forwards, below 0 it is thrown back.")},
      {}};
  return table;
}

}  // namespace

const std::vector<PhaseType>& phase_types() {
  static const std::vector<PhaseType> types{
      {&isotropic_table(),
       [](const Node&) -> std::unique_ptr<const PhaseFunction> { return std::make_unique<Isotropic>(); }},
      {&henyey_greenstein_table(),
       [](const Node& n) -> std::unique_ptr<const PhaseFunction> {
         return std::make_unique<HenyeyGreenstein>(static_cast<float>(n.number("g")));
       }},
  };
  return types;
}

const Family& phase_family() {
  static const Family family = [] {
    Family f{"phase function", "type", {}};
    for (const PhaseType& t : phase_types()) f.tables.push_back(t.table);
    return f;
  }();
  return family;
}

std::unique_ptr<const PhaseFunction> make_phase(const Node& node) {
  for (const PhaseType& t : phase_types())
    if (t.table == &node.table()) return t.make(node);
  BRUME_CHECK(node.kind(), ==, "a phase function");
  return nullptr;
}

}  // namespace brume
