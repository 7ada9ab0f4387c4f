// The document: a scene description with its history, and the picture that follows it.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "app/session/pixel_watch.h"
#include "app/session/scene_worker.h"
#include "app/session/settings_search.h"
#include "app/session/take.h"
#include "app/session/truth.h"
#include "renderer/engine/engine.h"
#include "renderer/experiments/live_sweep.h"
#include "renderer/media/vdb_file.h"
#include "renderer/params/node.h"
#include "renderer/scene/compare.h"

namespace brume {

struct SessionOptions {
  int threads = 0;                     ///< 0: as many as the machine has
  int max_samples = 1 << 24;           ///< per pixel; the picture is finished then
  std::function<void()> on_news = {};  ///< called from other threads when update() would bring something new
  std::string reference_folder = {};   ///< where references are kept between sessions; empty: nowhere
};

/// Belongs to the UI thread, which it never keeps waiting: files are read and scenes committed on a thread of its own,
/// and pictures come from the engine's. update() brings in what they have finished.
///
/// The description is plain values; every change makes a new one and is a step of the history. What renders is an
/// immutable scene committed from it; a description that cannot be committed leaves the last good scene in place and
/// says why in problem().
class Session {
 public:
  explicit Session(const SessionOptions& options = {});

  /// Once per frame.
  void update();

  // --- The document

  const Node& description() const { return description_; }
  /// The scene file, empty for a document that has none yet.
  const std::string& path() const { return path_; }
  /// "smoke.json", "untitled"
  std::string title() const;
  bool modified() const;

  /// Changes the description. Changes until close_step() are one step of the history.
  void change(const std::function<void(Node&)>& edit);
  /// The same, when nothing is to be undone: framing the first view.
  void close_step() { step_open_ = false; }
  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  void undo();
  void redo();

  /// Reads a scene (.json, or a picture that Brume wrote) or a grid file (.vdb, .nvdb) in the background.
  void open(const std::string& path);
  /// Starts from a description that is not on disk.
  void start(Node description, const std::string& path = {});
  Result<void> save();  ///< to path(), which must not be empty
  Result<void> save_as(const std::string& path);
  /// Writes the picture as shown (.png) or its linear values (.exr), with the scene inside.
  Result<void> export_picture(const std::string& path) const;

  /// Moves the camera so that all volumes fill the view.
  void frame_all();

  // --- The picture

  /// What is rendered: the variants that are on, or the scene itself. Of the newest successful commit; empty before
  /// the first.
  using Shown = CommittedVariant;
  const std::vector<Shown>& shown() const { return shown_; }

  /// Size at which pictures are rendered; the engine restarts when it changes.
  void set_picture_size(int width, int height);
  /// Of shown()[i]; null before the first.
  std::shared_ptr<const Picture> picture(std::size_t i = 0) const { return engine_.picture(i); }
  std::shared_ptr<const Scene> scene(std::size_t i = 0) const { return i < shown_.size() ? shown_[i].scene : nullptr; }
  /// All pictures are of the newest edit and of the size asked for.
  bool up_to_date() const;
  /// All pictures have all their samples.
  bool finished() const;
  bool paused() const { return engine_.paused(); }
  void set_paused(bool paused) { engine_.pause(paused); }
  void restart() { submit(true); }
  /// Why there is nothing to see in a picture, in one sentence; empty when there is.
  const std::string& black_picture(std::size_t i = 0) const;

  // --- Against the truth

  /// Whether errors are measured. The reference is the picture that the description names, or it is rendered, as one
  /// more picture that has its share of the threads, until it has had its time; a kept one is gone on with.
  void want_truth(bool wanted);
  const Truth& truth() const { return truth_; }
  /// Errors of what is rendered, so far.
  std::shared_ptr<const Sweep> errors() const { return live_.sweep(); }

  /// Looks for the cheapest settings of the scene as it is.  @param effort  share of the usual time
  void search_settings(double effort = 1);
  SettingsSearch& search() { return search_; }
  const SettingsSearch& search() const { return search_; }
  /// The scene gets the settings of a variant of a sweep; a step of the history.
  void apply(const SweepVariant& variant);

  // --- One pixel

  /// A place of a picture, as fractions of its width and height.
  struct PixelWish {
    std::size_t variant;  ///< of shown()
    double x, y;
  };
  /// Which pixel is probed, as its picture gets better; nothing: none is. As often as one likes.
  void watch_pixel(const std::optional<PixelWish>& wish) { watched_ = wish; }
  /// Of that pixel; null while there is none.
  std::shared_ptr<const PixelProbe> probe() const { return watched_ ? pixel_watch_.probe() : nullptr; }

  // --- Takes

  /// Keeps a picture with the document as it is.
  void keep_take(std::size_t variant);
  const std::vector<Take>& takes() const { return takes_; }
  /// The document becomes what it was; a step of the history.
  void restore_take(std::size_t index);
  void remove_take(std::size_t index);

  // --- What goes on

  std::optional<SceneWorker::Activity> activity() const { return worker_.activity(); }
  void cancel_activity() { worker_.cancel(); }
  /// Nothing is being read, committed or waited for.
  bool idle() const { return worker_.idle(); }

  /// Why the description cannot be rendered; empty when it can.
  const std::string& problem() const { return problem_; }

  struct Message {
    LogLevel level;
    std::string text;
  };
  const std::deque<Message>& messages() const { return messages_; }
  void say(LogLevel level, std::string text);

  /// Grids of a file that a volume names; empty until it has been read.
  const std::vector<GridInfo>& grids_of(const std::string& path) const;

 private:
  void description_changed(std::optional<Affects> dearest);
  void request(SceneWish wish);
  void take(SceneOutcome outcome);
  void submit(bool restart = false);
  void find_truth_again();
  void follow_errors();
  void follow_pixel();

  SessionOptions options_;
  Node description_;
  Node saved_;
  std::string path_;
  std::vector<Node> undo_, redo_;
  bool step_open_ = false;
  int width_ = 0, height_ = 0;
  std::vector<Shown> shown_;
  std::string problem_;
  struct Examined {
    std::shared_ptr<const Picture> picture;
    std::string black;
  };
  std::array<Examined, kMaxVariants> examined_;  // by explain_black
  std::deque<Message> messages_;
  std::map<std::string, std::vector<GridInfo>> grid_infos_;

  Truth truth_;
  std::optional<PixelWish> watched_;
  std::vector<Take> takes_;
  int takes_kept_ = 0;

  SceneWorker worker_;  // its cache outlives what follows
  LiveSweep live_;
  PixelWatch pixel_watch_;
  SettingsSearch search_;
  Engine engine_;
};

}  // namespace brume
