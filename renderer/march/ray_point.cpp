#include "renderer/march/ray_point.h"

#include <cmath>

namespace brume {

int segment_of(const float* edges, int n, float value) {
  // The number of steps depends on n only and no branch on the values: half of such branches would be mispredicted.
  const float* first = edges;
  for (int left = n; left > 1;) {
    const int half = left / 2;
    first += first[half] <= value ? half : 0;
    left -= half;
  }
  return static_cast<int>(first - edges);
}

template <int C> int find_segment(const MarchRecord<C>& rec, float t) { return segment_of(rec.t, rec.n, t); }

template <int C> RayPoint<C> evaluate(const MarchRecord<C>& rec, float t, int segment) {
  RayPoint<C> point{t, segment, {}, {}};
  const auto i = static_cast<std::size_t>(segment);
  for (std::size_t c = 0; c < C; ++c) {
    point.sigma_s.v[c] = rec.sigma_s[c][i];
    point.transmittance.v[c] = rec.transmittance[c][i] * std::exp(-rec.sigma_t[c][i] * (t - rec.t[i]));
  }
  return point;
}

template <int C> RayPoint<C> looked_up_point(const MarchRecord<C>& rec, int segment) {
  const float begin = rec.t[segment];
  return evaluate(rec, begin + rec.offset * (rec.t[segment + 1] - begin), segment);
}

template int find_segment<1>(const MarchRecord<1>&, float);
template int find_segment<3>(const MarchRecord<3>&, float);
template RayPoint<1> evaluate<1>(const MarchRecord<1>&, float, int);
template RayPoint<3> evaluate<3>(const MarchRecord<3>&, float, int);
template RayPoint<1> looked_up_point<1>(const MarchRecord<1>&, int);
template RayPoint<3> looked_up_point<3>(const MarchRecord<3>&, int);

}  // namespace brume
