// UTF-8: what scene files are written in.
#pragma once

#include <cstddef>
#include <string_view>

namespace brume {

/// Bytes (1 to 4) of the well-formed character that begins at `offset`; 0 when none does, or at the end of `text`.
/// RFC 3629: no overlong forms, no surrogates, nothing above U+10FFFF.
std::size_t utf8_length(std::string_view text, std::size_t offset);

/// Whether all of `text` is well-formed.
bool is_utf8(std::string_view text);

}  // namespace brume
