// One value per channel that the transport carries: 1 where a scene's media are grey, 3 where they are chromatic.
#pragma once

#include "renderer/core/vec.h"

namespace brume {

template <int C> struct Spectrum {
  static_assert(C == 1 || C == 3);
  float v[C] = {};

  float operator[](int c) const { return v[c]; }
  float& operator[](int c) { return v[c]; }
};

/// The same value in every channel.
template <int C> Spectrum<C> filled(float value) {
  Spectrum<C> s;
  for (float& v : s.v) v = value;
  return s;
}

template <int C> Color to_color(const Spectrum<C>& s) {
  if constexpr (C == 1)
    return Color(s[0]);
  else
    return {s[0], s[1], s[2]};
}

/// @param color  grey where C is 1
template <int C> Spectrum<C> from_color(Color color) {
  Spectrum<C> s;
  for (int c = 0; c < C; ++c) s[c] = color[c];
  return s;
}

/// Weights of the channels in a density that serves them all: proportional to the throughput, summing to 1.
template <int C> Spectrum<C> channel_weights(Color throughput) {
  Spectrum<C> w;
  if constexpr (C == 1) {
    w[0] = 1;
  } else {
    const float sum = throughput.r + throughput.g + throughput.b;
    for (int c = 0; c < 3; ++c) w[c] = sum > 0 ? throughput[c] / sum : 1.0f / 3;
  }
  return w;
}

}  // namespace brume
