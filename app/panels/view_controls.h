// Keys and menu for variants and for what of them is shown.
#pragma once

#include <optional>

#include "app/panels/view_state.h"
#include "app/session/session.h"
#include "app/ui/keys.h"

namespace brume {

class ViewControls {
 public:
  ViewState& view() { return view_; }

  /// @param edited  the variant that the inspector edits, if any; a new one is edited at once
  void handle_keys(Session& session, std::optional<std::size_t>& edited);
  /// The menu "Compare".
  void draw_menu(Session& session, std::optional<std::size_t>& edited, bool& show_chart);

 private:
  void flip(std::size_t count);

  ViewState view_;
  struct {
    ui::Key key;
    ViewState before;
    double since;
  } flipped_ = {};  // while a number key is held
};

}  // namespace brume
