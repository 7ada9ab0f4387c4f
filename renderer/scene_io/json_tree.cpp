#include "renderer/scene_io/json_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <nlohmann/json.hpp>

#include "renderer/scene_io/json_print.h"
#include "renderer/scene_io/json_syntax.h"

namespace brume {

using Kind = JsonValue::Kind;

JsonValue::JsonValue() = default;
JsonValue::JsonValue(const JsonValue& other) = default;
JsonValue::JsonValue(JsonValue&& other) noexcept = default;
JsonValue& JsonValue::operator=(const JsonValue& other) = default;
JsonValue& JsonValue::operator=(JsonValue&& other) noexcept = default;
JsonValue::~JsonValue() = default;

JsonValue::JsonValue(bool value) : kind(Kind::Bool), boolean(value) {}
JsonValue::JsonValue(int value) : JsonValue(static_cast<std::int64_t>(value)) {}
JsonValue::JsonValue(std::int64_t value) : kind(Kind::Number), number(static_cast<double>(value)), integer(value) {}
JsonValue::JsonValue(double value) : kind(Kind::Number), number(value) {
  // 2^63 is the first double that std::int64_t cannot hold.
  constexpr double kTooLarge = 9223372036854775808.0;
  if (value == std::floor(value) && std::abs(value) < kTooLarge) integer = static_cast<std::int64_t>(value);
}
JsonValue::JsonValue(std::string value) : kind(Kind::Text), text(std::move(value)) {}
JsonValue::JsonValue(const char* value) : kind(Kind::Text), text(value) {}

JsonValue JsonValue::array(std::vector<JsonValue> items) {
  JsonValue v;
  v.kind = Kind::Array;
  v.items = std::move(items);
  return v;
}

JsonValue JsonValue::object() {
  JsonValue v;
  v.kind = Kind::Object;
  return v;
}

JsonValue& JsonValue::add(std::string key, JsonValue value) {
  members.push_back({std::move(key), std::move(value)});
  return *this;
}

const JsonMember* JsonValue::find(std::string_view key) const {
  const auto it = std::find_if(members.begin(), members.end(), [&](const JsonMember& m) { return m.key == key; });
  return it == members.end() ? nullptr : &*it;
}

std::string describe(const JsonValue& v) {
  switch (v.kind) {
    case Kind::Null:
      return "null";
    case Kind::Bool:
    case Kind::Number:
      return format_json(v);
    case Kind::Text:
      return "the text " + quote_for_message(v.text);
    case Kind::Array:
      if (v.items.empty()) return "an empty list";
      return "a list of " + std::to_string(v.items.size()) + (v.items.size() == 1 ? " value" : " values");
    case Kind::Object:
      return "an object";
  }
  return "";
}

namespace {

struct Position {
  int line, column;
};

/// Lines and columns of byte offsets.
class Lines {
 public:
  explicit Lines(std::string_view text) : starts_{0} {
    for (std::size_t i = 0; i < text.size(); ++i)
      if (text[i] == '\n') starts_.push_back(i + 1);
  }
  Position at(std::size_t offset) const {
    const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
    return {static_cast<int>(next - starts_.begin()), static_cast<int>(offset - *(next - 1)) + 1};
  }

 private:
  std::vector<std::size_t> starts_;
};

/// Builds the tree from the parser's events. The parser does not tell where its tokens begin, and it has read one byte
/// past the end of numbers; so each event looks up its own token: the first one behind the last event's that is neither
/// comma nor colon.
class TreeBuilder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, const std::string& file) : text_(text), file_(file), lines_(text) {}

