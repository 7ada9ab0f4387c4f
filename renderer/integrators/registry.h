// The integrators a scene file can name, and the tables of a whole scene.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/params/node.h"

namespace brume {

struct IntegratorType {
  ParamTable table;
  /// Prepares rendering of a scene. Most integrators need no preparation.
  std::unique_ptr<const Integrator> (*make)(const Scene& scene);
};

const std::vector<IntegratorType>& integrator_types();

/// The integrator that the scene names, ready for that scene.
std::unique_ptr<const Integrator> make_integrator(const Scene& scene);

/// The family of whole scene descriptions: Node(*scene_family().tables.front()) is an empty scene.
const Family& scene_family();

/// A table of groups of parameters.
ParamTable integrator_table(std::string key, std::string label, std::string doc,
                            std::vector<std::vector<Param>> groups);

template <class Kind> std::unique_ptr<const Integrator> make_as(const Scene&) { return std::make_unique<Kind>(); }

// One entry per integrator, each defined beside it.
IntegratorType decoupled_integrator_type();
IntegratorType ray_march_integrator_type();
IntegratorType ray_march_cached_integrator_type();
IntegratorType stochastic_march_integrator_type();
IntegratorType delta_tracking_integrator_type();
IntegratorType delta_tracking_local_integrator_type();
IntegratorType null_scattering_integrator_type();

}  // namespace brume
