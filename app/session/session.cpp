#include "app/session/session.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "renderer/engine/black_picture.h"
#include "renderer/film/display_transform.h"
#include "renderer/film/image_io.h"
#include "renderer/integrators/registry.h"
#include "renderer/params/node_difference.h"
#include "renderer/scene/framing.h"
#include "renderer/scene_io/scene_file.h"

namespace brume {
namespace {

constexpr std::size_t kMaxHistory = 500;  // steps; a description is a few kilobytes
constexpr std::size_t kMaxMessages = 500;

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

Node empty_scene() { return Node(*scene_family().tables.front()); }

}  // namespace

Session::Session(const SessionOptions& options)
    : options_(options),
      description_(empty_scene()),
      saved_(description_),
      worker_(options.reference_folder, options.on_news),
      live_(options.on_news),
      pixel_watch_(options.on_news),
      search_(options.on_news),
      engine_({.threads = options.threads, .on_picture = options.on_news}) {}

// --- The document

std::string Session::title() const { return path_.empty() ? "untitled" : file_name(path_); }

bool Session::modified() const { return description_ != saved_; }

void Session::change(const std::function<void(Node&)>& edit) {
  Node edited = description_;
  edit(edited);
  const auto dearest = node_difference(description_, edited);
  if (!dearest) return;
  if (!step_open_) {
    undo_.push_back(description_);
    if (undo_.size() > kMaxHistory) undo_.erase(undo_.begin());
    step_open_ = true;
  }
  redo_.clear();
  description_ = std::move(edited);
  description_changed(dearest);
}

void Session::undo() {
  if (undo_.empty()) return;
  const auto dearest = node_difference(description_, undo_.back());
  redo_.push_back(std::move(description_));
  description_ = std::move(undo_.back());
  undo_.pop_back();
  step_open_ = false;
  description_changed(dearest);
}

void Session::redo() {
  if (redo_.empty()) return;
  const auto dearest = node_difference(description_, redo_.back());
  undo_.push_back(std::move(description_));
  description_ = std::move(redo_.back());
  redo_.pop_back();
  step_open_ = false;
  description_changed(dearest);
}

void Session::description_changed(std::optional<Affects> dearest) {
  if (!dearest || *dearest == Affects::Display) return;
  request({.description = description_});
}

void Session::open(const std::string& path) { request({.open = path}); }

void Session::start(Node description, const std::string& path) {
  description_ = std::move(description);
  saved_ = description_;
  path_ = path;
  undo_.clear();
  redo_.clear();
  step_open_ = false;
  request({.description = description_});
}

Result<void> Session::save() { return save_as(path_); }

Result<void> Session::save_as(const std::string& path) {
  if (auto done = write_scene_file(path, description_); !done) return done;
  path_ = path;
  saved_ = description_;
  say(LogLevel::Info, "Saved " + path + ".");
  return {};
}

Result<void> Session::export_picture(const std::string& path) const {
  const auto shown = picture();
  if (!shown) return bad_input("there is no picture yet", {path, 0, 0, ""});
  return write_picture(path, *shown, description_);
}

void Session::frame_all() {
  if (shown_.empty() || scene()->bounds.empty()) return;
  const Scene& s = *scene();
  const Bounds3 world{s.bounds.low + s.origin, s.bounds.high + s.origin};
  const Numbers& r = description_.child("film").numbers("resolution");
  change([&](Node& d) { frame_bounds(d.child("camera"), world, r[0] / r[1]); });
  close_step();
}

// --- The picture

void Session::set_picture_size(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  live_.follow({}, {});  // errors at another size are others
  find_truth_again();
  submit();
}

void Session::submit(bool restart) {
  if (shown_.empty() || width_ <= 0 || height_ <= 0) return;
  std::vector<Job> jobs;
  std::vector<SweepVariant> variants;
  std::vector<std::shared_ptr<const Scene>> scenes;
  for (const Shown& s : shown_) {
    jobs.push_back({s.scene, width_, height_, options_.max_samples});
    variants.push_back({s.variant.name, s.variant.name, s.variant.description});
    scenes.push_back(s.scene);
  }
  if (const auto job = truth_.job()) jobs.push_back(*job);
  engine_.submit(std::move(jobs), restart);
  live_.follow(std::move(variants), std::move(scenes));
}

// --- Against the truth

void Session::want_truth(bool wanted) {
  if (wanted == truth_.wanted()) return;
  truth_.want(wanted);
  live_.set_reference(nullptr);
  find_truth_again();
  submit();
}

/// By the worker, unless it is busy: then what comes of that is followed by another look.
void Session::find_truth_again() {
  // Where the description has a problem, the edit that mends it brings the truth too.
  if (truth_.wanted() && idle() && !shown_.empty() && problem_.empty()) request({.description = description_});
}

void Session::follow_errors() {
  if (!truth_.wanted()) return;
  const TruthKey& key = truth_.key();
  const bool fits =
      key.width == width_ && key.height == height_ && key.given == description_.child("compare").text("reference");
  if (!fits && width_ > 0) find_truth_again();
  if (truth_.see(picture(shown_.size()), description_.child("compare").number("reference_time"))) {
    live_.set_reference(truth_.reference());
    if (!truth_.job()) submit();  // it is done: the others have the threads
  }
  for (std::size_t i = 0; i < shown_.size(); ++i) live_.see(i, picture(i));
}

const std::string& Session::black_picture(std::size_t i) const { return examined_[i].black; }

void Session::search_settings(double effort) {
  search_.start(without_variants(description_), worker_.cache(), {options_.threads, options_.reference_folder, effort});
}

void Session::apply(const SweepVariant& variant) {
  close_step();
  change([&](Node& d) { d = with_variants_of(variant.description, d); });
  close_step();
}

// --- One pixel

void Session::follow_pixel() {
  const auto p = watched_ ? picture(watched_->variant) : nullptr;
  if (!p || watched_->variant >= shown_.size()) return pixel_watch_.want(nullptr, {}, 0);
  const auto pixel = [](double fraction, int size) {
    return std::clamp(static_cast<int>(fraction * size), 0, size - 1);
  };
  pixel_watch_.want(shown_[watched_->variant].scene,
                    {pixel(watched_->x, p->width), pixel(watched_->y, p->height), p->width, p->height},
                    p->statistics.samples_per_pixel);
}

// --- Takes

void Session::keep_take(std::size_t variant) {
  const auto p = picture(variant);
  if (!p || variant >= shown_.size()) return;
  std::string name = title();
  if (shown_.size() > 1) name += ", " + shown_[variant].variant.name;
  takes_.push_back({++takes_kept_, std::move(name), description_, p});
}

void Session::restore_take(std::size_t index) {
  if (index >= takes_.size()) return;
  close_step();
  change([&](Node& d) { d = takes_[index].description; });
  close_step();
}

void Session::remove_take(std::size_t index) {
  if (index < takes_.size()) takes_.erase(takes_.begin() + static_cast<std::ptrdiff_t>(index));
}

// --- What goes on

void Session::say(LogLevel level, std::string text) {
  messages_.push_back({level, std::move(text)});
  if (messages_.size() > kMaxMessages) messages_.pop_front();
}

const std::vector<GridInfo>& Session::grids_of(const std::string& path) const {
  static const std::vector<GridInfo> none;
  const auto found = grid_infos_.find(path);
  return found == grid_infos_.end() ? none : found->second;
}

void Session::request(SceneWish wish) {
  if (truth_.wanted()) wish.truth = truth_.key();
  wish.width = width_, wish.height = height_;
  worker_.request(std::move(wish));
}

bool Session::up_to_date() const {
  if (!idle() || shown_.empty()) return false;
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const auto p = picture(i);
    if (!p || p->generation != shown_[i].scene->generation || p->width != width_ || p->height != height_) return false;
  }
  return true;
}

