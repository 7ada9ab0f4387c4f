#include "renderer/march/distribute.h"

#include "renderer/march/step_loops.h"

namespace brume {

template <int C> void distribute(MarchRecord<C>& rec, Color throughput, Arena& arena) {
  const auto n = static_cast<std::size_t>(rec.n);
  const auto on_edges = [&] { return arena.alloc_span<float>(n + kWidestVector).data(); };
  rec.weight = channel_weights<C>(throughput);
  float* cdf = on_edges();
  float* p = arena.alloc_span<float>(n).data();
  Attenuation out[C];
  for (std::size_t c = 0; c < C; ++c) {
    out[c] = {on_edges(), on_edges(), arena.alloc_span<float>(n).data()};
    rec.tau[c] = out[c].tau, rec.transmittance[c] = out[c].transmittance, rec.length[c] = out[c].length;
  }
  if constexpr (C == 1) {
    attenuate(rec.t, rec.sigma_t[0], rec.sigma_s[0], rec.n, out[0], p, cdf);
  } else {
    for (std::size_t c = 0; c < C; ++c) attenuate(rec.t, rec.sigma_t[c], rec.n, out[c]);
    for (std::size_t i = 0; i < n; ++i) {
      p[i] = 0;
      for (std::size_t c = 0; c < C; ++c) p[i] += rec.weight.v[c] * rec.sigma_s[c][i] * rec.length[c][i];
    }
    running_sum(p, rec.n, cdf);
  }
  rec.p = p;
  rec.cdf = cdf;
}

template <int C> Color emitted_radiance(const MarchRecord<C>& rec) {
  Color sum;
  if (rec.emission[0] == nullptr) return sum;
  for (int c = 0; c < 3; ++c) {
    const float* length = rec.length[static_cast<std::size_t>(C == 1 ? 0 : c)];
    const float* emission = rec.emission[static_cast<std::size_t>(c)];
    double total = 0;
    for (int i = 0; i < rec.n; ++i) total += static_cast<double>(emission[i] * length[i]);
    sum[c] = static_cast<float>(total);
  }
  return sum;
}

template <int C> Spectrum<C> transmittance(const MarchRecord<C>& rec) {
  Spectrum<C> result;
  for (int c = 0; c < C; ++c) result[c] = rec.empty() ? 1.0f : rec.transmittance[static_cast<std::size_t>(c)][rec.n];
  return result;
}

template void distribute<1>(MarchRecord<1>&, Color, Arena&);
template void distribute<3>(MarchRecord<3>&, Color, Arena&);
template Color emitted_radiance<1>(const MarchRecord<1>&);
template Color emitted_radiance<3>(const MarchRecord<3>&);
template Spectrum<1> transmittance<1>(const MarchRecord<1>&);
template Spectrum<3> transmittance<3>(const MarchRecord<3>&);

}  // namespace brume
