// Numbers in texts.
#pragma once

#include <cstdio>
#include <string>

namespace brume {

/// @param format  of printf, for one double, with a unit perhaps: "%.2f %%"; cut after 63 characters
inline std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace brume
