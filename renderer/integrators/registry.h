// The integrators a scene file can name, and the tables of a whole scene.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/params/node.h"

namespace brume {

struct IntegratorType {
  ParamTable table;
  std::unique_ptr<const Integrator> (*make)();
};

const std::vector<IntegratorType>& integrator_types();

/// @param key  of one of integrator_types()
std::unique_ptr<const Integrator> make_integrator(const std::string& key);

/// The family of whole scene descriptions: Node(*scene_family().tables.front()) is an empty scene.
const Family& scene_family();

// One entry per integrator, each defined beside it.
IntegratorType decoupled_integrator_type();

}  // namespace brume
