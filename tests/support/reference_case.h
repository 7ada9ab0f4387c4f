// Reference data for volume lighting, as read from JSON files, whose README says what every field means.
//
// Reading (here), the medium in double (reference_medium.h), rendering (reference_probe.h) and deciding whether a
// rendered value is right (reference_judge.h) are separate steps, so that a program can show values which no test
// judges.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "renderer/core/error.h"
#include "renderer/core/vec.h"

namespace brume {

using Channels = std::array<double, 3>;

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

// Numbers of a kind.
double real(const ReferenceKind& kind, const char* key);
Vec3d vec(const ReferenceKind& kind, const char* key);

}  // namespace brume
