#include "renderer/experiments/live_sweep.h"

#include <algorithm>

namespace brume {

LiveSweep::LiveSweep(std::function<void()> on_rows)
    : on_rows_(std::move(on_rows)), sweep_(std::make_shared<const Sweep>()) {
  thread_ = std::jthread([this](const std::stop_token& stop) { measure(stop); });
}

LiveSweep::~LiveSweep() = default;

std::shared_ptr<const Sweep> LiveSweep::sweep() const {
  const std::lock_guard lock(mutex_);
  return sweep_;
}

/// Under the lock: the same sweep with other rows.
void LiveSweep::publish(std::vector<SweepRow> rows) {
  auto next = std::make_shared<Sweep>(*sweep_);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const SweepRow& a, const SweepRow& b) { return a.variant < b.variant; });
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].last = i + 1 == rows.size() || rows[i + 1].variant != rows[i].variant;
  next->rows = std::move(rows);
  next->references.assign(1, {});
  if (reference_) {
    Reference& told = next->references.front();
    told.variance = reference_->variance, told.samples_per_pixel = reference_->samples_per_pixel;
    told.cpu_seconds = reference_->cpu_seconds;
  }
  sweep_ = std::move(next);
}

void LiveSweep::follow(std::vector<SweepVariant> variants, std::vector<std::shared_ptr<const Scene>> scenes) {
  const std::lock_guard lock(mutex_);
  std::vector<SweepRow> rows;
  std::vector<int> samples(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const auto& old = sweep_->scenes;
    const auto same = static_cast<std::size_t>(std::find(old.begin(), old.end(), scenes[i]) - old.begin());
    if (same == old.size()) continue;
    samples[i] = samples_[same];
    for (SweepRow row : sweep_->rows)
      if (row.variant == same) {
        row.variant = i;
        rows.push_back(row);
      }
  }
  looks_.clear();
  samples_ = std::move(samples);
  sweep_ = std::make_shared<const Sweep>(Sweep{std::move(variants), std::move(scenes), {}, {}});
  publish(std::move(rows));
}

void LiveSweep::set_reference(std::shared_ptr<const Reference> reference) {
  const std::lock_guard lock(mutex_);
  reference_ = std::move(reference);
  publish(sweep_->rows);
}

void LiveSweep::see(std::size_t variant, const std::shared_ptr<const Picture>& picture) {
  const std::lock_guard lock(mutex_);
  if (!picture || picture->preview || !reference_ || variant >= samples_.size()) return;
  if (picture->generation != sweep_->scenes[variant]->generation) return;
  if (reference_->image.width != picture->width || reference_->image.height != picture->height) return;
  const int samples = picture->statistics.samples_per_pixel;
  if (samples < samples_[variant]) {  // it was started again
    samples_[variant] = 0;
    std::vector<SweepRow> rows = sweep_->rows;
    std::erase_if(rows, [&](const SweepRow& r) { return r.variant == variant; });
    publish(std::move(rows));
  }
  const bool enough = samples_[variant] == 0 || samples >= samples_[variant] * 5 / 4 + 1;
  if (!enough && !(picture->finished && samples > samples_[variant])) return;
  samples_[variant] = samples;
  looks_.push_back({variant, sweep_->scenes[variant], picture});
  seen_.notify_all();
}

void LiveSweep::measure(const std::stop_token& stop) {
  while (true) {
    Look look;
    std::shared_ptr<const Reference> reference;
    {
      std::unique_lock lock(mutex_);
      if (!seen_.wait(lock, stop, [&] { return !looks_.empty(); })) return;
      look = std::move(looks_.front());
      looks_.pop_front();
      reference = reference_;
    }
    if (!reference) continue;
    const auto errors = errors_of(look.picture->image, reference->image);
    if (!errors) continue;
    {
      const std::lock_guard lock(mutex_);
      // What has been replaced meanwhile tells nothing of what is rendered now.
      if (look.variant >= sweep_->scenes.size() || sweep_->scenes[look.variant] != look.scene) continue;
      const RenderStatistics& s = look.picture->statistics;
      std::vector<SweepRow> rows = sweep_->rows;
      rows.push_back({look.variant, s.samples_per_pixel, s.cpu_seconds, *errors, reference->variance, false});
      publish(std::move(rows));
    }
    if (on_rows_) on_rows_();
  }
}

}  // namespace brume
