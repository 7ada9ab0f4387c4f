#include "app/gl/framebuffer.h"

#include <algorithm>
#include <string>

namespace brume {

Result<std::unique_ptr<Framebuffer>> Framebuffer::create(const Gl& gl, int width, int height) {
  GLint limit = 0;
  gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (width < 1 || height < 1 || width > limit || height > limit)
    return bad_input("Found a picture size of " + std::to_string(width) + " x " + std::to_string(height) +
                     ", expected 1 to " + std::to_string(limit) + " pixels on a side.");

  std::unique_ptr<Framebuffer> target(new Framebuffer(gl, width, height));
  gl.GenTextures(1, &target->texture_);
  gl.BindTexture(GL_TEXTURE_2D, target->texture_);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl.GenFramebuffers(1, &target->framebuffer_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer_);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target->texture_, 0);
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return Error{ErrorCode::Internal, "The graphics driver cannot draw into an RGBA8 picture of " +
                                          std::to_string(width) + " x " + std::to_string(height) + " (status " +
                                          std::to_string(status) + "); update the driver."};
  return target;
}

Framebuffer::~Framebuffer() {
  gl_.DeleteFramebuffers(1, &framebuffer_);
  gl_.DeleteTextures(1, &texture_);
}

void Framebuffer::bind() const {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.Viewport(0, 0, width_, height_);
}

std::vector<std::uint8_t> Framebuffer::read_pixels() const {
  const size_t row = static_cast<size_t>(width_) * 4;
  std::vector<std::uint8_t> pixels(row * static_cast<size_t>(height_));
  gl_.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  gl_.ReadBuffer(GL_COLOR_ATTACHMENT0);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 4);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  // GL counts rows from the bottom.
  for (size_t top = 0, bottom = static_cast<size_t>(height_) - 1; top < bottom; ++top, --bottom)
    std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(top * row),
                     pixels.begin() + static_cast<std::ptrdiff_t>((top + 1) * row),
                     pixels.begin() + static_cast<std::ptrdiff_t>(bottom * row));
  return pixels;
}

}  // namespace brume
