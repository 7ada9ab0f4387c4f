#include "renderer/march/shadow_march.h"

#include <algorithm>

#include "renderer/march/step_loops.h"

namespace brume {
namespace {

// What a medium is asked for at once: the look-ups of short shadow rays are done together.
constexpr int kPoints = 384, kPieces = 32;

/// A shadow ray's points among those; of a long ray, as many as fit.
struct Piece {
  std::size_t ray;
  int first, n;
  float step;  // between the points
  float last;  // length of the segment of the last point
};

/// Optical amounts (integrals of the density) of many rays in one medium.
class Amounts {
 public:
  Amounts(const Medium& medium, float time, Arena& arena, std::span<double> amounts)
      : medium_(medium), time_(time), amounts_(amounts), pieces_(arena.alloc_span<Piece>(kPieces)) {
    for (float*& axis : position_) axis = arena.alloc_span<float>(kPoints + kVector).data();
    density_ = arena.alloc_span<float>(kPoints + kVector).data();
  }

  void add(std::size_t number, const ShadowRay& shadow, const Interval& span, float step, MarchCounts& counts) {
    if (medium_.traits.constant) {
      amounts_[number] += static_cast<double>(span.length());
      return;
    }
    const int count = segment_count(span.length(), step, counts);
    counts.lookups += static_cast<std::uint64_t>(count);
    const float last = span.length() - static_cast<float>(count - 1) * step;  // the last segment may be shorter
    const float first = span.begin + shadow.offset * step;
    // A ray begins where all of it fits, so that its sum has the same bits whatever it is marched with.
    for (int i = 0; i < count;) {
      const int n = std::min(count - i, kPoints);
      if (n > kPoints - points_ || pieces_used_ == kPieces) look_up();
      const bool ends = i + n == count;
      const PointRow row{first + static_cast<float>(i) * step, step, n};
      float* const x = position_[0] + points_;
      float* const y = position_[1] + points_;
      float* const z = position_[2] + points_;
      write_points(shadow.ray, row, x, y, z);
      if (ends) {
        const Vec3 p = shadow.ray.at(span.begin + static_cast<float>(count - 1) * step + shadow.offset * last);
        x[n - 1] = p.x, y[n - 1] = p.y, z[n - 1] = p.z;
      }
      pieces_[pieces_used_++] = {number, points_, n, step, ends ? last : step};
      points_ += n;
      i += n;
    }
  }

  void look_up() {
    if (points_ == 0) return;
    medium_.shader->density({position_[0], position_[1], position_[2], points_, time_}, density_);
    for (const Piece& piece : pieces_.first(pieces_used_)) {
      const float* density = density_ + piece.first;
      amounts_[piece.ray] += static_cast<double>(sum(density, piece.n - 1)) * static_cast<double>(piece.step) +
                             static_cast<double>(density[piece.n - 1] * piece.last);
    }
    points_ = 0, pieces_used_ = 0;
  }

 private:
  static constexpr int kVector = 16;  // loops write whole vectors
  const Medium& medium_;
  float time_;
  std::span<double> amounts_;
  std::span<Piece> pieces_;
  std::size_t pieces_used_ = 0;
  float* position_[3];
  float* density_;
  int points_ = 0;
};

}  // namespace

template <int C>
void shadow_optical_depths(std::span<const Medium> media, std::span<const ShadowRay> rays, float step, float time,
                           Arena& arena, MarchCounts& counts, std::span<Spectrum<C>> depths) {
  const ArenaScope scope(arena);
  std::fill(depths.begin(), depths.end(), Spectrum<C>{});
  const auto amounts = arena.alloc_span<double>(rays.size());
  for (const Medium& medium : media) {
    const ArenaScope medium_scope(arena);
    std::fill(amounts.begin(), amounts.end(), 0.0);
    Amounts march(medium, time, arena, amounts);
    for (std::size_t r = 0; r < rays.size(); ++r) {
      const ArenaScope ray_scope(arena);
      for (const Interval& span : medium.intervals(rays[r].ray, arena)) march.add(r, rays[r], span, step, counts);
    }
    march.look_up();
    for (std::size_t r = 0; r < rays.size(); ++r)
      for (int c = 0; c < C; ++c) depths[r][c] += medium.sigma_t[c] * static_cast<float>(amounts[r]);
  }
}

template void shadow_optical_depths<1>(std::span<const Medium>, std::span<const ShadowRay>, float, float, Arena&,
                                       MarchCounts&, std::span<Spectrum<1>>);
template void shadow_optical_depths<3>(std::span<const Medium>, std::span<const ShadowRay>, float, float, Arena&,
                                       MarchCounts&, std::span<Spectrum<3>>);

}  // namespace brume
