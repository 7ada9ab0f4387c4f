// What of the pictures is shown, and how.
#pragma once

#include <cstddef>

#include "renderer/analysis/difference.h"

namespace brume {

enum class ViewMode {
  Single,      ///< one variant
  Tiles,       ///< all, side by side
  Wipe,        ///< two, left and right of a line
  Difference,  ///< of two
};

/// Belongs to the window, not to the document: looking changes nothing.
struct ViewState {
  ViewMode mode = ViewMode::Tiles;
  std::size_t shown = 0;  ///< the single one, the one left of the line, the test of the difference
  std::size_t other = 1;  ///< the one right of the line, the reference of the difference
  float wipe = 0.5f;  ///< where the line is, as a fraction of the picture's width: it keeps its place in the picture
  DifferenceKind difference = DifferenceKind::Signed;
  bool against_truth = false;  ///< the difference is that from the reference, not from `other`

  // The part of the pictures that is seen, the same of all.
  float zoom = 1;                          ///< at least 1: all of it
  float center_x = 0.5f, center_y = 0.5f;  ///< as fractions of the picture

  // The pixel that is probed, of what is shown.
  bool probing = false;
  float probe_x = 0.5f, probe_y = 0.5f;  ///< as fractions of the picture

  /// Of two variants, or of one from the reference.
  void show_difference(bool from_truth) { mode = ViewMode::Difference, against_truth = from_truth; }
  /// Of so many pictures: what is not there is not shown, and nothing is compared with itself.
  void choose_among(std::size_t count);
  /// Keeps what is seen inside the picture.
  void clamp();
  /// By a factor about a place of the picture, which stays where it is on the screen.
  void zoom_about(float x, float y, float factor);
};

}  // namespace brume
