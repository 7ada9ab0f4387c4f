#include "renderer/lights/point_light.h"

namespace brume {

LightPoint PointLight::sample_point(Vec2) const { return {.position = position_, .sent = intensity_}; }

}  // namespace brume
