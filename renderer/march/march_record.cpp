#include "renderer/march/march_record.h"

#include <algorithm>

#include "renderer/march/presence.h"
#include "renderer/march/step_loops.h"

namespace brume {

int segment_count(float length, float& step, MarchCounts& counts) {
  const float exact = length / step;
  if (exact > kMaxSegments) {
    step = length / kMaxSegments;
    ++counts.capped;
    return kMaxSegments;
  }
  // Rounded up; a remainder below 1e-4 of a step is rounding, not a segment.
  const float counted = std::max(exact - 1e-4f, 0.0f);
  const int whole = static_cast<int>(counted);
  return std::max(1, whole + (static_cast<float>(whole) < counted ? 1 : 0));
}

namespace {

/// A part of the ray in which the same media are present.
struct Stretch {
  Interval span;
  int first;  // segment
  int count;  // segments
  float step;
  bool homogeneous;  // all its media are homogeneous (or there are none): nothing to look up
};

/// Writes the edges at which the stretch's segments begin. @return where they are looked up, if they are
PointBatch write_segments(const Stretch& stretch, const Ray& ray, const MarchSettings& settings, float* t,
                          Arena& arena) {
  const StepRow row{stretch.span.begin, stretch.step, settings.offset, stretch.count};
  if (stretch.homogeneous) {  // constant shaders are not asked at all
    write_edges(row, t);
    return {};
  }
  const auto n = static_cast<std::size_t>(stretch.count);
  float* x = arena.alloc_span<float>(n).data();
  float* y = arena.alloc_span<float>(n).data();
  float* z = arena.alloc_span<float>(n).data();
  write_steps(ray, row, t, x, y, z);
  // The last segment is shorter.
  const Vec3 last = ray.at(t[n - 1] + settings.offset * (stretch.span.end - t[n - 1]));
  x[n - 1] = last.x, y[n - 1] = last.y, z[n - 1] = last.z;
  return {x, y, z, stretch.count, settings.time};
}

/// Writes a stretch's part of the record.  @param t  its edges
template <int C>
void look_up(const Stretch& stretch, std::span<const Medium> media, const Presence& presence,
             const RecordContents& contents, const Ray& ray, const MarchSettings& settings, const MarchRecord<C>& rec,
             float* t, Arena& arena, MarchCounts& counts) {
  const ArenaScope scope(arena);
  const float middle = 0.5f * (stretch.span.begin + stretch.span.end);
  const int n = stretch.count, first = stretch.first;
  const auto size = static_cast<std::size_t>(n);
  const PointBatch points = write_segments(stretch, ray, settings, t + first, arena);
  float* const density = arena.alloc_span<float>(size).data();
  bool begun = false;
  for (std::size_t m = 0; m < media.size(); ++m) {
    const Medium& medium = media[m];
    if (!presence.contains(m, middle)) continue;
    if (medium.traits.constant) {
      std::fill_n(density, size, 1.0f);
    } else {
      medium.shader->density(points, density);
      counts.lookups += size;
    }
    const auto put = begun ? add_scaled : set_scaled;
    begun = true;
    for (int c = 0; c < C; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      put(density, medium.sigma_t[c], n, rec.sigma_t[channel] + first);
      put(density, medium.sigma_s[c], n, rec.sigma_s[channel] + first);
    }
    if (contents.overlap) set_scaled(density, 1, n, rec.medium_density[m] + first);
    if (!contents.emission || !medium.emits()) continue;
    EmissionBatch glow{density, density, density};
    if (medium.traits.own_emission) {
      glow = alloc_emission(size, arena);
      medium.shader->emission(points, glow);
      counts.lookups += size;
    }
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      add_scaled(glow[channel], medium.emission[c], n, rec.emission[channel] + first);
    }
  }
  for (std::size_t c = 0; c < C && !begun; ++c)
    std::fill_n(rec.sigma_t[c] + first, n, 0.0f), std::fill_n(rec.sigma_s[c] + first, n, 0.0f);
}

}  // namespace

template <int C>
MarchRecord<C> record(std::span<const Medium> media, const RecordContents& contents, const Ray& ray,
                      const MarchSettings& settings, Arena& arena, MarchCounts& counts) {
  MarchRecord<C> rec;
  const Presence presence = find_presence(media, ray, arena);
  if (presence.empty()) return rec;

  const auto stretches = arena.alloc_span<Stretch>(presence.edges.size() - 1);
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    Stretch& stretch = stretches[s];
    stretch = {{presence.edges[s], presence.edges[s + 1]}, rec.n, 1, settings.step, true};
    const float middle = 0.5f * (stretch.span.begin + stretch.span.end);
    for (std::size_t m = 0; m < media.size(); ++m)
      if (!media[m].traits.constant && presence.contains(m, middle)) stretch.homogeneous = false;
    if (!stretch.homogeneous || settings.split_homogeneous)
      stretch.count = segment_count(stretch.span.length(), stretch.step, counts);
    rec.longest = std::max(rec.longest, stretch.count == 1 ? stretch.span.length() : stretch.step);
    rec.n += stretch.count;
  }
  if (stretches.size() == 1) rec.inverse_step = 1 / rec.longest;
  counts.segments += static_cast<std::uint64_t>(rec.n);

  const auto n = static_cast<std::size_t>(rec.n);
  // Stretches begin anywhere: the last vector of one may be read far behind its end.
  const auto alloc = [&] { return arena.alloc_span<float>(n + kWidestVector).data(); };
  for (float*& channel : rec.sigma_t) channel = alloc();
  for (float*& channel : rec.sigma_s) channel = alloc();
  if (contents.emission)
    for (float*& channel : rec.emission) std::fill_n(channel = alloc(), n, 0.0f);
  if (contents.overlap) {
    rec.medium_density = arena.alloc_span<float*>(media.size()).data();
    for (std::size_t m = 0; m < media.size(); ++m) std::fill_n(rec.medium_density[m] = alloc(), n, 0.0f);
  }
  rec.homogeneous = arena.alloc_span<bool>(n).data();
  rec.offset = settings.offset;
  float* t = arena.alloc_span<float>(n + kWidestVector).data();
  rec.t = t;
  for (const Stretch& stretch : stretches) {
    std::fill_n(rec.homogeneous + stretch.first, stretch.count, stretch.homogeneous);
    look_up(stretch, media, presence, contents, ray, settings, rec, t, arena, counts);
  }
  t[n] = stretches.back().span.end;
  return rec;
}

template MarchRecord<1> record<1>(std::span<const Medium>, const RecordContents&, const Ray&, const MarchSettings&,
                                  Arena&, MarchCounts&);
template MarchRecord<3> record<3>(std::span<const Medium>, const RecordContents&, const Ray&, const MarchSettings&,
                                  Arena&, MarchCounts&);

}  // namespace brume
