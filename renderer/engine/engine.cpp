#include "renderer/engine/engine.h"

#include "renderer/engine/pass.h"
#include "renderer/film/film.h"
#include "renderer/integrators/registry.h"

namespace brume {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr double kFirstLookSeconds = 0.033;  // the coarse first picture after an edit may take this long
constexpr int kMaxDivisor = 32;
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
  std::size_t index;
  std::unique_ptr<const Integrator> integrator;
  Film film;        // of older samples until the first full pass
  int divisor = 0;  // of the next coarse pass; 1: the film's passes; 0: nothing has been shown yet
  RenderStatistics statistics = {};
  Clock::time_point published = {};

  bool finished() const { return statistics.samples_per_pixel >= job.max_samples; }
};

Engine::Engine(int threads, std::function<void()> on_picture)
    : pool_(threads), on_picture_(std::move(on_picture)), seconds_per_ray_(kGuessedSecondsPerRay) {
  director_ = std::jthread([this](const std::stop_token& stop) { direct(stop); });
}

Engine::~Engine() {
  stopping_ = true;
  director_.request_stop();
}

void Engine::submit(std::vector<Job> jobs) {
  const std::lock_guard lock(mutex_);
  wishes_ = std::move(jobs);
  newest_wish_ = ++wish_number_;
  changed_.notify_all();
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

bool Engine::wishes_changed() const { return stopping_ || newest_wish_ != current_wish_; }

void Engine::direct(const std::stop_token& stop) {
  std::vector<Progress> jobs;
  while (!stop.stop_requested()) {
    Progress* next = nullptr;
    {
      std::unique_lock lock(mutex_);
      const auto has_work = [&] {
        next = nullptr;
        if (wish_number_ != current_wish_) return true;
        for (Progress& job : jobs)
          if (!job.finished() && (!paused_ || job.divisor == 0) &&
              (!next || job.divisor == 0 ||
               (next->divisor != 0 && job.statistics.samples_per_pixel < next->statistics.samples_per_pixel)))
            next = &job;
        return next != nullptr;
      };
      if (!changed_.wait(lock, stop, has_work)) return;
      if (wish_number_ != current_wish_) {
        current_wish_ = wish_number_;
        // Films are kept: fresh memory of this size costs more time than a first look may take.
        std::vector<Film> films;
        for (Progress& job : jobs) films.push_back(std::move(job.film));
        films.resize(wishes_.size());
        jobs.clear();
        // Pictures of the old wishes stay up until the first of the new ones is there: nothing flashes black.
        pictures_.resize(wishes_.size());
        for (std::size_t i = 0; i < wishes_.size(); ++i) {
          const Job& wish = wishes_[i];
          jobs.push_back({wish, i, make_integrator(*wish.scene), std::move(films[i])});
        }
        continue;
      }
    }
    render_next(*next);
  }
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

void Engine::render_next(Progress& job) {
  const auto start = Clock::now();
  const Scene& scene = *job.job.scene;
  const double cpu_before = job.statistics.cpu_seconds;
  double pixels = static_cast<double>(job.job.width) * job.job.height;
  bool complete = true;
  if (job.divisor == 0) {
    // As fine as fits the time that a first look may take.
    const double affordable = kFirstLookSeconds * pool_.threads() / seconds_per_ray_;
    job.divisor = 1;
    while (job.divisor < kMaxDivisor && pixels / (job.divisor * job.divisor) > affordable) job.divisor *= 2;
    // A first look is coarse even where the full picture would fit: it must always be completed, whatever it costs.
    job.divisor = std::max(job.divisor, 2);
    Image image;
    render_coarse(scene, *job.integrator, job.job.width, job.job.height, job.divisor, image, pool_, {});
    account(job, start);
    pixels /= job.divisor * job.divisor;
    publish(job, {std::move(image)}, job.divisor);
    job.divisor /= 2;
  } else if (job.divisor > 1) {
    Image image;
    complete = render_coarse(scene, *job.integrator, job.job.width, job.job.height, job.divisor, image, pool_,
                             [this] { return wishes_changed(); });
    account(job, start);
    pixels /= job.divisor * job.divisor;
    if (complete) {
      publish(job, {std::move(image)}, job.divisor);
      job.divisor /= 2;
    }
  } else {
    const auto sample = static_cast<std::uint32_t>(job.statistics.samples_per_pixel);
    if (sample == 0) start_film(job);
    complete = render_pass(scene, *job.integrator, sample, job.film, pool_, [this] { return wishes_changed(); });
    account(job, start);
    if (complete) {
      ++job.statistics.samples_per_pixel;
      if (Clock::now() - job.published >= kLeastPublishInterval || job.finished())
        publish(job, view_of(job.film, pool_), 1);
    }
  }
  if (complete) seconds_per_ray_ = std::max((job.statistics.cpu_seconds - cpu_before) / pixels, 1e-9);
}

void Engine::publish(Progress& job, FilmView view, int divisor) {
  auto picture = std::make_shared<Picture>();
  picture->image = std::move(view.mean);
  picture->width = job.job.width;
  picture->height = job.job.height;
  picture->divisor = divisor;
  picture->generation = job.job.scene->generation;
  picture->noise = view.noise;
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
                              const std::function<bool(const BatchProgress&)>& after_pass) {
  const auto start = Clock::now();
  const auto integrator = make_integrator(scene);
  RenderStatistics statistics;
  statistics.threads = pool.threads();
  static_cast<void>(pool.take_totals());
  for (int sample = 0; sample < samples; ++sample) {
    render_pass(scene, *integrator, static_cast<std::uint32_t>(sample), film, pool, {});
    add(statistics, pool.take_totals());
    statistics.samples_per_pixel = sample + 1;
    statistics.wall_seconds = seconds_since(start);
    if (after_pass && !after_pass({film, statistics})) break;
  }
  return statistics;
}

}  // namespace brume
