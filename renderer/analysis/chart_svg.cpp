#include "renderer/analysis/chart_svg.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace brume {
namespace {

// The font of the window where there is one, else what the reader's machine has.
constexpr std::string_view kFonts = "Roboto, Helvetica, Arial, sans-serif";

std::string number(float value) {
  constexpr double kLongest = 1e9;  // beyond every canvas
  const double length = static_cast<double>(value);
  if (!std::isfinite(length) || std::abs(length) > kLongest) return "0";
  char buffer[32];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, length, std::chars_format::fixed, 2).ptr);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string hex(Rgb color) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t channel : color) text += {kDigits[channel / 16], kDigits[channel % 16]};
  return text;
}

/// Bytes of the UTF-8 character at the start of a text; 0 when there is none that XML 1.0 (section 2.2, "Char") allows.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC0 || first > 0xF4 || text.size() < length) return 0;
  std::uint32_t code = first & (0xFFu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // of a character that needs so many bytes
  const bool allowed = code >= kLeast[length] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF) &&
                       code != 0xFFFE && code != 0xFFFF;
  return allowed ? length : 0;
}

std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const std::string_view character = text.substr(0, length > 0 ? length : 1);
    if (length == 0)
      result += "\uFFFD";
    else if (character == "&")
      result += "&amp;";
    else if (character == "<")
      result += "&lt;";
    else if (character == ">")
      result += "&gt;";
    else if (character == "\"")
      result += "&quot;";
    else
      result += character;
    text.remove_prefix(character.size());
  }
  return result;
}

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + std::string(value) + "\"";
}
std::string attribute(std::string_view name, float value) { return attribute(name, number(value)); }

std::string stroke(Rgb color, float width, bool dashed) {
  std::string text = attribute("stroke", hex(color)) + attribute("stroke-width", width);
  if (dashed) text += attribute("stroke-dasharray", number(kDashStroke * width) + " " + number(kDashGap * width));
  return text;
}

/// One element for each kind of shape.
struct Element {
  std::string operator()(const Line& line) const {
    return "<line" + attribute("x1", line.from[0]) + attribute("y1", line.from[1]) + attribute("x2", line.to[0]) +
           attribute("y2", line.to[1]) + stroke(line.color, line.width, line.dashed) + "/>";
  }
  std::string operator()(const Polyline& line) const {
    std::string points;
    for (const std::array<float, 2>& point : line.points)
      points += (points.empty() ? "" : " ") + number(point[0]) + "," + number(point[1]);
    return "<polyline" + attribute("points", points) + attribute("fill", "none") +
           stroke(line.color, line.width, line.dashed) + attribute("stroke-linejoin", "round") + "/>";
  }
  std::string operator()(const Rect& rect) const {
    return "<rect" + attribute("x", rect.min[0]) + attribute("y", rect.min[1]) +
           attribute("width", rect.max[0] - rect.min[0]) + attribute("height", rect.max[1] - rect.min[1]) +
           attribute("fill", hex(rect.color)) + "/>";
  }
  std::string operator()(const Disc& disc) const {
    return "<circle" + attribute("cx", disc.center[0]) + attribute("cy", disc.center[1]) + attribute("r", disc.radius) +
           (disc.ring > 0 ? attribute("fill", "none") + stroke(disc.color, disc.ring, false)
                          : attribute("fill", hex(disc.color))) +
           "/>";
  }
  std::string operator()(const Text& text) const {
    const std::string x = number(text.position[0]), y = number(text.position[1]);
    std::string element = "<text" + attribute("x", x) + attribute("y", y) + attribute("font-size", text.size) +
                          attribute("fill", hex(text.color));
    if (text.anchor != TextAnchor::Start)
      element += attribute("text-anchor", text.anchor == TextAnchor::Middle ? "middle" : "end");
    if (text.rotated) element += attribute("transform", "rotate(-90 " + x + " " + y + ")");
    return element + ">" + escaped(text.text) + "</text>";
  }
};

}  // namespace

std::string to_svg(const Drawing& drawing) {
  const std::string width = number(drawing.width), height = number(drawing.height);
  std::string svg = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg" +
                    attribute("xmlns", "http://www.w3.org/2000/svg") + attribute("version", "1.1") +
                    attribute("width", width) + attribute("height", height) +
                    attribute("viewBox", "0 0 " + width + " " + height) + attribute("font-family", kFonts) + ">\n";
  svg += Element()(Rect{{0, 0}, {drawing.width, drawing.height}, drawing.background}) + "\n";
  for (const Drawing::Shape& shape : drawing.shapes) svg += std::visit(Element(), shape) + "\n";
  return svg + "</svg>\n";
}

}  // namespace brume
