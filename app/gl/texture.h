// A picture on the graphics card.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <span>

#include "app/gl/gl.h"

namespace brume {

enum class TextureFilter { Nearest, Linear };

/// Owns a 2D texture, empty (0 x 0) until the first upload. Create, use and destroy with its context current.
class Texture {
 public:
  explicit Texture(const Gl& gl, TextureFilter filter = TextureFilter::Linear);
  Texture(Texture&& other) noexcept;
  Texture& operator=(Texture&& other) noexcept;
  ~Texture();

  /// `pixels` [height][width][4], row 0 at the top, display values; exactly width*height*4 bytes. Allocates again
  /// only when the size changes. Fails when a side is over the driver's limit; the texture then keeps what it had.
  Result<void> upload(int width, int height, std::span<const std::uint8_t> pixels);

  /// Linear smooths a minified or magnified picture; Nearest shows the pixels themselves.
  void set_filter(TextureFilter filter);

  /// For ImGui::Image, uv (0,0) being the top left corner. Stays the same over uploads.
  ImTextureID id() const { return (ImTextureID)(static_cast<std::intptr_t>(name_)); }
  GLuint gl_name() const { return name_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  const Gl* gl_;
  GLuint name_ = 0;
  int width_ = 0, height_ = 0;
  TextureFilter filter_;
};

}  // namespace brume
