// One sample per pixel of one scene.
#pragma once

#include <functional>
#include <optional>

#include "renderer/engine/worker_pool.h"
#include "renderer/film/film.h"
#include "renderer/integrators/integrator.h"

namespace brume {

/// Edge of the tiles that threads take one after the other; pixels. Small enough to share evenly, large enough to keep
/// its voxels in the cache.
inline constexpr int kTileSize = 32;

/// Asked once per row of a tile, from every worker; true gives the pass up.
using Cancelled = std::function<bool()>;

/// A pixel of a picture of width x height.
struct PixelPlace {
  int x, y, width, height;

  bool operator==(const PixelPlace&) const = default;
};

/// What the samples of a pass have in common.
struct PixelPass {
  const Scene& scene;
  const Integrator& integrator;
  const SamplerPass& numbers;  ///< of sample number n: SamplerPass(scene.render.sampler, scene.render.seed, n)
  bool preview = false;        ///< as SampleContext::preview
};

/// One sample of a pixel, the same that render_pass() adds to a film.
Color sample_pixel(const PixelPass& pass, const PixelPlace& place, Arena& arena, RayStatistics& statistics,
                   RayDiagnostics* diagnostics = nullptr);

/// Some of a picture's tiles, which are numbered by rows.
struct TileRange {
  int first = 0, end = 1 << 30;  ///< beyond the last tile: up to it
};
int tile_count(int width, int height);

/// Adds sample number `sample` to the pixels of the film, whose size is the picture's. A pixel's samples depend on
/// the scene, its position and the sample number only, so any number of threads gives the same bits.
/// @param tiles  a pass may be made in slices
/// @param enough  asked before every tile; true ends the slice with the tiles that have begun
/// @return where the slice has ended: the first tile that is not rendered. Nothing when it was cancelled; the film then
/// holds part of the pass
std::optional<int> render_pass(const Scene& scene, const Integrator& integrator, std::uint32_t sample, Film& film,
                               WorkerPool& pool, const Cancelled& cancelled, TileRange tiles = {},
                               const Cancelled& enough = {});

/// A picture of the same view, smaller by `divisor` in width and height (rounded up), of one sample per pixel with one
/// light sample of each light.
/// @param width, height  of the full picture.  @return false when it was cancelled
bool render_preview(const Scene& scene, const Integrator& integrator, int width, int height, int divisor, Image& image,
                    WorkerPool& pool, const Cancelled& cancelled);

/// What there is to show of a film.
struct FilmView {
  Image mean;
  double noise = 0;     ///< as Film::noise_estimate()
  double variance = 0;  ///< as Film::mean_variance()
};
FilmView view_of(const Film& film, WorkerPool& pool);

}  // namespace brume
