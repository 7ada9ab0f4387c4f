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
  const StepRow row{stretch.span.begin, stretch.span.end, stretch.step, settings.offset, stretch.count};
  if (stretch.homogeneous) {  // constant shaders are not asked at all
    write_edges(row, t);
    return {};
  }
  const auto n = static_cast<std::size_t>(stretch.count);
  float* x = arena.alloc_span<float>(n).data();
  float* y = arena.alloc_span<float>(n).data();
  float* z = arena.alloc_span<float>(n).data();
  write_steps(ray, row, t, x, y, z);
  return {x, y, z, stretch.count, settings.time};
}

/// The arrays of a record that stretches are written to.
template <int C> struct Amounts {
  float* t;
  /// Of the only medium of the ray, which everything is proportional to; null where there are several, whose
  /// coefficients are added up.
  float* density;
  std::array<float*, C> sigma_t, sigma_s;
  std::array<float*, 3> emission;  ///< null where the only medium's follows its density, or there is none
  std::span<float*> of_media;      ///< empty where nobody asks for them
};

/// Writes a stretch's part of the record.
template <int C>
void look_up(const Stretch& stretch, std::span<const Medium> media, const Presence& presence, const Ray& ray,
             const MarchSettings& settings, const Amounts<C>& out, Arena& arena, MarchCounts& counts) {
  const ArenaScope scope(arena);
  const float middle = 0.5f * (stretch.span.begin + stretch.span.end);
  const int n = stretch.count, first = stretch.first;
  const auto size = static_cast<std::size_t>(n);
  const PointBatch points = write_segments(stretch, ray, settings, out.t + first, arena);
  // Shaders write whole vectors, the rest of which the next stretch overwrites.
  float* const density = out.density ? out.density + first : arena.alloc_span<float>(size).data();
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
    if (!out.density) {
      for (int c = 0; c < C; ++c) {
        const auto channel = static_cast<std::size_t>(c);
        put(density, medium.sigma_t[c], n, out.sigma_t[channel] + first);
        put(density, medium.sigma_s[c], n, out.sigma_s[channel] + first);
      }
    }
    if (!out.of_media.empty()) set_scaled(density, 1, n, out.of_media[m] + first);
    if (!out.emission[0] || !medium.emits()) continue;
    EmissionBatch glow{density, density, density};
    if (medium.traits.own_emission) {
      glow = alloc_emission(size, arena);
      medium.shader->emission(points, glow);
      counts.lookups += size;
    }
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      add_scaled(glow[channel], medium.emission[c], n, out.emission[channel] + first);
    }
  }
  if (begun) return;
  if (out.density) std::fill_n(out.density + first, n, 0.0f);
  for (std::size_t c = 0; c < C && !out.density; ++c)
    std::fill_n(out.sigma_t[c] + first, n, 0.0f), std::fill_n(out.sigma_s[c] + first, n, 0.0f);
}

/// Gives the record its arrays, and its coefficients what they are proportional to.
/// @param only  the only medium of the ray, or null
template <int C>
Amounts<C> alloc_amounts(std::span<const Medium> media, const Medium* only, const RecordContents& contents,
                         MarchRecord<C>& rec, Arena& arena) {
  const auto n = static_cast<std::size_t>(rec.n);
  // Stretches begin anywhere: the last vector of one may be read far behind its end.
  const auto alloc = [&] { return arena.alloc_span<float>(n + kWidestVector).data(); };
  Amounts<C> out{};
  rec.t = out.t = arena.alloc_span<float>(n + 2 * kWidestVector).data();
  if (only) out.density = alloc();
  for (std::size_t c = 0; c < C; ++c) {
    if (only) {
      rec.sigma_t[c] = {out.density, only->sigma_t[static_cast<int>(c)]};
      rec.sigma_s[c] = {out.density, only->sigma_s[static_cast<int>(c)]};
    } else {
      rec.sigma_t[c].amount = out.sigma_t[c] = alloc();
      rec.sigma_s[c].amount = out.sigma_s[c] = alloc();
    }
  }
  if (contents.emission && (!only || only->emits())) {
    const auto emission = arena.alloc_span<Coefficient>(3);
    for (std::size_t c = 0; c < 3; ++c) {
      if (only && !only->traits.own_emission)
        emission[c] = {out.density, only->emission[static_cast<int>(c)]};
      else
        std::fill_n(out.emission[c] = alloc(), n, 0.0f), emission[c] = {out.emission[c], 1};
    }
    rec.emission = emission.data();
  }
  if (contents.overlap) {
    out.of_media = arena.alloc_span<float*>(media.size());
    for (float*& density : out.of_media) std::fill_n(density = alloc(), n, 0.0f);
    rec.medium_density = out.of_media.data();
  }
  return out;
}

}  // namespace

template <int C>
MarchRecord<C> record(std::span<const Medium> media, const RecordContents& contents, const Ray& ray,
                      const MarchSettings& settings, Arena& arena, MarchCounts& counts) {
  MarchRecord<C> rec;
  const Presence presence = find_presence(media, ray, arena);
  if (presence.empty()) return rec;

  const auto stretches = arena.alloc_span<Stretch>(presence.edges.size() - 1);
  bool some_homogeneous = false;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    Stretch& stretch = stretches[s];
    stretch = {{presence.edges[s], presence.edges[s + 1]}, rec.n, 1, settings.step, true};
    const float middle = 0.5f * (stretch.span.begin + stretch.span.end);
    for (std::size_t m = 0; m < media.size(); ++m)
      if (!media[m].traits.constant && presence.contains(m, middle)) stretch.homogeneous = false;
    if (!stretch.homogeneous || settings.split_homogeneous)
      stretch.count = segment_count(stretch.span.length(), stretch.step, counts);
    some_homogeneous |= stretch.homogeneous;
    rec.longest = std::max(rec.longest, stretch.count == 1 ? stretch.span.length() : stretch.step);
    rec.n += stretch.count;
  }
  if (stretches.size() == 1) rec.inverse_step = 1 / rec.longest;
  counts.segments += static_cast<std::uint64_t>(rec.n);

  const Medium* const only = presence.only < media.size() ? &media[presence.only] : nullptr;
  const Amounts<C> out = alloc_amounts(media, only, contents, rec, arena);
  if (some_homogeneous) rec.homogeneous = arena.alloc_span<bool>(static_cast<std::size_t>(rec.n)).data();
  rec.offset = settings.offset;
  for (const Stretch& stretch : stretches) {
    if (some_homogeneous) std::fill_n(rec.homogeneous + stretch.first, stretch.count, stretch.homogeneous);
    look_up(stretch, media, presence, ray, settings, out, arena, counts);
  }
  out.t[rec.n] = stretches.back().span.end;
  return rec;
}

template MarchRecord<1> record<1>(std::span<const Medium>, const RecordContents&, const Ray&, const MarchSettings&,
                                  Arena&, MarchCounts&);
template MarchRecord<3> record<3>(std::span<const Medium>, const RecordContents&, const Ray&, const MarchSettings&,
                                  Arena&, MarchCounts&);

}  // namespace brume