  bool null() override { return take_word(JsonValue()); }
  bool boolean(bool value) override { return take_word(value); }
  bool number_integer(number_integer_t value) override {
    // The parser has integers only where there is a minus sign: this 0 was written -0.
    if (value == 0) return take_word(-0.0);
    return take_word(static_cast<std::int64_t>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    if (value <= static_cast<number_unsigned_t>(std::numeric_limits<std::int64_t>::max()))
      return take_word(static_cast<std::int64_t>(value));
    return take_word(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return take_word(value); }
  bool string(string_t& value) override {
    const JsonToken token = next_token();
    add_value(std::move(value), token.begin);
    return advance(JsonProgress::After::Value, token);
  }
  bool binary(binary_t&) override { return false; }  // JSON text has none

  bool start_object(std::size_t) override { return open(JsonValue::object()); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(JsonValue::array()); }
  bool end_array() override { return close(); }

  bool key(string_t& value) override {
    const JsonToken token = next_token();
    const Position position = lines_.at(token.begin);
    Level& level = open_.back();
    const auto [earlier, is_new] = level.line_of_key.emplace(value, position.line);
    if (!is_new) {
      return fail({token.begin, "found the key " + quote_for_message(value) + " a second time, after line " +
                                    std::to_string(earlier->second) + "; expected it once"});
    }
    level.value.members.push_back({std::move(value), JsonValue(), position.line, position.column});
    return advance(JsonProgress::After::Key, token);
  }

  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    JsonProgress progress = progress_;
    progress.bracket = open_.empty() ? '\0' : text_[open_.back().offset];
    progress.bracket_line = open_.empty() ? 0 : lines_.at(open_.back().offset).line;
    return fail(explain_syntax_error(text_, progress));
  }

  bool fail(JsonFault fault) {
    const Position p = lines_.at(fault.offset);
    error_ = bad_input(std::move(fault.message), {file_, p.line, p.column, ""});
    return false;
  }

  const std::optional<Error>& error() const { return error_; }
  JsonValue root;

 private:
  /// A bracket that is not closed yet.
  struct Level {
    JsonValue value;
    std::size_t offset;
    std::unordered_map<std::string, int> line_of_key;
  };

  JsonToken next_token() const {
    JsonToken token = next_json_token(text_, progress_.offset);
    while (token.is(text_, ',') || token.is(text_, ':')) token = next_json_token(text_, token.end);
    return token;
  }

  bool advance(JsonProgress::After after, const JsonToken& token) {
    progress_.after = after;
    progress_.offset = token.end;
    return true;
  }

  /// Numbers and literals. The parser takes 01 for a 0 with something behind it; we take it for a misspelt number.
  bool take_word(JsonValue value) {
    const JsonToken token = next_token();
    if (auto fault = spelling_fault(text_, token)) return fail(std::move(*fault));
    add_value(std::move(value), token.begin);
    return advance(JsonProgress::After::Value, token);
  }

  void add_value(JsonValue value, std::size_t offset) {
    const Position position = lines_.at(offset);
    value.line = position.line;
    value.column = position.column;
    if (open_.empty())
      root = std::move(value);
    else if (JsonValue& parent = open_.back().value; parent.kind == Kind::Array)
      parent.items.push_back(std::move(value));
    else
      parent.members.back().value = std::move(value);
  }

  bool open(JsonValue value) {
    const JsonToken token = next_token();
    if (open_.size() >= kMaxJsonDepth)
      return fail({token.begin, "found brackets nested more than " + std::to_string(kMaxJsonDepth) + " deep"});
    open_.push_back({std::move(value), token.begin, {}});
    return advance(JsonProgress::After::OpenBracket, token);
  }

  bool close() {
    const JsonToken token = next_token();
    Level level = std::move(open_.back());
    open_.pop_back();
    add_value(std::move(level.value), level.offset);
    return advance(JsonProgress::After::Value, token);
  }

  std::string_view text_;
  const std::string& file_;
  Lines lines_;
  std::vector<Level> open_;
  JsonProgress progress_;
  std::optional<Error> error_;
};

}  // namespace

Result<JsonValue> parse_json(std::string_view text, const std::string& file) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  if (text.starts_with(kByteOrderMark))
    return bad_input("found a second byte order mark, expected at most one", {file, 1, 1, ""});
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return bad_input("found UTF-16, expected UTF-8; save the file as UTF-8", {file, 1, 1, ""});
  try {
    TreeBuilder builder(text, file);
    // The parser would take a zero byte for the end.
    if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
      builder.fail({zero, "found a zero byte, expected a text file"});
    } else if (nlohmann::json::sax_parse(text.begin(), text.end(), &builder, nlohmann::json::input_format_t::json, true,
                                         true)) {
      return std::move(builder.root);
    }
    return *builder.error();
  } catch (const std::exception& e) {
    return Error{ErrorCode::Internal, std::string("cannot read this JSON: ") + e.what(), {file, 0, 0, ""}};
  }
}

}  // namespace brume
