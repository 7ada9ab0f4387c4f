// Columns for people.
#pragma once

#include <string>
#include <vector>

namespace brume {

/// Rows of cells in aligned columns, two blanks apart; the last column is not padded. Widths count characters of UTF-8.
/// @param alignment  one letter per column: 'r' for numbers, 'l' for text; columns beyond it are text.
/// @param indent  blanks before every row
std::string format_table(const std::vector<std::vector<std::string>>& rows, const std::string& alignment, int indent);

/// At most `digits` significant digits, without useless zeros: "0.03646", "1.2e-05", "20".
std::string short_number(double value, int digits = 4);

/// "812 B", "4.2 MB"; powers of 1000.
std::string format_bytes(double bytes);

}  // namespace brume
