#include "app/panels/main_window.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "app/panels/outliner.h"
#include "app/panels/probe_panel.h"
#include "app/panels/status_bar.h"
#include "app/panels/variant_list.h"
#include "app/session/load_scene.h"
#include "app/ui/keys.h"
#include "app/ui/widgets.h"

namespace brume {
namespace {

constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                    ImGuiWindowFlags_NoTitleBar;

bool begin_panel(const char* name, ImVec2 corner, ImVec2 size, ImGuiWindowFlags flags = 0) {
  ImGui::SetNextWindowPos(corner);
  ImGui::SetNextWindowSize(size);
  return ui::begin_window(name, nullptr, kPanel | flags);
}

struct Shortcut {
  const char *keys, *what;
};
constexpr Shortcut kHelp[] = {{"Left drag", "orbit"},
                              {"Middle drag", "pan"},
                              {"Right drag, wheel", "dolly"},
                              {"F", "frame everything"},
                              {"Ctrl+wheel, Ctrl+drag, Z", "zoom into the picture, move in it, all of it"},
                              {"1-4", "show a variant; hold to flip"},
                              {"S, W, D", "variants side by side, wipe, difference"},
                              {"Shift+D", "difference from the reference"},
                              {"V", "duplicate as variant"},
                              {"C", "chart of error against time"},
                              {"P", "probe a pixel; a click chooses which"},
                              {"T", "keep a take: the picture and its scene"},
                              {"E, Shift+E", "exposure up, down"},
                              {"Space", "pause, go on"},
                              {"R", "restart the picture"},
                              {"Tab", "picture only"},
                              {"L", "log"},
                              {"Ctrl+Z, Ctrl+Shift+Z", "undo, redo"},
                              {"Ctrl+O", "open a scene, a .vdb, or a picture made by Brume"},
                              {"Ctrl+S, Ctrl+Shift+S", "save, save as"},
                              {"Ctrl+E", "export the picture"},
                              {"Ctrl+click on a slider", "type a value"},
                              {"Esc", "cancel what is running"},
                              {"?", "this help"}};

}  // namespace

MainWindow::MainWindow(Session& session, const Gl& gl, const MainWindowOptions& options)
    : session_(session),
      options_(options),
      viewport_(gl),
      take_strip_(gl),
      selected_(NodePath().child("render")),
      show_chart_(options.chart) {
  controls_.view().probing = options.probe;
}

void MainWindow::draw() {
  session_.update();
  if (!dialog_.is_open()) handle_keys();
  // Errors open the log by themselves: nobody looks for a message that is not shown.
  for (; messages_seen_ < session_.messages().size(); ++messages_seen_)
    if (session_.messages()[messages_seen_].level == LogLevel::Error) show_log_ = true;
  draw_menu();
  draw_panels();
  draw_help();
  draw_unsaved_question();
  dialog_.draw();
}

// --- Actions

void MainWindow::report(const Result<void>& done) {
  if (!done) session_.say(LogLevel::Error, done.error().to_string());
}

void MainWindow::open(const std::string& path) {
  unless_unsaved([this, path] {
    edited_variant_.reset();  // of the scene that is left
    session_.open(path);
  });
}

void MainWindow::drop(const std::vector<std::string>& paths) {
  if (!paths.empty()) open(paths.front());
}

void MainWindow::ask_open() {
  dialog_.open({"Open",
                {".json", ".vdb", ".nvdb", ".exr", ".png"},
                false,
                session_.path().empty() ? "" : std::filesystem::path(session_.path()).parent_path().string(),
                [this](const std::string& path) { open(path); }});
}

void MainWindow::ask_save_as() {
  dialog_.open({"Save as",
                {".json"},
                true,
                session_.path().empty() ? "untitled.json" : session_.path(),
                [this](std::string path) {
                  if (std::filesystem::path(path).extension().empty()) path += ".json";
                  report(session_.save_as(path));
                }});
}

void MainWindow::ask_export() {
  const std::string name = std::filesystem::path(session_.title()).replace_extension(".png").string();
  dialog_.open({"Export picture", {".png", ".exr"}, true, name, [this](const std::string& path) {
                  const auto done = session_.export_picture(path);
                  report(done);
                  if (done) session_.say(LogLevel::Info, "Exported " + path + ".");
                }});
}

void MainWindow::ask_export_chart() {
  const std::string name = std::filesystem::path(session_.title()).stem().string() + "_chart.svg";
  dialog_.open({"Export chart", {".svg", ".png", ".csv"}, true, name, [this](const std::string& path) {
                  const auto done = chart_.write(session_, path);
                  report(done);
                  if (done) session_.say(LogLevel::Info, "Exported " + path + ".");
                }});
}

void MainWindow::ask_export_take(std::size_t index) {
  const Take take = session_.takes()[index];  // it may be gone when the dialog is answered
  const std::string name = "take_" + std::to_string(take.number) + ".exr";
  dialog_.open({"Export take", {".png", ".exr"}, true, name, [this, take](const std::string& path) {
                  const auto done = write_picture(path, *take.picture, take.description);
                  report(done);
                  if (done) session_.say(LogLevel::Info, "Exported " + path + ".");
                }});
}

void MainWindow::keep_take() {
  session_.keep_take(controls_.view().shown);
  show_takes_ = true;
}

void MainWindow::ask_file(const FileWish& wish) {
  const auto variant = edited_variant_;
  const EditTarget target(session_, variant);
  const Node* node = wish.object.find(target.description());
  const bool picture = wish.key == "reference";
  dialog_.open({picture ? "Choose reference" : "Choose grid file",
                picture ? std::vector<std::string>{".exr"} : std::vector<std::string>{".vdb", ".nvdb"}, false,
                node ? node->text(wish.key) : "", [this, wish, variant](const std::string& path) {
                  EditTarget edited(session_, variant);
                  const Node* n = wish.object.find(edited.description());
                  if (const Param* p = n ? n->table().find(wish.key) : nullptr) edited.set(wish.object, *p, path);
                  session_.close_step();
                }});
}

void MainWindow::save() {
  if (session_.path().empty())
    ask_save_as();
  else
    report(session_.save());
}

void MainWindow::unless_unsaved(std::function<void()> next) {
  if (!session_.modified()) return next();
  after_question_ = std::move(next);
  opening_question_ = true;
}

void MainWindow::request_quit() {
  unless_unsaved([this] { may_quit_ = true; });
}

void MainWindow::handle_keys() {
  using ui::Key;
  if (ui::shortcut(Key::Z, {.ctrl = true}, true)) session_.undo();
  if (ui::shortcut(Key::Z, {.ctrl = true, .shift = true}, true) || ui::shortcut(Key::Y, {.ctrl = true}, true))
    session_.redo();
  if (ui::shortcut(Key::O, {.ctrl = true})) ask_open();
  if (ui::shortcut(Key::S, {.ctrl = true})) save();
  if (ui::shortcut(Key::S, {.ctrl = true, .shift = true})) ask_save_as();
  if (ui::shortcut(Key::E, {.ctrl = true})) ask_export();
  if (ui::shortcut(Key::Q, {.ctrl = true})) request_quit();
  if (ui::shortcut(Key::F)) session_.frame_all();
  if (ui::shortcut(Key::R)) session_.restart();
  if (ui::shortcut(Key::C)) show_chart_ = !show_chart_;
  if (ui::shortcut(Key::P)) controls_.view().probing = !controls_.view().probing;
  if (ui::shortcut(Key::T)) keep_take();
  if (ui::shortcut(Key::L)) show_log_ = !show_log_;
  if (ui::shortcut(Key::Tab)) show_panels_ = !show_panels_;
  if (ui::shortcut(Key::Space)) session_.set_paused(!session_.paused());
  if (ui::typed('?')) show_help_ = !show_help_;
  if (ui::shortcut(Key::Escape)) {
    show_help_ = false;
    session_.cancel_activity();
  }
  controls_.handle_keys(session_, edited_variant_);
  const auto expose = [&](double stops) {
    session_.change([&](Node& d) {
      Node& film = d.child("film");
      static_cast<void>(film.set("exposure", film.number("exposure") + stops).ok());
    });
    session_.close_step();
  };
  if (ui::shortcut(Key::E, {}, true)) expose(0.5);
  if (ui::shortcut(Key::E, {.shift = true}, true)) expose(-0.5);
}

// --- Drawing

void MainWindow::draw_menu() {
  if (!ui::begin_main_menu_bar()) return;
  if (ui::menu("File")) {
    if (ui::menu_item("Open...", "Ctrl+O")) ask_open();
    if (ui::menu_item("Save", "Ctrl+S")) save();
    if (ui::menu_item("Save as...", "Ctrl+Shift+S")) ask_save_as();
    if (ui::menu_item("Export picture...", "Ctrl+E")) ask_export();
    ImGui::Separator();
    if (ui::menu_item("Quit", "Ctrl+Q")) request_quit();
    ui::end_menu();
  }
  if (ui::menu("Edit")) {
    if (ui::menu_item("Undo", "Ctrl+Z", false, session_.can_undo())) session_.undo();
    if (ui::menu_item("Redo", "Ctrl+Shift+Z", false, session_.can_redo())) session_.redo();
    ui::end_menu();
  }
  if (ui::menu("View")) {
    if (ui::menu_item("Frame everything", "F")) session_.frame_all();
    if (ui::menu_item("Picture only", "Tab", !show_panels_)) show_panels_ = !show_panels_;
    if (ui::menu_item("Log", "L", show_log_)) show_log_ = !show_log_;
    bool& probing = controls_.view().probing;
    if (ui::menu_item("Pixel probe", "P", probing)) probing = !probing;
    ImGui::Separator();
    if (ui::menu_item("Keep a take", "T", false, session_.picture() != nullptr)) keep_take();
    if (ui::menu_item("Takes", "", show_takes_)) show_takes_ = !show_takes_;
    ImGui::Separator();
    if (ui::menu_item("Pause", "Space", session_.paused())) session_.set_paused(!session_.paused());
    if (ui::menu_item("Restart", "R")) session_.restart();
    ui::end_menu();
  }
  controls_.draw_menu(session_, edited_variant_, show_chart_);
  if (ui::menu("Help")) {
    if (ui::menu_item("Keys", "?", show_help_)) show_help_ = !show_help_;
    ui::end_menu();
  }
  const std::string title = session_.title() + (session_.modified() ? " *" : "");
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(title.c_str()).x - ImGui::GetFontSize());
  ImGui::TextDisabled("%s", title.c_str());
  ui::end_main_menu_bar();
}

