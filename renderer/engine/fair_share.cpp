#include "renderer/engine/fair_share.h"

namespace brume {

std::optional<std::size_t> next_turn(std::span<const Turn> jobs, Share share, std::size_t first_look) {
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const std::size_t job = (first_look + i) % jobs.size();
    if (jobs[job].waits && !jobs[job].shown) return job;
  }
  const auto had = [&](const Turn& t) { return share == Share::EqualTime ? t.cpu_seconds : t.samples; };
  std::optional<std::size_t> next;
  for (std::size_t i = 0; i < jobs.size(); ++i)
    if (jobs[i].waits && (!next || had(jobs[i]) < had(jobs[*next]))) next = i;
  return next;
}

}  // namespace brume
