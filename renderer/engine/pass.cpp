#include "renderer/engine/pass.h"

#include <atomic>
#include <mutex>

namespace brume {
namespace {

constexpr std::uint64_t kTwinSeed = 0x7477696E00000000;  // above the seeds that a scene can name

struct Grid {
  int width, height;
  int columns() const { return (width + kTileSize - 1) / kTileSize; }
  int rows() const { return (height + kTileSize - 1) / kTileSize; }
};

/// Where a slice ends: such that all tiles before the end have begun and none after it, whichever thread asks first.
class SliceEnd {
 public:
  SliceEnd(int end, const Cancelled& enough) : end_(end), enough_(enough) {}

  bool begins(int tile) {
    const std::lock_guard lock(mutex_);
    if (!ended_ && enough_ && enough_()) {
      ended_ = true;
      end_ = std::max(last_begun_ + 1, tile);
    }
    if (tile >= end_) return false;
    last_begun_ = std::max(last_begun_, tile);
    return true;
  }
  int tile() const { return end_; }

 private:
  std::mutex mutex_;
  int end_, last_begun_ = -1;
  bool ended_ = false;
  const Cancelled& enough_;
};

/// Calls pixel(x, y, worker) for every pixel.  @return as render_pass()
template <class Pixel>
std::optional<int> for_each_pixel(const Grid& grid, WorkerPool& pool, const Cancelled& cancelled, TileRange tiles,
                                  const Cancelled& enough, const Pixel& pixel) {
  std::atomic<bool> stopped = false;
  const int last = std::min(tiles.end, grid.columns() * grid.rows());
  SliceEnd end(last, enough);
  pool.run(std::max(last - tiles.first, 0), [&](int i, Worker& worker) {
    const int tile = tiles.first + i;
    if (!end.begins(tile)) return;
    const int x0 = tile % grid.columns() * kTileSize, y0 = tile / grid.columns() * kTileSize;
    for (int y = y0; y < std::min(y0 + kTileSize, grid.height); ++y) {
      if (stopped || (cancelled && cancelled())) {
        stopped = true;
        return;
      }
      for (int x = x0; x < std::min(x0 + kTileSize, grid.width); ++x) pixel(x, y, worker);
    }
  });
  if (stopped) return std::nullopt;
  return end.tile();
}

}  // namespace

Color sample_pixel(const PixelPass& pass, const PixelPlace& place, Arena& arena, RayStatistics& statistics,
                   RayDiagnostics* diagnostics) {
  const Scene& scene = pass.scene;
  const Sampler sampler(pass.numbers, place.x, place.y, place.width);
  const Vec2 inside = sampler.u2(Decision::Pixel);
  const float width = static_cast<float>(place.width), height = static_cast<float>(place.height);
  const Ray ray = scene.camera.ray((static_cast<float>(place.x) + inside.x) / width,
                                   (static_cast<float>(place.y) + inside.y) / height, width / height);
  SampleContext context{scene, sampler, arena, statistics, diagnostics, pass.preview};
  return pass.integrator.radiance(ray, context);
}

int tile_count(int width, int height) {
  const Grid grid{width, height};
  return grid.columns() * grid.rows();
}

std::optional<int> render_pass(const Scene& scene, const Integrator& integrator, std::uint32_t sample, Film& film,
                               WorkerPool& pool, const Cancelled& cancelled, TileRange tiles, const Cancelled& enough) {
  const Grid grid{film.width(), film.height()};
  const SamplerPass pass(scene.render.sampler, scene.render.seed, sample);
  const SamplerPass twin_pass(scene.render.sampler, scene.render.seed ^ kTwinSeed, sample);
  return for_each_pixel(grid, pool, cancelled, tiles, enough, [&](int x, int y, Worker& worker) {
    const auto one = [&](const SamplerPass& numbers) {
      return sample_pixel({scene, integrator, numbers}, {x, y, grid.width, grid.height}, worker.arena,
                          worker.statistics);
    };
    if (!film.add_sample(x, y, one(pass))) ++worker.statistics.non_finite;
    if (Film::has_twin(x, y)) film.add_twin_sample(x, y, one(twin_pass));
  });
}

bool render_preview(const Scene& scene, const Integrator& integrator, int width, int height, int divisor, Image& image,
                    WorkerPool& pool, const Cancelled& cancelled) {
  const Grid grid{(width + divisor - 1) / divisor, (height + divisor - 1) / divisor};
  const SamplerPass numbers(scene.render.sampler, scene.render.seed, 0);
  const PixelPass pass{scene, integrator, numbers, true};
  image = Image(grid.width, grid.height);
  const auto end = for_each_pixel(grid, pool, cancelled, {}, {}, [&](int x, int y, Worker& worker) {
    const Color c = sample_pixel(pass, {x, y, grid.width, grid.height}, worker.arena, worker.statistics);
    if (is_finite(c))
      image.at(x, y) = c;
    else
      ++worker.statistics.non_finite;
  });
  return end.has_value();
}

FilmView view_of(const Film& film, WorkerPool& pool) {
  FilmView view{Image(film.width(), film.height())};
  std::vector<Film::NoiseSums> rows(static_cast<std::size_t>(film.height()));
  pool.run(film.height(), [&](int y, Worker&) {
    film.mean_row(y, view.mean);
    rows[static_cast<std::size_t>(y)] = film.noise_of_row(y);
  });
  Film::NoiseSums sums;
  for (const Film::NoiseSums& row : rows) sums.add(row);
  view.noise = sums.estimate();
  view.variance = sums.mean_variance();
  return view;
}

}  // namespace brume
