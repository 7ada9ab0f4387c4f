#include "app/session/truth.h"

namespace brume {

FoundTruth TruthFinder::find(const Node& description, SceneCache& cache, const std::string& folder, int width,
                             int height, std::uint64_t generation) {
  FoundTruth found{.scene = nullptr, .path = "", .kept = {}, .width = width, .height = height, .problem = ""};
  if (const std::string& given = description.child("compare").text("reference"); !given.empty()) {
    if (auto loaded = load_reference(given, width, height))
      found.kept = std::move(*loaded);
    else
      found.problem = loaded.error().to_string();
    return found;
  }
  Node truth = reference_description(description);
  found.path = reference_path(folder, truth, width, height);
  if (!last_ || *last_ != truth) {
    const auto scene = commit(truth, cache, {.generation = generation});
    last_ = std::move(truth);
    // Where the scene itself could be committed, this is a scene that has no unbiased picture.
    last_scene_ = scene ? *scene : nullptr;
    if (!scene) found.problem = scene.error().to_string();
  }
  found.scene = last_scene_;
  if (!found.path.empty()) found.kept = read_reference(found.path, width, height);
  return found;
}

void Truth::want(bool wanted) {
  wanted_ = wanted;
  found_ = {};
  done_ = false;
  seen_.reset(), reference_.reset();
}

bool Truth::take(FoundTruth found) {
  const bool same =
      found.scene && found.scene == found_.scene && found.width == found_.width && found.height == found_.height;
  if (same || !wanted_) return false;
  want(true);
  found_ = std::move(found);
  if (!found_.kept.image.empty()) reference_ = std::make_shared<const Reference>(found_.kept);
  return true;
}

std::optional<Job> Truth::job() const {
  if (!wanted_ || done_ || !found_.scene) return std::nullopt;
  return Job{.scene = found_.scene,
             .width = found_.width,
             .height = found_.height,
             .first_sample = static_cast<std::uint32_t>(found_.kept.samples_per_pixel)};
}

bool Truth::see(const std::shared_ptr<const Picture>& picture, double time) {
  if (!job()) return false;
  if (found_.kept.cpu_seconds >= time) return done_ = true;
  const bool of_it = picture && picture->divisor == 1 && picture->generation == found_.scene->generation &&
                     picture->width == found_.width && picture->height == found_.height;
  // Of fewer than two samples the variance is unknown.
  if (!of_it || picture == seen_ || picture->statistics.samples_per_pixel < 2) return false;
  const RenderStatistics& s = picture->statistics;
  done_ = found_.kept.cpu_seconds + s.cpu_seconds >= time;
  // A quarter more is as good as every pass, and much less work.
  if (!done_ && seen_ && s.samples_per_pixel < 1.25 * seen_->statistics.samples_per_pixel) return false;
  seen_ = picture;
  reference_ = std::make_shared<const Reference>(
      merged(found_.kept, {picture->image, picture->variance, s.samples_per_pixel, s.cpu_seconds}));
  if (done_ && !found_.path.empty())
    keeper_ = std::jthread([kept = reference_, path = found_.path] { keep_reference(path, *kept); });
  return true;
}

}  // namespace brume
