#include "renderer/engine/engine.h"

#include "renderer/engine/pass.h"
#include "renderer/film/film.h"
#include "renderer/integrators/registry.h"

namespace brume {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr double kFirstLookSeconds = 0.033;  // the coarse first pictures after an edit may take this long together
constexpr double kTurnSeconds = 0.1;         // of one job among several
constexpr int kMaxDivisor = 32;
// Where a pass draws more light samples of each light, a preview of the full resolution comes before the first one. It
// is soon there, and with so many samples the first pass would be late. Not of one job among several: their turns are
// short, and their pictures small.
constexpr int kFewLightSamples = 4;
constexpr double kGuessedSecondsPerRay = 20e-6;                        // before anything was measured: on the safe side
constexpr auto kLeastPublishInterval = std::chrono::milliseconds(15);  // no display shows more pictures than that

void add(RenderStatistics& sum, const WorkerPool::Totals& totals) {
  sum.rays += totals.statistics;
  sum.cpu_seconds += totals.cpu_seconds;
  sum.pool_high_water_bytes = std::max(sum.pool_high_water_bytes, totals.arena_high_water_bytes);
}

}  // namespace

struct Engine::Progress {
  Job job;
  std::size_t index = 0;
  std::unique_ptr<const Integrator> integrator = {};
  Film film = {};        // of older samples until the first full pass
  bool shown = false;    // a first picture has been published
  int preview = 0;       // divisor of the next preview; 0: the film's passes
  int next_tile = 0;     // of the film's pass under way
  bool spoiled = false;  // a pass was given up in the middle: some pixels have a sample more than others
  RenderStatistics statistics = {};
  Clock::time_point published = {};

  bool finished() const { return statistics.samples_per_pixel >= job.max_samples; }
  double samples() const {
    return statistics.samples_per_pixel + static_cast<double>(next_tile) / tile_count(job.width, job.height);
  }
};

Engine::Engine(const EngineOptions& options) : pool_(options.threads, options.clock), on_picture_(options.on_picture) {
  director_ = std::jthread([this](const std::stop_token& stop) { direct(stop); });
}

Engine::~Engine() {
  stopping_ = true;
  director_.request_stop();
}

void Engine::submit(std::vector<Job> jobs, bool restart) {
  const std::lock_guard lock(mutex_);
  wishes_ = std::move(jobs);
  wished_ = news_ = true;
  restart_ |= restart;
  cancel_ = restart_ || !running_ || std::find(wishes_.begin(), wishes_.end(), *running_) == wishes_.end();
  changed_.notify_all();
}

void Engine::set_share(Share share) {
  const std::lock_guard lock(mutex_);
  share_ = share;
}

void Engine::pause(bool paused) {
  const std::lock_guard lock(mutex_);
  paused_ = paused;
  changed_.notify_all();
}

bool Engine::paused() const {
  const std::lock_guard lock(mutex_);
  return paused_;
}

std::shared_ptr<const Picture> Engine::picture(std::size_t job) const {
  const std::lock_guard lock(mutex_);
  return job < pictures_.size() ? pictures_[job] : nullptr;
}

Cancelled Engine::cancelled() const {
  return [this] { return stopping_ || cancel_; };
}

std::optional<std::size_t> Engine::next_job(const std::vector<Progress>& jobs) const {
  std::vector<Turn> turns;
  for (const Progress& job : jobs)
    turns.push_back({.waits = !job.finished() && (!paused_ || !job.shown),
                     .shown = job.shown,
                     .samples = job.samples(),
                     .cpu_seconds = job.statistics.cpu_seconds});
  return next_turn(turns, share_, first_look_);
}

void Engine::direct(const std::stop_token& stop) {
  std::vector<Progress> jobs;
  while (!stop.stop_requested()) {
    std::optional<std::size_t> next;
    {
      std::unique_lock lock(mutex_);
      running_.reset();
      const auto has_work = [&] { return wished_ || (next = next_job(jobs)).has_value(); };
      if (!changed_.wait(lock, stop, has_work)) return;
      if (!wished_) running_ = jobs[*next].job;
    }
    if (next)
      render_next(jobs[*next], jobs.size());
    else
      take_up_wishes(jobs);
  }
}

void Engine::take_up_wishes(std::vector<Progress>& jobs) {
  std::vector<Job> wishes;
  bool restart;
  {
    const std::lock_guard lock(mutex_);
    wishes = wishes_;
    restart = std::exchange(restart_, false);
    wished_ = news_ = false;
    cancel_ = false;
  }
  std::vector<Progress> old = std::move(jobs);
  const auto take_same = [&](const Job& wish) -> std::optional<Progress> {
    const auto same =
        std::find_if(old.begin(), old.end(), [&](const Progress& p) { return p.job == wish && !p.spoiled; });
    if (restart || same == old.end()) return std::nullopt;
    Progress kept = std::move(*same);
    old.erase(same);
    return kept;
  };
  // Pictures of the old wishes stay up until the first of the new ones is there: nothing flashes black.
  std::vector<std::shared_ptr<const Picture>> pictures(wishes.size());
  jobs.resize(wishes.size());
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    auto kept = take_same(wishes[i]);
    pictures[i] = picture(kept ? kept->index : i);
    jobs[i] = kept ? std::move(*kept) : Progress{.job = wishes[i]};
    jobs[i].index = i;
  }
  // What prepares an integrator may take long: not under the lock that the UI asks for pictures with.
  for (Progress& job : jobs) {
    if (job.integrator) continue;
    job.integrator = make_integrator(*job.job.scene);
    job.statistics.cpu_seconds = job.integrator->preparation_seconds();
    // Films are kept: fresh memory of this size costs more time than a first look may take.
    if (old.empty()) continue;
    job.film = std::move(old.back().film);
    old.pop_back();
  }
  seconds_per_ray_.resize(jobs.size(), kGuessedSecondsPerRay);
  const std::lock_guard lock(mutex_);
  pictures_ = std::move(pictures);
}

