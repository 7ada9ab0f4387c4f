// A picture of the surroundings.
#pragma once

#include <memory>
#include <string>

#include "renderer/core/error.h"
#include "renderer/film/image.h"
#include "renderer/sampling/piecewise_constant.h"

namespace brume {

/// An equirectangular picture of all directions: its middle is seen along +x, its upper edge is +z, and what is right
/// of the middle is at -y. Radiance between the pixels' centres is interpolated bilinearly. Directions are drawn in
/// proportion to the luminance, averaged over each pixel, times the pixel's solid angle. Immutable; any thread.
class EnvironmentMap {
 public:
  /// Values that are negative or not finite count as 0.  @param picture  of at least one pixel
  explicit EnvironmentMap(Image picture);

  /// An .exr or .hdr (Radiance) file.  Errors name the file.
  static Result<std::shared_ptr<const EnvironmentMap>> read(const std::string& path);

  /// @param direction  unit
  Color radiance(Vec3 direction) const;

  struct Sample {
    Vec3 direction;
    float pdf_w;  ///< per sr
  };
  Sample sample(Vec2 u) const;
  float pdf_w(Vec3 direction) const;

  /// (integral of L)^2 / integral of L^2, sr: small for a picture with a sun in it.
  float solid_angle() const { return solid_angle_; }
  int width() const { return picture_.width; }
  int height() const { return picture_.height; }
  /// How many values were taken as 0.
  std::size_t mended() const { return mended_; }

 private:
  Image picture_;
  PiecewiseConstant2D distribution_;
  float solid_angle_ = 0;
  std::size_t mended_ = 0;
};

}  // namespace brume
