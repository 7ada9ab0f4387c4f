#include "renderer/experiments/thread_model.h"

#include <chrono>
#include <functional>
#include <queue>

#include "renderer/engine/pass.h"
#include "renderer/integrators/registry.h"

namespace brume {
namespace {

using Clock = std::chrono::steady_clock;

/// Notes when each tile begins. A single thread takes the tiles in order, and all pixels of each.
class Stopwatch final : public Integrator {
 public:
  Stopwatch(const Integrator& integrator, int width, int height) : integrator_(integrator) {
    for (int y = 0; y < height; y += kTileSize)
      for (int x = 0; x < width; x += kTileSize)
        pixels_.push_back(std::min(kTileSize, width - x) * std::min(kTileSize, height - y));
  }

  Color radiance(const Ray& ray, SampleContext& context) const override {
    if (left_ == 0) {
      left_ = pixels_[begins_.size()];
      begins_.push_back(Clock::now());
    }
    --left_;
    return integrator_.radiance(ray, context);
  }

  std::vector<double> seconds(Clock::time_point end) const {
    std::vector<double> out;
    for (std::size_t i = 0; i < begins_.size(); ++i)
      out.push_back(
          std::chrono::duration<double>((i + 1 < begins_.size() ? begins_[i + 1] : end) - begins_[i]).count());
    return out;
  }

 private:
  const Integrator& integrator_;
  std::vector<int> pixels_;
  mutable int left_ = 0;
  mutable std::vector<Clock::time_point> begins_;
};

}  // namespace

std::vector<double> tile_seconds(const Scene& scene, int width, int height) {
  const auto integrator = make_integrator(scene);
  WorkerPool pool(1);
  Film film(width, height);
  render_pass(scene, *integrator, 0, film, pool, {});  // the caches are warm afterwards
  const Stopwatch stopwatch(*integrator, width, height);
  render_pass(scene, stopwatch, 1, film, pool, {});
  return stopwatch.seconds(Clock::now());
}

double loop_seconds(const std::vector<double>& tasks, int threads) {
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  for (int t = 0; t < threads; ++t) free_at.push(0);
  double end = 0;
  for (const double task : tasks) {
    const double done = free_at.top() + task;
    free_at.pop();
    free_at.push(done);
    end = std::max(end, done);
  }
  return end;
}

}  // namespace brume
