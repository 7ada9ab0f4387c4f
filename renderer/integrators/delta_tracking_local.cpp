#include "renderer/integrators/delta_tracking.h"
#include "renderer/integrators/registry.h"

namespace brume {

/// The same walk through the scene's majorants, which have as many cells as the table's parameter says: Yue, Iwasaki,
/// Chen, Dobashi & Nishita 2010, "Unbiased, Adaptive Stochastic Sampling for Rendering Inhomogeneous Participating
/// Media" (there in a kd-tree; here in a grid, by a 3D digital differential analyser).
IntegratorType delta_tracking_local_integrator_type() {
  return {integrator_table("delta_tracking_local", "Delta tracking, local majorants",
                           "Unbiased rejection with a majorant for every cell of a grid (Yue 2010).",
                           {light_params(), majorant_params(), path_params(), random_params()}),
          make_as<DeltaTrackingIntegrator>};
}

}  // namespace brume