void Engine::account(Progress& job, Clock::time_point start) {
  const WorkerPool::Totals totals = pool_.take_totals();
  add(job.statistics, totals);
  job.statistics.wall_seconds += seconds_since(start);
  job.statistics.threads = pool_.threads();
}

void Engine::start_film(Progress& job) {
  if (job.film.width() != job.job.width || job.film.height() != job.job.height)
    job.film.resize(job.job.width, job.job.height);
  else
    pool_.run(job.job.height, [&](int y, Worker&) { job.film.clear_row(y); });
}

void Engine::render_next(Progress& job, std::size_t jobs) {
  const double cpu_before = job.statistics.cpu_seconds;
  const double rays = job.shown && job.preview == 0 ? render_slice(job, jobs) : render_next_preview(job, jobs);
  if (rays > 0) seconds_per_ray_[job.index] = std::max((job.statistics.cpu_seconds - cpu_before) / rays, 1e-9);
}

double Engine::render_next_preview(Progress& job, std::size_t jobs) {
  const auto start = Clock::now();
  const int width = job.job.width, height = job.job.height;
  const double pixels = static_cast<double>(width) * height;
  const bool first = !job.shown;
  if (first) {
    first_look_ = job.index + 1;
    // As fine as fits the time that a first look may take, but coarse even where the full picture would fit: it is
    // always completed, whatever it turns out to cost.
    const double affordable =
        kFirstLookSeconds / static_cast<double>(jobs) * pool_.threads() / seconds_per_ray_[job.index];
    job.preview = 2;
    while (job.preview < kMaxDivisor && pixels / (job.preview * job.preview) > affordable) job.preview *= 2;
  }
  Image image;
  const bool complete = render_preview(*job.job.scene, *job.integrator, width, height, job.preview, image, pool_,
                                       first ? Cancelled() : cancelled());
  account(job, start);
  if (!complete) return 0;
  publish(job, {std::move(image)}, job.preview);
  const double rays = pixels / (job.preview * job.preview);
  job.shown = true;
  job.preview /= 2;
  if (job.preview == 1 && (jobs > 1 || job.job.scene->light_samples <= kFewLightSamples)) job.preview = 0;
  return rays;
}

double Engine::render_slice(Progress& job, std::size_t jobs) {
  const auto start = Clock::now();
  const int width = job.job.width, height = job.job.height, tiles = tile_count(width, height);
  const int samples = job.statistics.samples_per_pixel;
  if (samples == 0 && job.next_tile == 0) start_film(job);
  TileRange turn{job.next_tile, tiles};
  if (jobs > 1) {
    const double seconds_per_tile = kTileSize * kTileSize * seconds_per_ray_[job.index];
    const double affordable = kTurnSeconds * pool_.threads() / seconds_per_tile;
    if (affordable < tiles) turn.end = std::min(tiles, turn.first + std::max(pool_.threads(), int(affordable)));
  }
  const auto end =
      render_pass(*job.job.scene, *job.integrator, job.job.first_sample + static_cast<std::uint32_t>(samples), job.film,
                  pool_, cancelled(), turn, [this] { return news_.load(); });
  account(job, start);
  job.spoiled |= !end;
  if (!end) return 0;
  job.next_tile = *end;
  if (job.next_tile == tiles) {
    job.next_tile = 0;
    ++job.statistics.samples_per_pixel;
    if (Clock::now() - job.published >= kLeastPublishInterval || job.finished())
      publish(job, view_of(job.film, pool_), 0);
  }
  return static_cast<double>(width) * height * (*end - turn.first) / tiles;
}

/// @param preview  divisor of the preview; 0: the film's picture
void Engine::publish(Progress& job, FilmView view, int preview) {
  auto picture = std::make_shared<Picture>();
  picture->image = std::move(view.mean);
  picture->width = job.job.width;
  picture->height = job.job.height;
  picture->divisor = std::max(preview, 1);
  picture->preview = preview > 0;
  picture->generation = job.job.scene->generation;
  picture->noise = view.noise;
  picture->variance = view.variance;
  picture->finished = job.finished();
  picture->statistics = job.statistics;
  job.published = Clock::now();
  {
    const std::lock_guard lock(mutex_);
    if (job.index < pictures_.size()) pictures_[job.index] = std::move(picture);
  }
  if (on_picture_) on_picture_();
}

RenderStatistics render_batch(const Scene& scene, int samples, Film& film, WorkerPool& pool,
                              const std::function<bool(const BatchProgress&)>& after_pass, std::uint32_t first_sample) {
  const auto start = Clock::now();
  const auto integrator = make_integrator(scene);
  RenderStatistics statistics;
  statistics.threads = pool.threads();
  statistics.cpu_seconds = integrator->preparation_seconds();
  static_cast<void>(pool.take_totals());
  for (int sample = 0; sample < samples; ++sample) {
    render_pass(scene, *integrator, first_sample + static_cast<std::uint32_t>(sample), film, pool, {});
    add(statistics, pool.take_totals());
    statistics.samples_per_pixel = sample + 1;
    statistics.wall_seconds = seconds_since(start);
    if (after_pass && !after_pass({film, statistics})) break;
  }
  return statistics;
}

}  // namespace brume
