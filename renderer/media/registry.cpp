#include "renderer/media/registry.h"

namespace brume {

const std::vector<ShaderType>& shader_types() {
  static const std::vector<ShaderType> types = [] {
    std::vector<ShaderType> all{vdb_shader_type(), homogeneous_shader_type(), cloud_shader_type()};
    for (ShaderType& t : profile_shader_types()) all.push_back(std::move(t));
    return all;
  }();
  return types;
}

}  // namespace brume
