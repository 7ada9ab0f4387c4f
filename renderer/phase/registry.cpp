#include "renderer/phase/registry.h"

#include "renderer/core/check.h"
#include "renderer/phase/henyey_greenstein.h"
#include "renderer/phase/isotropic.h"
#include "renderer/phase/phase_mix.h"
#include "renderer/phase/rayleigh.h"

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
           .between(-0.9999, 0.9999)
           .says("Mean cosine of the scattering angle: above 0 light goes on forwards, below 0 it is thrown back.")},
      {}};
  return table;
}

const ParamTable& two_lobe_table() {
  static const ParamTable table{
      "two_lobe",
      "Two lobes",
      "A forward and a backward Henyey-Greenstein lobe, as fits clouds and smoke.",
      {param::number("g", "Forward g", 0.8).between(-0.9999, 0.9999).says("Mean cosine of the first lobe."),
       param::number("g_back", "Backward g", -0.3).between(-0.9999, 0.9999).says("Mean cosine of the second lobe."),
       param::number("back_share", "Backward share", 0.3)
           .between(0, 1)
           .says("Share of the light that the second lobe scatters.")},
      {}};
  return table;
}

const ParamTable& rayleigh_table() {
  static const ParamTable table{
      "rayleigh", "Rayleigh", "Particles far smaller than the wavelength, such as the molecules of air.", {}, {}};
  return table;
}

const ParamTable& draine_table() {
  static const ParamTable table{
      "draine",
      "Draine",
      "Henyey-Greenstein with a second, backward rise: dust. Holds Henyey-Greenstein and Rayleigh as special cases.",
      {param::number("g", "Asymmetry g", 0.5)
           .between(-0.9999, 0.9999)
           .says("Asymmetry of the Henyey-Greenstein factor; the mean cosine is a little larger for a large alpha."),
       param::number("alpha", "Alpha", 1).between(0, 1000).slider(0, 40).says("Weight of the squared cosine.")},
      {}};
  return table;
}

const ParamTable& droplets_table() {
  static const ParamTable table{"droplets",
                                "Water droplets",
                                "Fog and cloud droplets of one size: a fit to Mie scattering (Jendersie & d'Eon 2023).",
                                {param::number("diameter", "Diameter", 10)
                                     .between(1.5, 50)
                                     .in("micrometres")
                                     .says("Of the droplets: haze has small ones, clouds about 10 to 20.")},
                                {}};
  return table;
}

template <class Phase, class... Args> std::unique_ptr<const PhaseFunction> made(Args&&... args) {
  return std::make_unique<Phase>(std::forward<Args>(args)...);
}

float number(const Node& n, const char* key) { return static_cast<float>(n.number(key)); }

}  // namespace

const std::vector<PhaseType>& phase_types() {
  static const std::vector<PhaseType> types{
      {&isotropic_table(), [](const Node&) { return made<Isotropic>(); }},
      {&henyey_greenstein_table(), [](const Node& n) { return made<HenyeyGreenstein>(n.number("g")); }},
      {&two_lobe_table(),
       [](const Node& n) {
         return made<TwoLobe>(HenyeyGreenstein(n.number("g")), HenyeyGreenstein(n.number("g_back")),
                              number(n, "back_share"));
       }},
      {&rayleigh_table(), [](const Node&) { return made<Rayleigh>(); }},
      {&draine_table(), [](const Node& n) { return made<Draine>(n.number("g"), n.number("alpha")); }},
      {&droplets_table(), [](const Node& n) { return made<Droplets>(water_droplets(number(n, "diameter"))); }},
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
