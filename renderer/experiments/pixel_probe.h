// Why a pixel looks as it does: what its ray meets, and where on it light is sampled.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "renderer/analysis/chart.h"
#include "renderer/engine/pass.h"

namespace brume {

/// The medium on the ray through a pixel's middle, and the densities with which its distances may be drawn. Segments
/// are those of the march, looked up in their middles; coefficients are means over the channels.
struct RayProfile {
  std::vector<double> t;              ///< [n + 1] edges, world units from the camera; empty: there is no medium
  std::vector<double> sigma_t;        ///< [n] per world unit
  std::vector<double> transmittance;  ///< [n + 1] from the camera
  std::vector<double> density_pdf;    ///< [n] mean over the segment, per world unit; empty: nothing scatters
  /// About a light that has a place.
  struct OfLight {
    std::size_t light;                    ///< of the scene's
    std::vector<double> equiangular_pdf;  ///< [n]
    std::vector<double> product_pdf;      ///< [n]
  };
  std::vector<OfLight> lights;  ///< at most two, or nobody could read the plot
};

struct PixelProbe {
  PixelPlace place = {};
  int samples = 0;  ///< those that were not finite left out
  int non_finite = 0;
  Color radiance;                      ///< mean of the samples, W/(sr m^2): the picture's pixel after as many
  Color variance;                      ///< of one sample
  Color optical_depth, transmittance;  ///< of the camera rays, means over the samples
  double segments = 0;                 ///< the same
  RayProfile profile;

  struct LightSample {
    double t;  ///< from the camera, world units
    DistanceTechnique technique;
    double carried;  ///< as LightSampleNote::carried
  };
  std::vector<LightSample> light_samples;  ///< of the first sixteen samples
  /// Of what all light samples carry, the part whose distance each technique has drawn. Under MIS that is the mean
  /// weight of the technique, weighted by the light.
  double density_share = 0, equiangular_share = 0, product_share = 0;
};

struct ProbeOptions {
  PixelPlace place = {};
  int samples = 64;
};

/// Renders the pixel anew, with the very numbers of the picture.  @return nothing when it was cancelled
std::optional<PixelProbe> probe_pixel(const Scene& scene, const Integrator& integrator, const ProbeOptions& options,
                                      const std::stop_token& cancel = {});

/// Along the ray, each as a share of its own maximum: sigma_t; the densities of density, equi-angular ("angle") and
/// product sampling, of each light; the light samples, by what they carry, named by what has drawn them. And the
/// transmittance T.
Chart chart_of(const PixelProbe& probe, const Scene& scene);

}  // namespace brume
