// The whole user interface, drawn the same in a window and headless.
#pragma once

#include "app/panels/chart_panel.h"
#include "app/panels/file_dialog.h"
#include "app/panels/inspector.h"
#include "app/panels/node_path.h"
#include "app/panels/take_strip.h"
#include "app/panels/view_controls.h"
#include "app/panels/viewport.h"
#include "app/session/session.h"

namespace brume {

struct MainWindowOptions {
  bool measured = true;  ///< false leaves out what differs between runs, for pictures that tests compare
  bool chart = false;    ///< the chart is open from the beginning
  bool probe = false;    ///< the middle of the picture is probed from the beginning
};

class MainWindow {
 public:
  MainWindow(Session& session, const Gl& gl, const MainWindowOptions& options = {});

  /// One frame: brings the session up to date and draws everything.
  void draw();

  /// The user wants to leave, and nothing would be lost.
  bool may_quit() const { return may_quit_; }
  /// Asks about unsaved changes if there are any; may_quit() is true at once if there are none.
  void request_quit();

  /// Files dropped on the window: the first that can be opened is.
  void drop(const std::vector<std::string>& paths);

  void select(const NodePath& path) { selected_ = path; }

 private:
  void draw_menu();
  void draw_panels();
  void draw_inspected();
  void draw_log();
  void draw_help();
  void draw_unsaved_question();
  void handle_keys();
  void ask_open();
  void ask_save_as();
  void ask_export();
  void ask_export_chart();
  void ask_export_take(std::size_t index);
  void keep_take();
  void ask_file(const FileWish& wish);
  void save();
  void report(const Result<void>& done);
  void open(const std::string& path);

  /// Runs `next` at once, or after the user has said what to do with unsaved changes.
  void unless_unsaved(std::function<void()> next);

  Session& session_;
  MainWindowOptions options_;
  Viewport viewport_;
  ChartPanel chart_;
  TakeStrip take_strip_;
  FileDialog dialog_;
  NodePath selected_;
  std::optional<std::size_t> edited_variant_;  // of the description's; none: the scene itself
  ViewControls controls_;
  bool show_panels_ = true, show_chart_ = false, show_takes_ = true, show_log_ = false, show_help_ = false;
  bool may_quit_ = false;
  std::function<void()> after_question_;
  bool opening_question_ = false;
  std::size_t messages_seen_ = 0;
};

}  // namespace brume
