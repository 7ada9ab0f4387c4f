// Reference data for volume lighting: read, made into scenes, measured, judged.
//
// The data are JSON files whose README says what every field means. Reading them, rendering them and deciding whether a
// rendered value is right are three separate steps, so that a program can show values which no test judges.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "renderer/engine/engine.h"
#include "renderer/integrators/registry.h"

namespace brume {

using Channels = std::array<double, 3>;

// ---- Cases ----------------------------------------------------------------------------------------------------------

/// x(t) = origin + t direction, t in [tmin, tmax]; world space.
struct ReferenceRay {
  Vec3d origin, direction;
  double tmin = 0, tmax = 0;
};

/// "constant", "gaussian", ... or "point", "quad", ... with all its numbers by the names that the file gives them
/// (a scalar is a list of one).
struct ReferenceKind {
  std::string type;
  std::map<std::string, std::vector<double>> numbers;
};

/// What a quantity is.
enum class Measured {
  OpticalDepth,
  Radiance,
  Flux,  ///< leaving a slab through one face, over what arrives at it
};

/// One thing to measure.
struct ReferenceQuantity {
  std::string name;  ///< "optical_depth", "emission", "order 1", "orders 1..4", "all orders", "... + background"
  Measured measured = Measured::Radiance;
  ReferenceRay ray;  ///< of a flux: from the middle of the face against its normal
  double scale = 1;  ///< what the measured radiance, or its mean over a hemisphere, is multiplied by
  Channels expected = {};
  double reference_error = 0;      ///< of the expected value, relative ...
  double reference_deviation = 0;  ///< ... or, where it is a Monte Carlo result, its standard error
  int bounces = 0;                 ///< scattered rays that it takes
  bool background = false;         ///< the environment is seen through the medium
};

/// Scattered rays without limit, as far as the parameter goes.
inline constexpr int kUnlimitedBounces = 100000;

struct ReferenceCase {
  std::string id, description;
  std::vector<std::string> tags;
  ReferenceKind bounds;  // "sphere" or "box"
  ReferenceKind density;
  Channels sigma_s = {}, sigma_a = {}, emission = {};
  ReferenceKind light;  // empty type: none
  double phase_g = 0;
  ReferenceRay ray;  ///< the camera's, where there is a single one
  std::vector<ReferenceQuantity> quantities;
  std::string property;  ///< instead of a right number: what must hold

  bool has_tag(const std::string& tag) const;
  bool heterogeneous() const { return density.type != "constant"; }
};

/// The cases of a file, in its order.
Result<std::vector<ReferenceCase>> read_reference_cases(const std::string& path);

// ---- The medium, evaluated in double by formulas of its own, for bounds on errors -----------------------------------

double reference_density(const ReferenceCase& c, Vec3d x);

/// The part of the line inside the bounds and the ray's range; begin >= end where there is none.
struct ReferenceSpan {
  double begin = 0, end = 0;
  double length() const { return end > begin ? end - begin : 0; }
};
ReferenceSpan reference_span(const ReferenceCase& c, const ReferenceRay& ray);

/// Sum of |changes| of the density along the ray inside the bounds; without the jumps at its ends.
double density_variation(const ReferenceCase& c, const ReferenceRay& ray);

/// How far float arithmetic can move the column density of this ray: half a unit in the last place of every coordinate
/// of the ray and of the bounds, and of the positions along the ray at which the density is looked up.
double column_rounding(const ReferenceCase& c, const ReferenceRay& ray);

// ---- Rendering ------------------------------------------------------------------------------------------------------

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

// ---- Judging --------------------------------------------------------------------------------------------------------

/// By how much a mean may differ from the expected value, and why; absolute values.
struct ReferenceTolerance {
  double statistical = 0;  ///< z times the standard error
  double floating = 0;     ///< float arithmetic
  double reference = 0;    ///< the reference's own error
  double bias = 0;         ///< stated bias of the method at the step used
  double total() const { return statistical + floating + reference + bias; }
};

/// One number held against its reference.
struct CaseResult {
  std::string id, quantity, mode;
  int channel = 0;
  double expected = 0, mean = 0, standard_error = 0;
  double z = 0;  ///< what the allowances other than noise leave of the difference, in standard errors
  ReferenceTolerance tolerance;
  std::uint64_t samples = 0, non_finite = 0;
  bool passed = false;

  std::string to_string() const;  ///< one line
};

/// Judges one channel. Passes when the difference is within the tolerance, and every sample was finite.
/// @param allowed_z  standard errors granted.  @param floating, bias  absolute
CaseResult judge(const ReferenceCase& c, const ReferenceQuantity& quantity, const std::string& mode, int channel,
                 const ReferenceEstimate& estimate, double allowed_z, double floating, double bias);

}  // namespace brume
