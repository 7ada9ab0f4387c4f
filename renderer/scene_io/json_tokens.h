// The words of a JSON text, and what is wrong with a misspelt one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace brume {

/// A run of bytes [begin, end) that belongs together.
struct JsonToken {
  enum class Kind {
    End,          ///< nothing is left
    Punctuation,  ///< one of { } [ ] , :
    Text,         ///< from quote to quote; to the end of the line where the closing quote is missing
    Word,         ///< anything else up to white space, punctuation, a quote or a slash: numbers, true, and nonsense
    OpenComment,  ///< a /* comment without its end, up to the end of the text
  };
  Kind kind = Kind::End;
  std::size_t begin = 0, end = 0;

  std::string_view in(std::string_view text) const { return text.substr(begin, end - begin); }
  bool is(std::string_view text, char punctuation) const {
    return kind == Kind::Punctuation && text[begin] == punctuation;
  }
};

/// The first token at or after `offset`; white space and comments in between are skipped.
JsonToken next_json_token(std::string_view text, std::size_t offset);

/// A mistake and the byte where it sits.
struct JsonFault {
  std::size_t offset;
  std::string message;
};

/// What is wrong with a token taken by itself; nothing when it is well spelt.
std::optional<JsonFault> spelling_fault(std::string_view text, const JsonToken& token);

}  // namespace brume