bool Session::finished() const {
  if (!up_to_date()) return false;
  for (std::size_t i = 0; i < shown_.size(); ++i)
    if (!picture(i)->finished) return false;
  return true;
}

void Session::take(SceneOutcome outcome) {
  for (auto& [path, infos] : outcome.grid_infos) grid_infos_[path] = std::move(infos);
  if (outcome.loaded) {
    description_ = outcome.loaded->description;
    path_ = outcome.loaded->scene_path;
    // What was made up for a bare grid file is not on disk yet, but nobody would miss it.
    saved_ = description_;
    undo_.clear();
    redo_.clear();
    step_open_ = false;
    say(LogLevel::Info, "Opened " + file_name(outcome.wish.open) + ".");
    for (std::string& note : outcome.loaded->notes) say(LogLevel::Info, std::move(note));
  }
  if (outcome.error) {
    if (outcome.error->code == ErrorCode::Cancelled) return;
    // A file that could not be opened leaves the document as it is; a description that cannot be rendered is a problem.
    if (outcome.wish.open.empty() || outcome.loaded) problem_ = outcome.error->to_string();
    say(LogLevel::Error, outcome.error->to_string());
    return;
  }
  problem_.clear();
  std::set<std::string> known;
  for (const Shown& s : shown_) known.insert(s.scene->warnings.begin(), s.scene->warnings.end());
  for (const Shown& s : outcome.shown)
    for (const std::string& warning : s.scene->warnings)
      if (known.insert(warning).second) say(LogLevel::Warning, warning);
  shown_ = std::move(outcome.shown);
  if (outcome.truth) {
    truth_.take(std::move(*outcome.truth));
    live_.follow({}, {});  // errors against another reference are others
    live_.set_reference(truth_.reference());
    if (!truth_.problem().empty()) say(LogLevel::Error, truth_.problem());
  }
  worker_.cache().drop_unused();
  submit();
}

void Session::update() {
  if (auto outcome = worker_.take()) take(std::move(*outcome));
  engine_.set_share(description_.child("compare").text("share") == "equal_time" ? Share::EqualTime
                                                                                : Share::EqualSamples);
  follow_errors();
  follow_pixel();
  for (std::size_t i = 0; i < shown_.size(); ++i) {
    const auto p = picture(i);
    if (!p || p == examined_[i].picture || p->generation != shown_[i].scene->generation) continue;
    examined_[i] = {p, explain_black(*shown_[i].scene, *p).value_or("")};
  }
}

}  // namespace brume
