// Quantities of a reference case, rendered.
#pragma once

#include "renderer/engine/engine.h"
#include "renderer/integrators/registry.h"
#include "tests/support/reference_case.h"

namespace brume {

struct ReferenceSettings {
  std::string integrator = "decoupled";
  DistanceSampling distance_sampling = DistanceSampling::Mis;  ///< where the integrator has a choice
  double step_size = 0;                                        ///< world units; 0: the medium's own
  SamplerKind sampler = SamplerKind::Independent;
  std::uint64_t seed = 1;
};

const char* name_of(DistanceSampling mode);

/// The scene description of one quantity of a case. The error says what Brume cannot express.
Result<Node> describe(const ReferenceCase& c, const ReferenceQuantity& quantity, const ReferenceSettings& settings);

struct ReferenceEstimate {
  Channels mean = {}, standard_error = {};
  std::uint64_t samples = 0;  ///< finite ones
  std::uint64_t non_finite = 0;
  double work = 0;  ///< of one sample, in rays: look-ups count for a sixteenth

  /// Standard deviation of a single sample over the mean; 0 where the mean is 0.
  Channels relative_deviation() const;
};

/// A quantity of a case, ready to be measured. Not to be shared between threads.
class ReferenceProbe {
 public:
  static Result<ReferenceProbe> make(const ReferenceCase& c, const ReferenceQuantity& quantity,
                                     const ReferenceSettings& settings);

  /// Radiance along the ray: Welford mean of `samples` samples. In MIS with a single light sample the techniques take
  /// turns between passes, so a sample is then the mean of two passes: halves of one estimator, not two estimators.
  ReferenceEstimate radiance(std::uint64_t samples);

  /// The same over a hemisphere of rays, weighted by the cosine with the quantity's ray: the flux, over pi.
  ReferenceEstimate flux(std::uint64_t samples);

  /// Transmittance as the integrator reports it.
  ReferenceEstimate transmittance(std::uint64_t samples);

  /// Optical depth as the integrator reports it, mean over `offsets` positions of the march's look-ups. With the Sobol'
  /// sampler and a power of two each of that many equal parts of a step gets one look-up, so the standard error (which
  /// assumes independence) is an upper bound.
  ReferenceEstimate optical_depth(std::uint64_t offsets);

 private:
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<const Integrator> integrator_;
  std::unique_ptr<Arena> arena_;
  Ray ray_;
  double scale_ = 1;
  int passes_ = 1;
};

}  // namespace brume
