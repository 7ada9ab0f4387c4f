// What fills a volume: a scalar density (and, for fire, an emission) asked for in batches of points.
#pragma once

#include <array>
#include <optional>

#include "renderer/core/arena.h"
#include "renderer/core/bounds.h"
#include "renderer/core/transform.h"

namespace brume {

/// n points, structure of arrays, in scene space; the arrays are readable up to the next multiple of 16 values.
/// The points of a batch need no order.
struct PointBatch {
  const float* x;
  const float* y;
  const float* z;
  int n;
  float time;  ///< seconds
};

/// n emissions, one array per channel.
using EmissionBatch = std::array<float*, 3>;

inline EmissionBatch alloc_emission(std::size_t n, Arena& arena) {
  return {arena.alloc_span<float>(n).data(), arena.alloc_span<float>(n).data(), arena.alloc_span<float>(n).data()};
}

/// What a shader can say about itself before it is asked.
struct ShaderTraits {
  bool constant = false;      ///< density is 1 everywhere inside the bounds: a homogeneous medium
  bool own_emission = false;  ///< emission() gives a field of its own instead of following the density
  std::optional<float> finest_scale =
      {};                        ///< world units: size of the smallest feature (a voxel); sets the automatic step
  bool baked = false;            ///< a procedural density, looked up on voxels
  float lookup_nanoseconds = 0;  ///< what a point of density() costs, roughly; only ratios count
};

/// A shader is immutable and may be asked from any thread, in any order, for any n.
class Shader {
 public:
  virtual ~Shader() = default;

  virtual ShaderTraits traits() const = 0;

  /// Writes density[0..n): dimensionless, finite and >= 0. May write up to the next multiple of 16 values.
  virtual void density(const PointBatch& points, float* density) const = 0;

  /// An upper bound of the density at all points of `box`, scene space. Tracking needs it: where it is too low, a
  /// picture is wrong; where it is too high, only slow.
  virtual float max_density(const Bounds3& box) const = 0;

  /// Of the tables that look-ups read.
  virtual std::size_t memory_bytes() const { return 0; }

  /// Writes emission[c][0..n), dimensionless, finite and >= 0; called only when traits().own_emission.
  virtual void emission(const PointBatch& points, const EmissionBatch& emission) const;
};

}  // namespace brume
