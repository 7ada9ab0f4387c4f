#include "renderer/scene_io/json_syntax.h"

#include "renderer/scene_io/json_print.h"

namespace brume {
namespace {

using After = JsonProgress::After;

std::string found(std::string_view text, const JsonToken& token) {
  switch (token.kind) {
    case JsonToken::Kind::End:
      return "the file ends too early";
    case JsonToken::Kind::Punctuation:
      return std::string("found ") + text[token.begin];
    case JsonToken::Kind::Text: {
      std::string_view inside = token.in(text).substr(1);
      if (inside.ends_with('"')) inside.remove_suffix(1);
      return "found " + quote_for_message(inside);
    }
    default:
      return "found " + quote_for_message(token.in(text));
  }
}

/// Reminds of the bracket that is still open, unless it is on view.
std::string opened_in(const JsonProgress& progress) {
  return std::string(" for the ") + progress.bracket + " of line " + std::to_string(progress.bracket_line);
}

}  // namespace

JsonFault explain_syntax_error(std::string_view text, const JsonProgress& progress) {
  const bool in_object = progress.bracket == '{';
  const char closing = in_object ? '}' : ']';
  JsonToken token = next_json_token(text, progress.offset);

  // Behind a value belongs a comma or the closing bracket.
  bool after_comma = false;
  JsonToken comma;
  if (progress.after == After::Value) {
    if (progress.bracket == 0) {
      if (token.kind == JsonToken::Kind::OpenComment) return *spelling_fault(text, token);
      return {token.begin, found(text, token) + " after the end, expected nothing more"};
    }
    if (!token.is(text, ',')) {
      if (token.kind == JsonToken::Kind::OpenComment) return *spelling_fault(text, token);
      if (token.kind == JsonToken::Kind::End)
        return {token.begin, found(text, token) + ", expected " + closing + opened_in(progress)};
      return {token.begin, found(text, token) + ", expected a comma or " + closing + opened_in(progress)};
    }
    after_comma = true;
    comma = token;
    token = next_json_token(text, token.end);
    if (token.is(text, closing))
      return {comma.begin, std::string("found a comma before ") + closing + ", expected none behind the last " +
                               (in_object ? "member" : "value")};
  }

  // Behind a key belongs a colon.
  if (progress.after == After::Key) {
    if (!token.is(text, ':')) {
      if (auto fault = spelling_fault(text, token); fault && token.kind == JsonToken::Kind::OpenComment) return *fault;
      return {token.begin, found(text, token) + ", expected a colon behind the key"};
    }
    token = next_json_token(text, token.end);
  }

  const bool key_is_next = in_object && (progress.after == After::OpenBracket || after_comma);
  if (key_is_next && token.kind == JsonToken::Kind::Word)
    return {token.begin, found(text, token) + ", expected a key in double quotes"};
  if (auto fault = spelling_fault(text, token)) return *fault;
  if (token.kind == JsonToken::Kind::End && progress.bracket == 0)
    return {token.begin, "found nothing, expected a value"};
  if (key_is_next) return {token.begin, found(text, token) + ", expected a key in double quotes" + opened_in(progress)};
  if (token.kind == JsonToken::Kind::Word)
    return {token.begin, found(text, token) + ", expected a number within +-1.8e308"};
  return {token.begin, found(text, token) + ", expected a value"};
}

}  // namespace brume
