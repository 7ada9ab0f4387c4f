// Texts of a chart: how wide they are, how they are made to fit, and where they cover nothing.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/analysis/chart_lines.h"

namespace brume {

/// 0.56 em for each character of UTF-8: about the mean of digits and letters in sans serif fonts.
float text_width(std::string_view text, float size);

/// The text, or as much of it as fits with "…" at its end.
std::string shortened(const std::string& text, float size, float room);

/// At most `lines` lines, broken between words; what fits nowhere is shortened.
std::vector<std::string> wrapped(const std::string& text, float size, float room, std::size_t lines);

struct Box {
  std::array<double, 2> min = {}, max = {};
};

/// Finds places for labels among the lines of a plot.
class LabelSpace {
 public:
  explicit LabelSpace(const Box& frame) : frame_(frame) {}

  void avoid(const Segment& segment) { segments_.push_back(segment); }
  void avoid(const Box& box) { boxes_.push_back(box); }

  /// Index of the place that lies in the frame and covers no other label and the fewest lines; of equals the first.
  /// It is taken then. @param places  one at least
  std::size_t take(std::span<const Box> places);

 private:
  double cost(const Box& place) const;

  Box frame_;
  std::vector<Segment> segments_;
  std::vector<Box> boxes_;
};

}  // namespace brume
