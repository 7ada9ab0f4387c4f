#include "renderer/phase/phase_mix.h"

namespace brume {

Droplets water_droplets(float diameter) {
  const double d = std::clamp(static_cast<double>(diameter), 1.5, 50.0);
  double g_hg, g_draine, alpha, share;
  if (d >= 5) {
    g_hg = std::exp(-0.0990567 / (d - 1.67154));
    g_draine = std::exp(-2.20679 / (d + 3.91029) - 0.428934);
    alpha = std::exp(3.62489 - 8.29288 / (d + 5.52825));
    share = std::exp(-0.599085 / (d - 0.641583) - 0.665888);
  } else {
    const double l = std::log(d), ll = std::log(l);
    g_hg = 0.0604931 * ll + 0.940256;
    g_draine = 0.500411 - 0.081287 / (-2 * l + std::tan(l) + 1.27551);
    alpha = 7.30354 * l + 6.31675;
    share = 0.026914 * (l - std::cos(5.68947 * (ll - 0.0292149))) + 0.376475;
  }
  return {HenyeyGreenstein(g_hg), Draine(g_draine, alpha), static_cast<float>(share)};
}

}  // namespace brume
