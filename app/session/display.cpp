#include "app/session/display.h"

namespace brume {

DisplaySettings display_settings(const Node& film) {
  DisplaySettings s;
  s.exposure_stops = static_cast<float>(film.number("exposure"));
  const std::string& curve = film.text("curve");
  s.curve = curve == "filmic" ? DisplayCurve::Filmic : curve == "gamma" ? DisplayCurve::Gamma : DisplayCurve::Srgb;
  s.gamma = static_cast<float>(film.number("gamma"));
  return s;
}

}  // namespace brume
