// How a chart looks: its inks and the sizes that follow from the font.
#pragma once

#include "renderer/analysis/chart_layout.h"

namespace brume {

struct ChartStyle {
  Rgb background = {}, ink = {}, muted = {}, frame = {}, grid = {}, minor_grid = {}, guide = {};
  float font = 14;

  float title() const { return 1.2f * font; }
  float small() const { return 0.93f * font; }  ///< ticks, legend, labels inside the frame
  float line() const { return 0.13f * font; }   ///< width of a series
  float hairline() const { return 1; }          ///< of the grid and the frame: a pixel at any size
  float marker() const { return 0.24f * font; }
};

inline ChartStyle chart_style(const ChartSize& size) {
  if (size.ground == Ground::Light)
    return {.background = {255, 255, 255},
            .ink = {32, 33, 36},
            .muted = {95, 97, 102},
            .frame = {138, 140, 145},
            .grid = {222, 223, 226},
            .minor_grid = {240, 241, 243},
            .guide = {168, 170, 175},
            .font = size.font};
  return {.background = {27, 27, 29},
          .ink = {226, 226, 228},
          .muted = {160, 161, 165},
          .frame = {104, 105, 110},
          .grid = {56, 57, 60},
          .minor_grid = {41, 41, 44},
          .guide = {112, 113, 118},
          .font = size.font};
}

}  // namespace brume
