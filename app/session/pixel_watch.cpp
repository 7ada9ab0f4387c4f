#include "app/session/pixel_watch.h"

#include <algorithm>

#include "renderer/integrators/registry.h"

namespace brume {
namespace {

constexpr int kFewest = 16, kMost = 1024;

}  // namespace

PixelWatch::PixelWatch(std::function<void()> on_news) : on_news_(std::move(on_news)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

PixelWatch::~PixelWatch() {
  const std::lock_guard lock(mutex_);
  stale_.request_stop();
}

std::shared_ptr<const PixelProbe> PixelWatch::probe() const {
  const std::lock_guard lock(mutex_);
  return probe_;
}

void PixelWatch::want(std::shared_ptr<const Scene> scene, const PixelPlace& place, int samples) {
  samples = std::clamp(samples, kFewest, kMost);
  const std::lock_guard lock(mutex_);
  const bool same = scene == wish_.scene && place == wish_.place;
  if (same && samples < 2 * wish_.samples && samples != kMost) return;
  if (same && samples == wish_.samples) return;
  if (!same) {
    stale_.request_stop();
    probe_.reset();
  }
  wish_ = {std::move(scene), place, samples};
  is_served_ = wish_.scene == nullptr;
  wished_.notify_all();
}

void PixelWatch::serve(const std::stop_token& stop) {
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<const Integrator> integrator;  // of that scene
  while (true) {
    Wish wish;
    std::stop_token stale;
    {
      std::unique_lock lock(mutex_);
      if (!wished_.wait(lock, stop, [&] { return !is_served_; })) return;
      wish = wish_;
      is_served_ = true;
      stale_ = {};
      stale = stale_.get_token();
    }
    if (scene != wish.scene) {
      scene = wish.scene;
      integrator = make_integrator(*scene);
    }
    auto probe = probe_pixel(*scene, *integrator, {wish.place, wish.samples}, stale);
    if (!probe) continue;
    {
      const std::lock_guard lock(mutex_);
      if (wish_.scene != wish.scene || !(wish_.place == wish.place)) continue;
      probe_ = std::make_shared<const PixelProbe>(std::move(*probe));
    }
    if (on_news_) on_news_();
  }
}

}  // namespace brume
