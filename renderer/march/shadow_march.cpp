#include "renderer/march/shadow_march.h"

#include <algorithm>

namespace brume {
namespace {

// What a medium is asked for at once: the look-ups of short shadow rays are done together.
constexpr int kPoints = 256, kRows = 32;

/// Optical amounts (integrals of the density) of many rays in one medium.
class Amounts {
 public:
  Amounts(const Medium& medium, const ShadowRays& rays, float step, float time, Arena& arena, MarchCounts& counts,
          double* amounts)
      : medium_(medium),
        rays_(rays),
        step_(step),
        time_(time),
        counts_(counts),
        amounts_(amounts),
        rows_(arena.alloc_span<ShadowRow>(kRows)) {
    constexpr std::size_t kStride = kPoints + kWidestVector;
    float* array = arena.alloc_span<float>(4 * kStride).data();
    for (float** const a : {&x_, &y_, &z_, &density_}) *a = std::exchange(array, array + kStride);
  }

  void add(int ray, const Interval& span) {
    if (medium_.traits.constant) {
      amounts_[ray] += static_cast<double>(span.length());
      return;
    }
    float step = step_;
    const int count = segment_count(span.length(), step, counts_);
    counts_.lookups += static_cast<std::uint64_t>(count);
    const float offset = rays_.offset[ray];
    const float last_begin = span.begin + static_cast<float>(count - 1) * step;
    const float last_step = span.end - last_begin;  // the last segment may be shorter
    // A ray begins where all of it fits, so that its sum has the same bits whatever it is marched with.
    for (int i = 0; i < count;) {
      const int n = std::min(count - i, kPoints);
      if (n > kPoints - points_ || row_count_ == kRows) look_up();
      const bool ends = i + n == count;
      const float first = span.begin + (static_cast<float>(i) + offset) * step;
      rows_[row_count_++] = {.ray = ray,
                             .first = points_,
                             .n = n,
                             .begin = first,
                             .step = step,
                             .last = ends ? last_begin + offset * last_step : first + static_cast<float>(n - 1) * step,
                             .last_step = ends ? last_step : step};
      points_ += n;
      i += n;
    }
  }

  void look_up() {
    if (points_ == 0) return;
    const auto rows = rows_.first(row_count_);
    write_points(rays_, rows, x_, y_, z_);
    medium_.shader->density({x_, y_, z_, points_, time_}, density_);
    add_amounts(rows, density_, amounts_);
    points_ = 0, row_count_ = 0;
  }

 private:
  const Medium& medium_;
  const ShadowRays& rays_;
  float step_, time_;
  MarchCounts& counts_;
  double* amounts_;
  std::span<ShadowRow> rows_;
  std::size_t row_count_ = 0;
  float *x_, *y_, *z_, *density_;
  int points_ = 0;
};

}  // namespace

template <int C>
void shadow_optical_depths(std::span<const Medium> media, const ShadowRays& rays, float step, float time, Arena& arena,
                           MarchCounts& counts, Spectrum<C>* depths) {
  const ArenaScope scope(arena);
  const auto n = static_cast<std::size_t>(rays.n);
  std::fill_n(depths, n, Spectrum<C>{});
  double* const amounts = arena.alloc_span<double>(n).data();
  float* const from = arena.alloc_span<float>(n).data();
  float* const to = arena.alloc_span<float>(n).data();
  for (const Medium& medium : media) {
    const ArenaScope medium_scope(arena);
    std::fill_n(amounts, n, 0.0);
    Amounts march(medium, rays, step, time, arena, counts, amounts);
    if (const Bounds3* const box = medium.shape->box()) {
      clip_to_box(rays, medium.shape_from_scene, Vec3(box->low), Vec3(box->high), from, to);
      for (int r = 0; r < rays.n; ++r)
        if (const Interval inside{from[r], to[r]}; !inside.empty()) march.add(r, inside);
    } else {
      for (int r = 0; r < rays.n; ++r) {
        const ArenaScope ray_scope(arena);
        for (const Interval& inside : medium.intervals(rays[r], arena)) march.add(r, inside);
      }
    }
    march.look_up();
    for (std::size_t r = 0; r < n; ++r)
      for (int c = 0; c < C; ++c) depths[r][c] += medium.sigma_t[c] * static_cast<float>(amounts[r]);
  }
}

template void shadow_optical_depths<1>(std::span<const Medium>, const ShadowRays&, float, float, Arena&, MarchCounts&,
                                       Spectrum<1>*);
template void shadow_optical_depths<3>(std::span<const Medium>, const ShadowRays&, float, float, Arena&, MarchCounts&,
                                       Spectrum<3>*);

}  // namespace brume
