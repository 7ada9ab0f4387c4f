// Third step of the decoupled march: light samples on the record.
#pragma once

#include "renderer/integrators/integrator.h"

namespace brume {

/// Radiance scattered once along the recorded ray from the scene's lights towards its origin, for the throughput
/// `beta` at its start. Every light sample is one shadow ray: a point of the light is drawn first, then a distance by
/// density sampling, by equi-angular sampling about that very point, or by one of each weighted by MIS.
/// @param record  distributed, with scattered() > 0.  @param bounce  scattered rays so far
template <int C>
Color direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context);

}  // namespace brume
