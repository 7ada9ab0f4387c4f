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
};

struct ParamEdit {
  std::optional<Value> value;  ///< what the user has just set
  bool finished = false;       ///< the edit is over: the moment to close a step of the history
  bool browse = false;         ///< the user wants to choose a file
};

/// Draws the row. The widget is named "Window/Label", its reset button "Window/Label/reset", the switch between "auto"
/// and a value "Window/Label/auto".
ParamEdit param_row(const Param& param, const Value& value, const ParamRowContext& context);

}  // namespace brume
