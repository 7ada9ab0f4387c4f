// What a surface does with light.
#pragma once

#include "renderer/core/vec.h"
#include "renderer/params/node.h"

namespace brume {

/// Opaque, the same on both sides unless said otherwise.
struct Material {
  Color albedo;            ///< reflected by Lambert's law, in [0,1]; black: reflects nothing
  Color radiance;          ///< emitted, W/(sr m^2)
  bool two_sided = false;  ///< whether the back emits too

  bool reflects() const { return !is_black(albedo); }
  bool emits() const { return !is_black(radiance); }
};

const Family& material_family();

Material make_material(const Node& node);

}  // namespace brume
