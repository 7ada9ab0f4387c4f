// JSON as a tree that remembers where everything stood, so that each mistake in a scene file can be pointed at.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/core/error.h"

namespace brume {

struct JsonMember;

/// One JSON value. Only the field of its kind means something.
struct JsonValue {
  enum class Kind { Null, Bool, Number, Text, Array, Object };

  Kind kind = Kind::Null;
  bool boolean = false;
  double number = 0;  ///< finite
  std::optional<std::int64_t>
      integer;       ///< of a number: its exact value, when it is whole and fits; 3, 3.0 and 3e0 alike
  std::string text;  ///< UTF-8
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;  ///< in the order of the file

  int line = 0, column = 0;  ///< of the first byte, counted from 1, column in bytes; 0 in values that were not parsed

  JsonValue();
  JsonValue(bool value);
  JsonValue(int value);
  JsonValue(std::int64_t value);
  JsonValue(double value);
  JsonValue(std::string value);
  JsonValue(const char* value);
  static JsonValue array(std::vector<JsonValue> items = {});
  static JsonValue object();

  // Defined where JsonMember is complete.
  JsonValue(const JsonValue& other);
  JsonValue(JsonValue&& other) noexcept;
  JsonValue& operator=(const JsonValue& other);
  JsonValue& operator=(JsonValue&& other) noexcept;
  ~JsonValue();

  /// Of an object: appends a member, and returns the object.
  JsonValue& add(std::string key, JsonValue value);
  /// Of an object: the member of that key, or null.
  const JsonMember* find(std::string_view key) const;
};

/// A key and its value.
struct JsonMember {
  std::string key;
  JsonValue value;
  int line = 0, column = 0;  ///< of the key's opening quote
};

/// Brackets may be nested this deep.
inline constexpr int kMaxJsonDepth = 64;

/// Reads JSON (RFC 8259, UTF-8, with or without a byte order mark) with // and /* */ comments.
/// Errors, with line and column: syntax, a key given twice in one object, a number beyond double, a zero byte, nesting
/// beyond kMaxJsonDepth, anything after the value. Numbers too small for double become 0.
/// @param file  only names the source in errors.
Result<JsonValue> parse_json(std::string_view text, const std::string& file);

/// What was found, for messages: "null", "3.5", "the text "abc"", "a list of 2 values", "an object".
std::string describe(const JsonValue& value);

}  // namespace brume
