// A drawing as a picture of lines, for reports and web pages.
#pragma once

#include <string>

#include "renderer/analysis/chart_layout.h"

namespace brume {

/// SVG 1.1 in UTF-8 that stands alone: no style sheet, script, font or picture from elsewhere. Texts stay text; what is
/// no UTF-8 or is forbidden in XML becomes U+FFFD. Lengths have two decimals whatever the locale, so the same drawing
/// gives the same bytes. Numbers that are not finite become 0.
std::string to_svg(const Drawing& drawing);

}  // namespace brume
