#include "renderer/media/shader.h"

namespace brume {

void Shader::emission(const PointBatch& points, float* emission) const { density(points, emission); }

}  // namespace brume
