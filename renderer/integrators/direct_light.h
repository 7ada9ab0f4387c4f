// Third step of the decoupled march: light samples on the record.
#pragma once

#include "renderer/integrators/marched_shadows.h"
#include "renderer/march/product_sampling.h"

namespace brume {

/// Light samples of the radiance that is scattered once along the recorded ray from the scene's lights towards its
/// origin, for the throughput `beta` at its start. Every one is a shadow ray, left to `shadows`: a point of the light
/// is drawn first, then a distance by density sampling, by equi-angular sampling about that very point, by one of each
/// weighted by MIS, or by product sampling about the light's middle (lights without one: by density sampling).
/// @param record  distributed, with scattered() > 0.  @param bounce  scattered rays so far.  @param samples  of each
/// light
template <int C>
void direct_light(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, int samples,
                  SampleContext& context, MarchedShadows<C>& shadows);

/// Product sampling of the ray for one light, which lives in the arena scope that is open.
/// @param record  distributed, with scattered() > 0.  @param p  its scattered_by_segment().  @param pivot  the light's
template <int C>
ProductSampling<C> product_sampling(const MarchRecord<C>& record, const float* p, const Ray& ray, const Scene& scene,
                                    const Light& light, const LightPivot& pivot, Arena& arena);

}  // namespace brume
