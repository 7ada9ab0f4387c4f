// A picture to draw into that belongs to no window.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/gl/gl.h"

namespace brume {

/// RGBA8 of a fixed size, without depth. Drawing into it instead of a context's own buffer makes OSMesa and EGL
/// agree to the byte. Create, use and destroy with its context current.
class Framebuffer {
 public:
  static Result<std::unique_ptr<Framebuffer>> create(const Gl& gl, int width, int height);
  Framebuffer(const Framebuffer&) = delete;
  Framebuffer& operator=(const Framebuffer&) = delete;
  ~Framebuffer();

  /// Makes it the target of drawing and sets the viewport to all of it.
  void bind() const;
  /// [height][width][4], row 0 at the top.
  std::vector<std::uint8_t> read_pixels() const;

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  Framebuffer(const Gl& gl, int width, int height) : gl_(gl), width_(width), height_(height) {}

  const Gl& gl_;
  int width_, height_;
  GLuint texture_ = 0, framebuffer_ = 0;
};

}  // namespace brume
