// A published table to its last digit: van de Hulst's slab with matched indices.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/reference_probe.h"

namespace brume {
namespace {

struct Published {
  const char* quantity;            ///< in published.json
  double value;                    ///< as printed, without the light that is not scattered
  std::uint64_t quick, full;       ///< samples
  double quick_error, full_error;  ///< standard error that these must reach
};

// mu_a 10/cm, mu_s 90/cm, g 0.75, 0.02 cm thick, light at normal incidence: reflectance 0.09739, transmittance 0.66096,
// of which exp(-2) is not scattered. Van de Hulst 1980, "Multiple Light Scattering", table 35; Wang, Jacques & Zheng
// 1995, "MCML - Monte Carlo modeling of light transport in multi-layered tissues", table 1.
//
// One sample deviates by 0.2 (reflectance) and 0.64 (transmittance), so that the four digits of the tables, 5e-5, take
// 1.7 and 16 times 10^7 samples: seconds by the hundred. Only when full; a change is held to 1.2e-4 and 4.7e-4.
TEST(PublishedSlab, VanDeHulstsReflectanceAndTransmittanceOfAllOrders) {
  const Published all[] = {{"flux R, all orders", 0.09739, 3'000'000, 20'000'000, 1.25e-4, 5e-5},
                           {"flux T, all orders", 0.66096 - std::exp(-2.0), 2'000'000, 170'000'000, 4.8e-4, 5e-5}};
  const auto cases = read_reference_cases(BRUME_SOURCE_DIR "/tests/render/reference/published.json");
  ASSERT_TRUE(cases.ok()) << cases.error().to_string();
  for (const Published& published : all) {
    const ReferenceCase& c = cases->front();
    ASSERT_EQ(c.id, "pub_vdh35_mcml");
    int found = 0;
    for (const ReferenceQuantity& q : c.quantities) {
      if (q.name != published.quantity) continue;
      ++found;
      EXPECT_NEAR(q.expected[0], published.value, 5.5e-6) << "the reference file against the printed table";
      auto probe =
          ReferenceProbe::make(c, q, {"decoupled", DistanceSampling::Density, 0, SamplerKind::Independent, 35});
      ASSERT_TRUE(probe.ok()) << probe.error().to_string();
      const ReferenceEstimate e = probe->flux((full_effort() ? published.full : published.quick) / kFewer);
      const double error = e.standard_error[0];
      std::printf("%s: %.6f +- %.6f, published %.5f\n", published.quantity, e.mean[0], error, published.value);
      EXPECT_EQ(e.non_finite, 0u);
      EXPECT_LT(error, (full_effort() ? published.full_error : published.quick_error) * std::sqrt(kFewer));
      // Half a unit of the last printed digit, and 4 standard errors.
      EXPECT_NEAR(e.mean[0], published.value, 4 * error + 5e-6) << published.quantity;
    }
    EXPECT_EQ(found, 1) << published.quantity;
  }
}

}  // namespace
}  // namespace brume
