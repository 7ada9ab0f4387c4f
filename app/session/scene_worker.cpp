#include "app/session/scene_worker.h"

#include <algorithm>
#include <filesystem>

#include "renderer/params/node_difference.h"

namespace brume {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

SceneWorker::SceneWorker(std::string reference_folder, std::function<void()> on_news)
    : reference_folder_(std::move(reference_folder)), on_news_(std::move(on_news)) {
  thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

SceneWorker::~SceneWorker() { cancel(); }

void SceneWorker::request(SceneWish wish) {
  const std::lock_guard lock(mutex_);
  const bool opening = wish_ && !wish_->open.empty();
  if (opening && wish.open.empty()) return;
  wish_ = std::make_unique<SceneWish>(std::move(wish));
  wished_.notify_all();
}

std::unique_ptr<SceneOutcome> SceneWorker::take() {
  const std::lock_guard lock(mutex_);
  if (outcome_ && wish_) wished_.notify_all();
  return std::move(outcome_);
}

std::optional<SceneWorker::Activity> SceneWorker::activity() const {
  const std::lock_guard lock(mutex_);
  if (working_on_.empty()) return std::nullopt;
  return Activity{working_on_, progress_, std::chrono::duration<double>(Clock::now() - work_began_).count()};
}

void SceneWorker::cancel() {
  const std::lock_guard lock(mutex_);
  cancel_work_.request_stop();
}

bool SceneWorker::idle() const {
  const std::lock_guard lock(mutex_);
  return !wish_ && !outcome_ && working_on_.empty();
}

void SceneWorker::serve(const std::stop_token& stop) {
  while (true) {
    SceneWish wish;
    std::stop_token cancel;
    {
      std::unique_lock lock(mutex_);
      if (!wished_.wait(lock, stop, [&] { return wish_ && !outcome_; })) return;
      wish = std::move(*wish_);
      wish_.reset();
      working_on_ =
          wish.open.empty() ? "Preparing the scene" : "Reading " + std::filesystem::path(wish.open).filename().string();
      work_began_ = Clock::now();
      progress_ = 0;
      cancel_work_ = {};
      cancel = cancel_work_.get_token();
    }
    SceneOutcome outcome = fulfil(wish, cancel);
    {
      const std::lock_guard lock(mutex_);
      working_on_.clear();
      outcome_ = std::make_unique<SceneOutcome>(std::move(outcome));
    }
    if (on_news_) on_news_();
  }
}

SceneOutcome SceneWorker::fulfil(const SceneWish& wish, const std::stop_token& cancel) {
  SceneOutcome out;
  out.wish = wish;
  const auto progress = [this](float p) { progress_ = p; };
  if (!wish.open.empty()) {
    auto loaded = load_scene(wish.open, cache_, {.progress = progress, .cancel = cancel});
    if (!loaded) {
      out.error = loaded.error();
      return out;
    }
    out.loaded = std::move(*loaded);
  }
  const Node& description = out.loaded ? out.loaded->description : *wish.description;
  for (const Node& volume : description.list("volumes")) {
    if (!volume.table().find("file") || volume.text("file").empty()) continue;
    if (auto infos = list_grids(volume.text("file"), false)) out.grid_infos[volume.text("file")] = std::move(*infos);
  }
  auto committed = commit_variants(description, {.progress = progress, .cancel = cancel});
  if (!committed) {
    out.error = committed.error();
    return out;
  }
  out.shown = last_committed_ = std::move(*committed);
  if (wish.truth && wish.width > 0)
    out.truth =
        truth_finder_.find(description, cache_, reference_folder_, wish.width, wish.height, ++commits_, *wish.truth);
  return out;
}

Result<std::vector<CommittedVariant>> SceneWorker::commit_variants(const Node& description, CommitOptions options) {
  auto variants = variants_of(description);
  if (!variants) return variants.error();
  std::vector<CommittedVariant> committed;
  for (Variant& v : *variants) {
    // What an edit has not touched goes on as it is: its picture keeps its samples.
    const auto same = std::find_if(last_committed_.begin(), last_committed_.end(), [&](const CommittedVariant& s) {
      return node_difference(s.variant.description, v.description).value_or(Affects::Display) == Affects::Display;
    });
    if (same != last_committed_.end()) {
      committed.push_back({std::move(v), same->scene});
      continue;
    }
    // One of its own for each: a picture is known by it, whatever its place among the others has been.
    options.generation = ++commits_;
    auto scene = commit(v.description, cache_, options);
    if (!scene) return variants->size() > 1 ? under("compare.variants." + v.name, scene.error()) : scene.error();
    committed.push_back({std::move(v), std::move(*scene)});
  }
  return committed;
}

}  // namespace brume
