#include "renderer/analysis/chart.h"

namespace brume {

Rgb series_color(std::size_t i) {
  constexpr std::array<Rgb, 8> kColors{{{45, 90, 216},     // blue
                                        {221, 101, 1},     // vermilion
                                        {5, 160, 112},     // bluish green
                                        {157, 114, 185},   // light violet, for their reddish purple
                                        {83, 181, 236},    // sky blue
                                        {226, 164, 3},     // orange
                                        {150, 54, 151},    // violet, for their yellow
                                        {102, 100, 79}}};  // grey, for their black
  return kColors[i % kColors.size()];
}

}  // namespace brume
