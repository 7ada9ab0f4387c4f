// Numbers of light samples that are averaged.
#pragma once

#include <algorithm>

#include "renderer/sampling/sampler.h"

namespace brume {

/// What a light sample is told from all others by, and the number of its shadow ray.
struct ShadowNumbers {
  int index;     ///< at this bounce
  float offset;  ///< in [0,1): where inside the steps
};

/// The random numbers of `count` samples of one light at one vertex of a path, spread evenly. Each sample on its own
/// has independent uniform numbers, so a mean over the samples is unbiased. Where the sampler follows a sequence, one
/// number of the pass shifts all of them at once (systematic sampling; a lattice in more dimensions), so that the
/// passes interleave; otherwise every sample has its own, inside its stratum.
class LightNumbers {
 public:
  /// @param number  of the set of samples at this bounce, such as that of the light
  LightNumbers(const Sampler& sampler, int bounce, int number, int count)
      : sampler_(sampler), bounce_(bounce), number_(number), count_(count) {
    if (!together()) return;
    point_ = sampler.u2(Decision::LightPoint, bounce, number);
    offset_ = sampler.u1(Decision::ShadowOffset, bounce, number);
  }

  int count() const { return count_; }

  /// What tells sample k from all others at this bounce, for numbers that are not spread.
  int index(int k) const { return number_ * count_ + k; }

  /// Where on the light: successive powers of the plastic number. Roberts 2018, "The Unreasonable Effectiveness of
  /// Quasirandom Sequences" (R2).
  Vec2 point(int k) const {
    if (!together()) return sampler_.u2(Decision::LightPoint, bounce_, index(k));
    return {wrapped(point_.x, k, 0.75487767f), wrapped(point_.y, k, 0.56984029f)};
  }

  /// Offsets are multiples of the golden ratio.
  ShadowNumbers of_shadow(int k) const {
    return {index(k),
            together() ? wrapped(offset_, k, 0.61803399f) : sampler_.u1(Decision::ShadowOffset, bounce_, index(k))};
  }

  /// Numbers for distances, one in each of `strata` equal parts of [0, 1).
  class Distances {
   public:
    float operator()(int k, int strata) const {
      const float xi =
          numbers_.together() ? first_ : numbers_.sampler_.u1(decision_, numbers_.bounce_, numbers_.index(k));
      return below_one((static_cast<float>(k) + xi) / static_cast<float>(strata));
    }

   private:
    friend class LightNumbers;
    Distances(const LightNumbers& numbers, Decision decision) : numbers_(numbers), decision_(decision) {
      if (numbers.together()) first_ = numbers.sampler_.u1(decision, numbers.bounce_, numbers.number_);
    }
    const LightNumbers& numbers_;
    Decision decision_;
    float first_ = 0;
  };
  Distances distances(Decision decision) const { return {*this, decision}; }

 private:
  bool together() const { return sampler_.kind() == SamplerKind::Sobol; }

  static float below_one(float u) { return std::min(u, 0x1.fffffep-1f); }
  static float wrapped(float u, int k, float ratio) {
    const float shifted = u + static_cast<float>(k) * ratio;
    return below_one(shifted - static_cast<float>(static_cast<int>(shifted)));
  }

  const Sampler& sampler_;
  int bounce_, number_, count_;
  Vec2 point_;
  float offset_ = 0;
};

}  // namespace brume
