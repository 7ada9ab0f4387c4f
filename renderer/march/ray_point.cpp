#include "renderer/march/ray_point.h"

#include <algorithm>
#include <cmath>

namespace brume {

int segment_of(const float* edges, int n, float value) {
  // The number of steps depends on n only and no branch on the values: half of such branches would be mispredicted.
  // Steps into quarters while there are some: their three comparisons do not wait for each other.
  const float* first = edges;
  int left = n;
  while (left > 3) {
    const int quarter = left / 4;
    const int skipped = (first[quarter] <= value) + (first[2 * quarter] <= value) + (first[3 * quarter] <= value);
    first += skipped * quarter;
    left -= 3 * quarter;
  }
  while (left > 1) {
    const int half = left / 2;
    first += first[half] <= value ? half : 0;
    left -= half;
  }
  return static_cast<int>(first - edges);
}

template <int C> int find_segment(const MarchRecord<C>& rec, float t) {
  if (rec.inverse_step == 0) return segment_of(rec.t, rec.n, t);
  int i = static_cast<int>(std::clamp((t - rec.t[0]) * rec.inverse_step, 0.0f, static_cast<float>(rec.n - 1)));
  // The edges are rounded, too: next to one it may be the other segment.
  while (i > 0 && rec.t[i] > t) --i;
  while (i + 1 < rec.n && rec.t[i + 1] <= t) ++i;
  return i;
}

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
  return evaluate(rec, rec.t[segment] + rec.looked_up_behind(segment), segment);
}

template int find_segment<1>(const MarchRecord<1>&, float);
template int find_segment<3>(const MarchRecord<3>&, float);
template RayPoint<1> evaluate<1>(const MarchRecord<1>&, float, int);
template RayPoint<3> evaluate<3>(const MarchRecord<3>&, float, int);
template RayPoint<1> looked_up_point<1>(const MarchRecord<1>&, int);
template RayPoint<3> looked_up_point<3>(const MarchRecord<3>&, int);

}  // namespace brume
