#include "renderer/surfaces/material.h"

namespace brume {
namespace {

const ParamTable& diffuse_table() {
  static const ParamTable table{"diffuse",
                                "Diffuse",
                                "Reflects light evenly to all sides (Lambert).",
                                {param::color("albedo", "Albedo", 0.5, 0.5, 0.5)
                                     .between(0, 1)
                                     .says("Share of the light that is reflected; the rest is absorbed.")},
                                {}};
  return table;
}

const ParamTable& emissive_table() {
  static const ParamTable table{
      "emissive",
      "Emissive",
      "Glows and lights the scene; reflects nothing.",
      {param::color("radiance", "Radiance", 4, 4, 4).slider(0, 50).in("W/(sr m^2)").says("Radiance of the lit side."),
       param::flag("two_sided", "Two-sided", false).says("Whether the back glows too.")},
      {}};
  return table;
}

const ParamTable& holdout_table() {
  static const ParamTable table{"holdout",
                                "Holdout",
                                "Black: hides what is behind it and casts shadows, so that it can be laid in later.",
                                {},
                                {}};
  return table;
}

}  // namespace

const Family& material_family() {
  static const Family family{"material", "type", {&diffuse_table(), &emissive_table(), &holdout_table()}};
  return family;
}

Material make_material(const Node& node) {
  Material m;
  if (&node.table() == &diffuse_table()) m.albedo = node.color("albedo");
  if (&node.table() == &emissive_table()) m.radiance = node.color("radiance"), m.two_sided = node.flag("two_sided");
  return m;
}

}  // namespace brume
