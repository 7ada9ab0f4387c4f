#include "renderer/lights/directional_light.h"

namespace brume {

LightPoint DirectionalLight::sample_point(Vec2) const { return {LightPoint::Kind::Distant, {}, -travel_}; }

IncidentLight DirectionalLight::incident(const LightPoint&, Vec3) const {
  return {-travel_, std::numeric_limits<float>::infinity(), irradiance_};
}

}  // namespace brume
