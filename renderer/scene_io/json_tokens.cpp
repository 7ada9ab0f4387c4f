#include "renderer/scene_io/json_tokens.h"

#include <algorithm>

#include "renderer/scene_io/json_print.h"
#include "renderer/scene_io/utf8.h"

namespace brume {
namespace {

using Kind = JsonToken::Kind;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
bool is_punctuation(char c) { return std::string_view("{}[],:").find(c) != std::string_view::npos; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hex(char c) { return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); }

/// [-] digits [. digits] [e [sign] digits], no superfluous leading zero: RFC 8259, section 6.
bool is_number(std::string_view word) {
  std::size_t i = 0;
  const auto digits = [&] {
    const std::size_t start = i;
    while (i < word.size() && is_digit(word[i])) ++i;
    return i - start;
  };
  const auto take = [&](std::string_view any_of) {
    const bool found = i < word.size() && any_of.find(word[i]) != std::string_view::npos;
    i += found;
    return found;
  };
  take("-");
  const bool leading_zero = i < word.size() && word[i] == '0';
  const std::size_t whole = digits();
  if (whole == 0 || (leading_zero && whole > 1)) return false;
  if (take(".") && digits() == 0) return false;
  if (take("eE")) {
    take("+-");
    if (digits() == 0) return false;
  }
  return i == word.size();
}

std::string word_message(std::string_view word) {
  if (word.starts_with("\xC2\xA0")) return "found a no-break space, expected a plain one";
  const std::string found = "found " + quote_for_message(word);
  std::string lower(word);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (lower == "true" || lower == "false" || lower == "null")
    return found + ", expected " + lower + " in small letters";
  if (lower == "nan" || lower.ends_with("inf") || lower.ends_with("infinity"))
    return found + ", expected a finite number";
  if (word.front() == '\'') return found + ", expected a text in double quotes";
  if (is_digit(word.front()) || std::string_view("+-.").find(word.front()) != std::string_view::npos)
    return found + ", expected a number written like 0.5, -2 or 1e-3";
  return found + ", expected a value; texts stand in double quotes";
}

/// The four digits of \uXXXX, whose backslash is at `offset`; nothing when they are not four.
std::optional<unsigned> code_unit(std::string_view text, std::size_t offset, std::size_t end) {
  if (offset + 6 > end || text[offset] != '\\' || text[offset + 1] != 'u') return std::nullopt;
  const std::string digits(text.substr(offset + 2, 4));
  if (!std::all_of(digits.begin(), digits.end(), is_hex)) return std::nullopt;
  return static_cast<unsigned>(std::stoul(digits, nullptr, 16));
}

/// `i` is at the backslash and moves behind the escape.
std::optional<JsonFault> escape_fault(std::string_view text, std::size_t& i, std::size_t end) {
  const char c = text[i + 1];
  if (c != 'u') {
    if (std::string_view("\"\\/bfnrt").find(c) == std::string_view::npos) {
      const std::string_view escaped = text.substr(i + 1, std::max<std::size_t>(1, utf8_length(text, i + 1)));
      return JsonFault{
          i, "found a backslash before " + quote_for_message(escaped) +
                 ", expected one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\u0000; write \\\\ for a plain backslash"};
    }
    i += 2;
    return std::nullopt;
  }
  const auto first = code_unit(text, i, end);
  if (!first) return JsonFault{i, "found an incomplete escape, expected \\u and four hexadecimal digits"};
  const auto is_high = [](unsigned u) { return u >= 0xD800 && u < 0xDC00; };
  const auto is_low = [](unsigned u) { return u >= 0xDC00 && u < 0xE000; };
  if (is_high(*first)) {
    const auto second = code_unit(text, i + 6, end);
    if (!second || !is_low(*second))
      return JsonFault{i, "found half of a surrogate pair, expected \\uD800-\\uDBFF followed by \\uDC00-\\uDFFF"};
    i += 12;
    return std::nullopt;
  }
  if (is_low(*first))
    return JsonFault{i, "found half of a surrogate pair, expected \\uD800-\\uDBFF followed by \\uDC00-\\uDFFF"};
  i += 6;
  return std::nullopt;
}

std::optional<JsonFault> text_fault(std::string_view text, const JsonToken& token) {
  for (std::size_t i = token.begin + 1; i < token.end;) {
    const char c = text[i];
    if (c == '"') return std::nullopt;  // the closing one: escapes are stepped over
    if (c == '\\' && i + 1 < token.end) {
      if (auto fault = escape_fault(text, i, token.end)) return fault;
      continue;
    }
    if (c == '\t') return JsonFault{i, "found a tab inside a text, expected \\t"};
    if (c >= 0 && c < 0x20)
      return JsonFault{i, "found a control character inside a text, expected an escape such as \\u0007"};
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return JsonFault{i, "found a byte that is not UTF-8; save the file as UTF-8"};
    i += length;
  }
  return JsonFault{token.begin, "found a text without its closing quote"};
}

}  // namespace

JsonToken next_json_token(std::string_view text, std::size_t offset) {
  std::size_t i = offset;
  while (i < text.size()) {
    if (is_space(text[i])) {
      ++i;
    } else if (text.substr(i, 2) == "//") {
      i = std::min(text.find_first_of("\r\n", i), text.size());
    } else if (text.substr(i, 2) == "/*") {
      const std::size_t close = text.find("*/", i + 2);
      if (close == std::string_view::npos) return {Kind::OpenComment, i, text.size()};
      i = close + 2;
    } else {
      break;
    }
  }
  if (i >= text.size()) return {Kind::End, text.size(), text.size()};
  if (is_punctuation(text[i])) return {Kind::Punctuation, i, i + 1};

  std::size_t end = i + 1;
  if (text[i] == '"') {
    while (end < text.size() && text[end] != '"' && text[end] != '\n' && text[end] != '\r')
      end += text[end] == '\\' && end + 1 < text.size() && text[end + 1] != '\n' && text[end + 1] != '\r' ? 2 : 1;
    if (end < text.size() && text[end] == '"') ++end;
    return {Kind::Text, i, end};
  }
  while (end < text.size() && !is_space(text[end]) && !is_punctuation(text[end]) && text[end] != '"' &&
         text[end] != '/')
    ++end;
  return {Kind::Word, i, end};
}

std::optional<JsonFault> spelling_fault(std::string_view text, const JsonToken& token) {
  switch (token.kind) {
    case Kind::End:
      return std::nullopt;
    case Kind::Punctuation:
      return std::nullopt;
    case Kind::OpenComment:
      return JsonFault{token.begin, "found a comment without its end, expected */"};
    case Kind::Text:
      return text_fault(text, token);
    case Kind::Word:
      break;
  }
  const std::string_view word = token.in(text);
  if (word == "true" || word == "false" || word == "null" || is_number(word)) return std::nullopt;
  return JsonFault{token.begin, word_message(word)};
}

}  // namespace brume
