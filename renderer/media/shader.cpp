#include "renderer/media/shader.h"

#include <algorithm>

namespace brume {

void Shader::emission(const PointBatch& points, const EmissionBatch& emission) const {
  density(points, emission[0]);
  for (int c = 1; c < 3; ++c) std::copy_n(emission[0], points.n, emission[static_cast<std::size_t>(c)]);
}

}  // namespace brume