void MainWindow::draw_panels() {
  const ImGuiIO& io = ImGui::GetIO();
  const float em = ImGui::GetFontSize(), top = ImGui::GetFrameHeight();
  const ViewState& view = controls_.view();
  const auto rows = [&](bool shown, float height) { return shown && show_panels_ ? std::floor(height * em) : 0.0f; };
  const float left = rows(true, 15), right = rows(true, 24), status = rows(true, 2), log = rows(show_log_, 9);
  // Plots are not to take the picture's room in a small window.
  const float plots = std::min(rows(show_chart_ || view.probing, 22), std::floor(0.36f * io.DisplaySize.y));
  const float takes = rows(show_takes_ && !session_.takes().empty(), 7);
  const bool chart = show_chart_ && show_panels_, probe = view.probing && show_panels_;
  session_.want_truth(chart || (view.mode == ViewMode::Difference && view.against_truth));
  session_.watch_pixel(probe ? std::optional(Session::PixelWish{view.shown, static_cast<double>(view.probe_x),
                                                                static_cast<double>(view.probe_y)})
                             : std::nullopt);
  const float height = io.DisplaySize.y - top - status, width = io.DisplaySize.x - left - right;

  if (show_panels_) {
    if (begin_panel("Scene", {0, top}, {left, height})) {
      draw_outliner(session_, selected_);
      draw_variant_list(session_, selected_, edited_variant_);
    }
    ui::end_window();
    if (begin_panel("Inspector", {io.DisplaySize.x - right, top}, {right, height})) draw_inspected();
    ui::end_window();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {em * 0.7f, std::floor((status - em) / 2)});
    if (begin_panel("Status", {0, top + height}, {io.DisplaySize.x, status}, ImGuiWindowFlags_NoScrollbar))
      draw_status_bar(session_, options_.measured);
    ui::end_window();
    ImGui::PopStyleVar();
  }

  // From the bottom upwards; what is left is the picture's.
  float below = top + height;
  if (log > 0) {
    if (begin_panel("Log", {left, below -= log}, {width, log})) draw_log();
    ui::end_window();
  }
  if (takes > 0) {
    if (begin_panel("Takes", {left, below -= takes}, {width, takes}, ImGuiWindowFlags_HorizontalScrollbar))
      if (const auto exported = take_strip_.draw(session_)) ask_export_take(*exported);
    ui::end_window();
  }
  if (plots > 0) {
    below -= plots;
    const float of_chart = probe ? std::floor(0.44f * width) : width, of_probe = chart ? width - of_chart : width;
    if (chart) {
      if (begin_panel("Chart", {left, below}, {of_chart, plots}))
        if (chart_.draw(session_, options_.measured)) ask_export_chart();
      ui::end_window();
    }
    if (probe) {
      if (begin_panel("Probe", {left + width - of_probe, below}, {of_probe, plots}))
        draw_probe_panel(session_, view, options_.measured);
      ui::end_window();
    }
  }
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  if (begin_panel("View", {left, top}, {width, below - top},
                  ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse))
    viewport_.draw(session_, controls_.view(), options_.measured);
  ui::end_window();
  ImGui::PopStyleVar();
}

