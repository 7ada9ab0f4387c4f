// Why a JSON text cannot be read, in plain words.
#pragma once

#include <string>
#include <string_view>

#include "renderer/scene_io/json_tokens.h"

namespace brume {

/// How far a parser came before it met something it could not take.
struct JsonProgress {
  enum class After { Nothing, OpenBracket, Key, Value };

  After after = After::Nothing;  ///< what was read last
  std::size_t offset = 0;        ///< where it ended
  char bracket = 0;              ///< the innermost open bracket, { or [, or 0 when none is open
  int bracket_line = 0;          ///< its line, counted from 1
};

/// Finds the first byte behind `progress` that does not belong there, and says what would.
JsonFault explain_syntax_error(std::string_view text, const JsonProgress& progress);

}  // namespace brume
