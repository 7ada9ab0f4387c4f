#include "renderer/march/tracking.h"

#include <cmath>

namespace brume {

template <int C>
TentativeCollisions<C>::TentativeCollisions(std::span<const Medium> media, const Majorants& majorants, const Ray& ray,
                                            float time, const FlightNumbers& numbers, Arena& arena, MarchCounts& counts)
    : media_(media), ray_(ray), time_(time), numbers_(numbers), arena_(arena), counts_(counts) {
  presence_ = find_presence(media, ray, arena);
  if (presence_.empty()) return;
  const Interval inside = intersect(ray.span, {presence_.edges.front(), presence_.edges.back()});
  stretches_ = majorants.along({ray.origin, ray.direction, inside}, arena);
  if (stretches_.empty()) return;
  at_ = static_cast<double>(stretches_.front().span.begin);
  batch_ = arena.alloc_span<Collision<C>>(kLargestBatch);
  if (media.size() > 1) densities_ = arena.alloc_span<float>(kLargestBatch * media.size());
}

template <int C> bool TentativeCollisions<C>::fly(float& t, float& majorant) {
  if (stretch_ >= stretches_.size()) return false;
  if (drawn_ == kMaxFlights) {
    limit_ = static_cast<float>(kMaxFlights / (static_cast<double>(stretches_.back().span.end) - at_));
    ++counts_.capped;
  }
  double tau = -std::log1p(-static_cast<double>(numbers_.next(drawn_++)));
  for (; stretch_ < stretches_.size(); ++stretch_) {
    const MajorantStretch& s = stretches_[stretch_];
    float wanted = 0;
    for (int c = 0; c < C; ++c)
      if (!dropped_[c]) wanted = std::max(wanted, C == 1 ? max_channel(s.majorant) : s.majorant[c]);
    wanted = std::min(wanted, limit_);
    const double sigma = static_cast<double>(wanted), end = static_cast<double>(s.span.end);
    const double from = std::max(at_, static_cast<double>(s.span.begin)), depth = sigma * (end - from);
    if (tau < depth) {
      at_ = from + tau / sigma;
      t = std::min(static_cast<float>(at_), s.span.end);
      majorant = wanted;
      return true;
    }
    tau -= std::max(depth, 0.0);
  }
  return false;
}

namespace {

/// Looks the media up at the collisions, whose t is known.
/// @param densities  room for one of every medium and collision; none where there is one medium
template <int C>
void look_up(std::span<const Medium> media, const Presence& presence, const Ray& ray, float time,
             std::span<Collision<C>> batch, std::span<float> densities, Arena& arena, MarchCounts& counts) {
  const ArenaScope scope(arena);
  const std::size_t n = batch.size();
  const auto x = arena.alloc_span<float>(n), y = arena.alloc_span<float>(n), z = arena.alloc_span<float>(n);
  const auto values = arena.alloc_span<float>(n);
  for (std::size_t i = 0; i < n; ++i) {
    Collision<C>& c = batch[i];
    const Vec3 p = ray.at(c.t);
    x[i] = p.x, y[i] = p.y, z[i] = p.z;
    c.sigma_t = c.sigma_s = {};
    c.emission = {};
    c.densities = densities.empty() ? std::span<const float>() : densities.subspan(i * media.size(), media.size());
  }
  if (n == 0) return;
  const PointBatch points{x.data(), y.data(), z.data(), static_cast<int>(n), time};
  for (std::size_t m = 0; m < media.size(); ++m) {
    const Medium& medium = media[m];
    if (medium.traits.constant) {
      std::fill_n(values.begin(), n, 1.0f);
    } else {
      medium.shader->density(points, values.data());
      counts.lookups += n;
    }
    for (std::size_t i = 0; i < n; ++i) {
      Collision<C>& c = batch[i];
      if (!presence.contains(m, c.t)) values[i] = 0;
      if (!densities.empty()) densities[i * media.size() + m] = values[i];
      for (int k = 0; k < C; ++k) {
        c.sigma_t[k] += values[i] * medium.sigma_t[k];
        c.sigma_s[k] += values[i] * medium.sigma_s[k];
      }
      if (medium.emits() && !medium.traits.own_emission) c.emission += medium.emission * values[i];
    }
    if (!medium.emits() || !medium.traits.own_emission) continue;
    const EmissionBatch own = alloc_emission(n, arena);
    medium.shader->emission(points, own);
    counts.lookups += n;
    for (std::size_t i = 0; i < n; ++i)
      if (presence.contains(m, batch[i].t))
        batch[i].emission += medium.emission * Color(own[0][i], own[1][i], own[2][i]);
  }
}

}  // namespace

template <int C> void TentativeCollisions<C>::fill() {
  size_ = used_ = 0;
  for (; size_ < capacity_; ++size_) {
    Collision<C>& c = batch_[static_cast<std::size_t>(size_)];
    if (!fly(c.t, c.majorant)) break;
    ends_[static_cast<std::size_t>(size_)] = {at_, stretch_};
  }
  capacity_ = std::min(2 * capacity_, kLargestBatch);
  look_up(media_, presence_, ray_, time_, batch_.first(static_cast<std::size_t>(size_)), densities_, arena_, counts_);
}

template <int C> const Collision<C>* TentativeCollisions<C>::next() {
  if (used_ == size_) {
    if (stretches_.empty()) return nullptr;
    fill();
    if (size_ == 0) return nullptr;
  }
  const auto i = static_cast<std::size_t>(used_++);
  here_ = ends_[i].at, here_stretch_ = ends_[i].stretch;
  const Collision<C>& collision = batch_[i];
  constexpr float kRounding = 1 + 1e-5f;
  for (int c = 0; c < C; ++c)
    if (!dropped_[c] && !limited() && collision.sigma_t[c] > kRounding * collision.majorant) ++counts_.exceeded;
  return &collision;
}

template <int C> void TentativeCollisions<C>::drop(int channel) {
  if (dropped_[channel]) return;
  dropped_[channel] = true;
  // Free flights have no memory: those that were drawn ahead are forgotten, and new ones start from here.
  used_ = size_ = 0;
  at_ = here_;
  stretch_ = here_stretch_;
}

template <int C>
Spectrum<C> ratio_tracking(std::span<const Medium> media, const Majorants& majorants, const Ray& ray, float time,
                           const FlightNumbers& numbers, Arena& arena, MarchCounts& counts) {
  const ArenaScope scope(arena);
  auto result = filled<C>(1);
  TentativeCollisions<C> collisions(media, majorants, ray, time, numbers, arena, counts);
  while (const Collision<C>* c = collisions.next()) {
    int gone = 0;
    for (int k = 0; k < C; ++k) {
      // Where there is more than the majorant the factor is negative, and the mean still right.
      const float passes = 1 - c->sigma_t[k] / c->majorant;
      result[k] *= std::abs(passes) < 1e-6f || (passes < 0 && collisions.limited()) ? 0 : passes;
      if (result[k] == 0) collisions.drop(k), ++gone;
    }
    if (gone == C) break;
  }
  return result;
}

template <int C>
Collision<C> collision_at(std::span<const Medium> media, const Ray& ray, float t, float time, Arena& arena,
                          MarchCounts& counts) {
  const Presence presence = find_presence(media, ray, arena);
  const auto densities = media.size() > 1 ? arena.alloc_span<float>(media.size()) : std::span<float>();
  Collision<C> at;
  at.t = t;
  at.majorant = 0;
  look_up(media, presence, ray, time, std::span(&at, 1), densities, arena, counts);
  return at;
}

template Collision<1> collision_at(std::span<const Medium>, const Ray&, float, float, Arena&, MarchCounts&);
template Collision<3> collision_at(std::span<const Medium>, const Ray&, float, float, Arena&, MarchCounts&);
template class TentativeCollisions<1>;
template class TentativeCollisions<3>;
template Spectrum<1> ratio_tracking(std::span<const Medium>, const Majorants&, const Ray&, float, const FlightNumbers&,
                                    Arena&, MarchCounts&);
template Spectrum<3> ratio_tracking(std::span<const Medium>, const Majorants&, const Ray&, float, const FlightNumbers&,
                                    Arena&, MarchCounts&);

}  // namespace brume
