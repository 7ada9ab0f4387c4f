#include "renderer/analysis/chart_labels.h"

#include <algorithm>

namespace brume {
namespace {

constexpr float kCharacterWidth = 0.56f;  // em

bool starts_character(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) != 0x80; }

bool overlap(const Box& a, const Box& b) {
  return a.min[0] < b.max[0] && b.min[0] < a.max[0] && a.min[1] < b.max[1] && b.min[1] < a.max[1];
}

}  // namespace

float text_width(std::string_view text, float size) {
  return kCharacterWidth * size * static_cast<float>(std::ranges::count_if(text, starts_character));
}

std::string shortened(const std::string& text, float size, float room) {
  if (text_width(text, size) <= room) return text;
  const std::string ellipsis = "…";
  std::string start = text;
  while (!start.empty() && text_width(start + ellipsis, size) > room) {
    while (!starts_character(start.back())) start.pop_back();
    start.pop_back();
  }
  while (!start.empty() && start.back() == ' ') start.pop_back();
  return start.empty() ? std::string() : start + ellipsis;
}

std::vector<std::string> wrapped(const std::string& text, float size, float room, std::size_t lines) {
  std::vector<std::string> result;
  std::string rest = text;
  while (result.size() + 1 < lines && text_width(rest, size) > room) {
    std::size_t cut = std::string::npos;
    for (std::size_t space = rest.find(' '); space != std::string::npos; space = rest.find(' ', space + 1))
      if (text_width(std::string_view(rest).substr(0, space), size) <= room) cut = space;
    if (cut == std::string::npos || cut == 0) break;
    result.push_back(rest.substr(0, cut));
    rest.erase(0, cut + 1);
  }
  result.push_back(shortened(rest, size, room));
  return result;
}

std::size_t LabelSpace::take(std::span<const Box> places) {
  std::size_t best = 0;
  double least = cost(places[0]);
  for (std::size_t i = 1; i < places.size() && least > 0; ++i)
    if (const double c = cost(places[i]); c < least) {
      least = c;
      best = i;
    }
  avoid(places[best]);
  return best;
}

double LabelSpace::cost(const Box& place) const {
  // A label that is cut off or lies on another cannot be read at all; lines it covers are told apart by their number.
  constexpr double kCutOff = 1e6, kUnreadable = 1e4;
  double cost = 0;
  for (std::size_t i = 0; i < 2; ++i)
    if (place.min[i] < frame_.min[i] || place.max[i] > frame_.max[i]) cost += kCutOff;
  for (const Box& box : boxes_)
    if (overlap(place, box)) cost += kUnreadable;
  for (const Segment& segment : segments_)
    if (clipped(segment, place.min, place.max)) cost += 1;
  return cost;
}

}  // namespace brume
