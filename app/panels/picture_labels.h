// What is written over pictures.
#pragma once

#include <imgui.h>

#include <string>

#include "app/panels/picture_view.h"
#include "app/session/session.h"

namespace brume {

/// The colour that a variant has in labels and charts.
ImU32 variant_color(std::size_t index);

/// A text on a dark plate, centred, its top so far below the top of the area.  @return the plate's height
float draw_plate(const PictureArea& area, float below_top, const std::string& text, ImU32 color = 0);

/// Samples per pixel, or what kind of preview it is.
std::string samples_text(const Picture& picture);

/// The variant's name at the upper left of the area, or from `left` on.
void draw_variant_label(const Session& session, std::size_t index, float left, const PictureArea& area);

/// Samples, time, rays, noise of the variant, and its error and bias where they are measured, along the lower edge.
void draw_variant_figures(const Session& session, std::size_t index, const PictureArea& area, bool measured);

/// Which pictures differ, and the colours with their values.
void draw_difference_legend(const Session& session, const ViewState& view, double range, const PictureArea& area);

/// A cross on the pixel that is probed, where one is.  @param chosen  in this picture, not at the same place of another
void draw_probe_mark(const ViewState& view, const PictureArea& area, bool chosen);

/// Problems, a pause, nothing to see, and what is under way.
void draw_messages(const Session& session, const PictureArea& area);

}  // namespace brume
