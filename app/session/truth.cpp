#include "app/session/truth.h"

namespace brume {

std::optional<FoundTruth> TruthFinder::find(const Node& description, SceneCache& cache, const std::string& folder,
                                            int width, int height, std::uint64_t generation, const TruthKey& known) {
  FoundTruth found{.key = {description.child("compare").text("reference"), nullptr, width, height}};
  if (!found.key.given.empty()) {
    if (found.key == known) return std::nullopt;
    if (auto loaded = load_reference(found.key.given, width, height))
      found.kept = std::move(*loaded);
    else
      found.problem = loaded.error().to_string();
    return found;
  }
  Node truth = reference_description(description);
  if (!last_ || *last_ != truth) {
    const auto scene = commit(truth, cache, {.generation = generation});
    // Where the scene itself could be committed, this is a scene that has no unbiased picture.
    last_scene_ = scene ? *scene : nullptr;
    if (!scene) found.problem = scene.error().to_string();
    last_ = std::move(truth);
  }
  found.key.scene = last_scene_;
  if (last_scene_ && found.key == known) return std::nullopt;
  found.path = reference_path(folder, *last_, width, height);
  if (!found.path.empty()) found.kept = read_reference(found.path, width, height);
  return found;
}

void Truth::want(bool wanted) {
  wanted_ = wanted;
  found_ = {};
  done_ = false;
  seen_.reset(), reference_.reset();
}

void Truth::take(FoundTruth found) {
  if (!wanted_) return;
  want(true);
  found_ = std::move(found);
  if (!found_.kept.image.empty()) reference_ = std::make_shared<const Reference>(found_.kept);
}

std::optional<Job> Truth::job() const {
  if (!wanted_ || done_ || !found_.key.scene) return std::nullopt;
  return Job{.scene = found_.key.scene,
             .width = found_.key.width,
             .height = found_.key.height,
             .first_sample = static_cast<std::uint32_t>(found_.kept.samples_per_pixel)};
}

bool Truth::see(const std::shared_ptr<const Picture>& picture, double time) {
  if (!job()) return false;
  if (found_.kept.cpu_seconds >= time) return done_ = true;
  const bool of_it = picture && !picture->preview && picture->generation == found_.key.scene->generation &&
                     picture->width == found_.key.width && picture->height == found_.key.height;
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
