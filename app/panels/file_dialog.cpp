#include "app/panels/file_dialog.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "app/ui/keys.h"
#include "app/ui/widgets.h"
#include "renderer/core/input_file.h"

namespace brume {
namespace fs = std::filesystem;

void FileDialog::open(Request request) {
  request_ = std::move(request);
  field_ = request_.path;
  std::error_code ignored;
  fs::path folder = fs::path(field_);
  if (!fs::is_directory(folder, ignored)) folder = folder.parent_path();
  if (!fs::is_directory(folder, ignored)) folder = fs::current_path(ignored);
  confirm_ = false;
  opening_ = open_ = true;
  const std::string typed = field_;
  go_to(folder.string());
  if (!typed.empty()) field_ = typed;
}

void FileDialog::go_to(const std::string& folder) {
  folder_ = fs::path(folder).lexically_normal().string();
  field_ = (fs::path(folder_) / (request_.save ? fs::path(field_).filename() : fs::path())).string();
  list_folder();
}

bool FileDialog::shown(const std::string& name) const {
  if (name.starts_with('.')) return false;
  if (request_.extensions.empty()) return true;
  const std::string extension = lower_case_extension(name);
  return std::find(request_.extensions.begin(), request_.extensions.end(), extension) != request_.extensions.end();
}

void FileDialog::list_folder() {
  entries_.clear();
  problem_.clear();
  std::error_code error;
  for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    std::error_code unknown;
    const bool folder = it->is_directory(unknown);
    if (folder ? !name.starts_with('.') : shown(name)) entries_.push_back({name, folder});
  }
  if (error) problem_ = folder_ + ": " + error.message();
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.folder != b.folder ? a.folder : a.name < b.name; });
}

void FileDialog::accept() {
  std::error_code unknown;
  const fs::path path(field_);
  if (fs::is_directory(path, unknown)) return go_to(field_);
  if (!request_.save && !fs::exists(path, unknown)) {
    problem_ = "There is no such file.";
    return;
  }
  if (request_.save && fs::exists(path, unknown) && !confirm_) {
    confirm_ = true;  // asked once; the next press overwrites
    problem_ = "The file exists. Press again to overwrite it.";
    return;
  }
  open_ = false;
  request_.chosen(field_);
}

void FileDialog::draw() {
  if (!open_) return;
  if (opening_) ui::open_popup(request_.title.c_str());
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowSize({44 * em, 30 * em}, ImGuiCond_Appearing);
  if (!ui::begin_modal(request_.title.c_str())) {
    open_ = opening_;  // closed with Esc
    opening_ = false;
    return;
  }
  ImGui::SetNextItemWidth(-1);
  if (ui::input_text("##path", field_, "path")) confirm_ = false, problem_.clear();
  const bool entered = ImGui::IsItemDeactivated() && ui::key_went_down(ui::Key::Enter);
  std::string next_folder;
  if (ui::begin_child("##files", {0, -ImGui::GetFrameHeightWithSpacing() * 2}, true)) {
    if (ui::selectable(".. (up)", false)) next_folder = fs::path(folder_).parent_path().string();
    for (const Entry& e : entries_) {
      if (!ui::selectable((e.folder ? e.name + "/" : e.name).c_str(), false)) continue;
      if (e.folder) {
        next_folder = (fs::path(folder_) / e.name).string();
      } else {
        field_ = (fs::path(folder_) / e.name).string();
        confirm_ = false;
      }
    }
  }
  ui::end_child();
  ImGui::TextDisabled("%s", problem_.c_str());
  const float width = 8 * em;
  ImGui::SetCursorPosX(ImGui::GetContentRegionMax().x - 2 * width - ImGui::GetStyle().ItemSpacing.x);
  const bool cancelled = ui::button("Cancel", {width, 0});
  ImGui::SameLine();
  if (ui::button(request_.save ? "Save" : "Open", {width, 0}) || entered) accept();
  if (cancelled) open_ = false;
  if (!next_folder.empty()) go_to(next_folder);
  if (!open_) ImGui::CloseCurrentPopup();
  opening_ = false;
  ui::end_modal();
}

}  // namespace brume
