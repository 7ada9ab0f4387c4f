#include "app/gl/texture.h"

#include <utility>

#include "renderer/core/check.h"

namespace brume {

Texture::Texture(const Gl& gl, TextureFilter filter) : gl_(&gl), filter_(filter) {
  gl_->GenTextures(1, &name_);
  gl_->BindTexture(GL_TEXTURE_2D, name_);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
  set_filter(filter);
}

Texture::Texture(Texture&& other) noexcept
    : gl_(other.gl_),
      name_(std::exchange(other.name_, 0)),
      width_(std::exchange(other.width_, 0)),
      height_(std::exchange(other.height_, 0)),
      filter_(other.filter_) {}

Texture& Texture::operator=(Texture&& other) noexcept {
  std::swap(gl_, other.gl_);
  std::swap(name_, other.name_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(filter_, other.filter_);
  return *this;
}

Texture::~Texture() {
  if (name_) gl_->DeleteTextures(1, &name_);
}

Result<void> Texture::upload(int width, int height, std::span<const std::uint8_t> pixels) {
  BRUME_CHECK(width, >, 0);
  BRUME_CHECK(height, >, 0);
  BRUME_CHECK(pixels.size(), ==, static_cast<size_t>(width) * static_cast<size_t>(height) * 4);

  gl_->BindTexture(GL_TEXTURE_2D, name_);
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_->PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  if (width == width_ && height == height_) {
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
    return {};
  }
  GLint limit = 0;
  gl_->GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (width > limit || height > limit)
    return bad_input("The picture is " + std::to_string(width) + " x " + std::to_string(height) +
                     " pixels; this graphics driver shows at most " + std::to_string(limit) +
                     " on a side. Choose a smaller resolution.");
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  width_ = width;
  height_ = height;
  return {};
}

void Texture::set_filter(TextureFilter filter) {
  filter_ = filter;
  const GLint mode = filter == TextureFilter::Linear ? GL_LINEAR : GL_NEAREST;
  gl_->BindTexture(GL_TEXTURE_2D, name_);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mode);
  gl_->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, mode);
}

}  // namespace brume
