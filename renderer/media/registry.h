// The shaders a scene file can name.
#pragma once

#include "renderer/geometry/shape.h"
#include "renderer/media/grid_cache.h"
#include "renderer/media/shader.h"
#include "renderer/params/node.h"

namespace brume {

/// What a shader is made with.
struct ShaderContext {
  Affined local_from_scene;  ///< inverse of the volume's transform, seen from the scene's origin
  GridCache& grids;
  LoadOptions load_options;
};

/// A shader and, where it brings its own bounds (a grid's box), these.
struct MadeShader {
  std::shared_ptr<const Shader> shader;
  std::shared_ptr<const Shape> shape = nullptr;  ///< null: the volume's "bounds"
  Affined shape_from_scene = {};
  std::vector<std::string> warnings = {};
};

struct ShaderType {
  std::string key, label, doc;
  std::vector<Param> params;  ///< what makes this shader special; a volume adds what all volumes have
  bool brings_bounds;
  /// @param volume  has `params`.  Errors name the key.
  Result<MadeShader> (*make)(const Node& volume, const ShaderContext& context);
  bool bakes = false;  ///< dearer to compute than to look up on voxels: see bake.h
};

const std::vector<ShaderType>& shader_types();

// One entry per shader, each defined beside it.
ShaderType vdb_shader_type();
ShaderType homogeneous_shader_type();
ShaderType cloud_shader_type();
std::vector<ShaderType> profile_shader_types();

}  // namespace brume
