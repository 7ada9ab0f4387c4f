#include "app/ui/item_recorder.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace brume::ui {

namespace {

ItemRect intersection(const ItemRect& a, const ItemRect& b) {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
          {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
}

// Levenshtein 1966: the fewest insertions, deletions and replacements that turn a into b, row by row.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

// How unlike a mistaken name is to a real one. The start of a name counts as nearly the whole: "Density" for
// "Density scale".
size_t unlikeness(std::string_view wanted, std::string_view name) {
  const size_t whole = edit_distance(wanted, name);
  if (name.size() <= wanted.size()) return whole;
  return std::min(whole, edit_distance(wanted, name.substr(0, wanted.size())) + 1);
}

std::string_view last_part(std::string_view path) {
  const size_t slash = path.rfind('/');
  return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

ItemRecord make_record(ImVec2 min, ImVec2 max) {
  ItemRecord item;
  const ImDrawList* list = ImGui::GetWindowDrawList();
  item.rect = {min, max};
  item.clip = {list->GetClipRectMin(), list->GetClipRectMax()};
  item.visible = intersection(item.rect, item.clip);
  return item;
}

}  // namespace

std::string_view ItemRecorder::name_of(std::string_view label) {
  const size_t marks = label.find("##");
  if (marks == std::string_view::npos) return label;
  if (marks > 0) return label.substr(0, marks);
  // "###id" restarts the ImGui id; the third mark is no part of the name either.
  return label.substr(label.starts_with("###") ? 3 : 2);
}

void ItemRecorder::begin_window(const char* title) { prefixes_.emplace_back(name_of(title)); }

void ItemRecorder::end_window() { prefixes_.pop_back(); }

void ItemRecorder::push_scope(const char* label) { prefixes_.push_back(path(label)); }

void ItemRecorder::pop_scope() { prefixes_.pop_back(); }

std::string ItemRecorder::path(const char* label) const {
  std::string path = prefixes_.empty() ? std::string() : prefixes_.back() + "/";
  return path += name_of(label);
}

void ItemRecorder::record(const std::string& path, const ItemRecord& item) {
  const int frame = ImGui::GetFrameCount();
  ItemRecord& kept = items_[path];
  const int times = kept.frame == frame ? kept.times + 1 : 1;
  kept = item;
  kept.frame = frame;
  kept.times = times;
}

void ItemRecorder::record_again(const std::string& path) {
  const auto found = items_.find(path);
  if (found != items_.end()) record(path, ItemRecord(found->second));
}

void ItemRecorder::record_tooltip(std::string_view text) {
  tooltip_ = text;
  tooltip_frame_ = ImGui::GetFrameCount();
}

const ItemRecord* ItemRecorder::find(std::string_view path) const {
  const auto found = items_.find(path);
  return found == items_.end() ? nullptr : &found->second;
}

std::vector<std::string> ItemRecorder::names() const {
  std::vector<std::string> names;
  for (const auto& [name, item] : items_)
    if (item.frame == ImGui::GetFrameCount()) names.push_back(name);
  return names;
}

std::vector<std::string> ItemRecorder::near_names(std::string_view path, size_t limit) const {
  std::vector<std::pair<size_t, std::string>> ranked;
  for (std::string& name : names()) {
    // The right label in the wrong window is the commonest mistake, so the last part counts double.
    const size_t distance = unlikeness(path, name) + 2 * unlikeness(last_part(path), last_part(name));
    ranked.emplace_back(distance, std::move(name));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> best;
  for (size_t i = 0; i < std::min(limit, ranked.size()); ++i) best.push_back(std::move(ranked[i].second));
  return best;
}

std::string ItemRecorder::hovered() const {
  std::string deepest;
  // A window is hovered together with the widget in it; the longer path says more.
  for (const auto& [name, item] : items_)
    if (item.frame == ImGui::GetFrameCount() && item.hovered && name.size() > deepest.size()) deepest = name;
  return deepest;
}

std::string ItemRecorder::tooltip() const {
  return tooltip_frame_ == ImGui::GetFrameCount() ? tooltip_ : std::string();
}

void record_item(const char* label, ImVec2 min, ImVec2 max) {
  ItemRecorder* recorder = ItemRecorder::current();
  if (!recorder) return;
  ItemRecord item = make_record(min, max);
  item.hovered = ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled);
  item.disabled = item.hovered && !ImGui::IsItemHovered();
  recorder->record(recorder->path(label), item);
}

void record_item(const char* label) { record_item(label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax()); }

void record_area(const char* label, ImVec2 min, ImVec2 max, bool hovered) {
  ItemRecorder* recorder = ItemRecorder::current();
  if (!recorder) return;
  ItemRecord item = make_record(min, max);
  item.hovered = hovered;
  recorder->record(recorder->path(label), item);
}

Scope::Scope(const char* label) {
  ImGui::PushID(label);
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->push_scope(label);
}

Scope::~Scope() {
  if (ItemRecorder* recorder = ItemRecorder::current()) recorder->pop_scope();
  ImGui::PopID();
}

}  // namespace brume::ui
