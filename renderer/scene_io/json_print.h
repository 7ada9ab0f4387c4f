// JSON values as text that people like to read and to compare line by line.
#pragma once

#include <string>
#include <string_view>

#include "renderer/scene_io/json_tree.h"

namespace brume {

/// How many columns a line may have before a list or an object is spread over several.
inline constexpr int kJsonColumns = 100;

/// The value with two spaces of indentation, without a final newline. A list of plain values fills lines; an object
/// goes on one line when it fits and holds no list of objects. Numbers are the shortest that read back the same, whole
/// ones without a fraction.
/// @param spread_root  puts each member of a root object on its own line even if all would fit on one.
std::string format_json(const JsonValue& value, bool spread_root = false);

/// A text in double quotes, with escapes. Bytes that are not UTF-8 become U+FFFD.
std::string quote_json(std::string_view text);

/// The same for messages: long texts are cut short.
std::string quote_for_message(std::string_view text);

}  // namespace brume