void MainWindow::draw_inspected() {
  EditTarget target(session_, edited_variant_);
  const auto variants = session_.description().child("compare").list("variants");
  if (edited_variant_ && *edited_variant_ < variants.size() && selected_ != NodePath().child("compare")) {
    ImGui::TextDisabled("In variant %s:", variant_name(variants[*edited_variant_], *edited_variant_).c_str());
    ui::tooltip_on_hover("Edits become settings of this variant. Click its name in the list to edit the scene again.");
    ImGui::SameLine();
  }
  if (const auto browse = draw_inspector(target, selected_)) ask_file(*browse);
}

void MainWindow::draw_log() {
  for (const Session::Message& m : session_.messages()) {
    const ImVec4 color = m.level == LogLevel::Error     ? ImVec4(1.0f, 0.5f, 0.42f, 1)
                         : m.level == LogLevel::Warning ? ImVec4(0.95f, 0.8f, 0.45f, 1)
                                                        : ImGui::GetStyleColorVec4(ImGuiCol_Text);
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextWrapped("%s", m.text.c_str());
    ImGui::PopStyleColor();
  }
  if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1);
}

void MainWindow::draw_help() {
  if (!show_help_) return;
  const ImVec2 middle(ImGui::GetIO().DisplaySize.x / 2, ImGui::GetIO().DisplaySize.y / 2);
  ImGui::SetNextWindowPos(middle, ImGuiCond_Always, {0.5f, 0.5f});
  if (ui::begin_window(
          "Keys", &show_help_,
          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse)) {
    const float column = 13 * ImGui::GetFontSize();
    for (const Shortcut& s : kHelp) {
      ImGui::TextUnformatted(s.keys);
      ImGui::SameLine(column);
      ImGui::TextDisabled("%s", s.what);
    }
  }
  ui::end_window();
}

void MainWindow::draw_unsaved_question() {
  if (opening_question_) ui::open_popup("Unsaved changes");
  opening_question_ = false;
  if (!ui::begin_modal("Unsaved changes")) return;
  ImGui::Text("%s has changes that are not saved.", session_.title().c_str());
  ImGui::Spacing();
  bool go_on = false;
  if (ui::button("Save")) {
    if (session_.path().empty()) {
      ImGui::CloseCurrentPopup();
      ask_save_as();
    } else {
      const auto done = session_.save();
      report(done);
      go_on = done.ok();
      ImGui::CloseCurrentPopup();
    }
  }
  ImGui::SameLine();
  if (ui::button("Discard")) {
    go_on = true;
    ImGui::CloseCurrentPopup();
  }
  ImGui::SameLine();
  if (ui::button("Cancel")) ImGui::CloseCurrentPopup();
  ui::end_modal();
  if (go_on && after_question_) after_question_();
}

}  // namespace brume
