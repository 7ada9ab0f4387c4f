// One parameter as a row of the inspector, made from its table entry alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/params/param.h"

namespace brume {

struct ParamRowContext {
  std::vector<std::string> grids;         ///< names offered for a parameter of type Grid
  std::optional<double> automatic_value;  ///< what "auto" has come to, where known
  bool changed = false;                   ///< there is something to reset
  std::string reset_help = "Back to the default";
  std::string dragged = {};  ///< what dragging the name carries: a setting's path; empty: it cannot be dragged
};

struct ParamEdit {
  std::optional<Value> value;  ///< what the user has just set
  bool reset = false;          ///< the reset button was pressed
  bool finished = false;       ///< the edit is over: the moment to close a step of the history
  bool browse = false;         ///< the user wants to choose a file
};

/// Draws the row. The widget is named "Window/Label", its reset button "Window/Label/reset", the switch between "auto"
/// and a value "Window/Label/auto".
ParamEdit param_row(const Param& param, const Value& value, const ParamRowContext& context);

}  // namespace brume
