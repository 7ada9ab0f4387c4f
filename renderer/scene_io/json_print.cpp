#include "renderer/scene_io/json_print.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/params/param.h"
#include "renderer/scene_io/utf8.h"

namespace brume {
namespace {

using Kind = JsonValue::Kind;

bool is_container(const JsonValue& v) { return v.kind == Kind::Array || v.kind == Kind::Object; }

std::string number_text(const JsonValue& v) {
  // A negative zero is whole, yet no integer can hold its sign.
  const bool negative_zero = v.number == 0 && std::signbit(v.number);
  return format_value(v.integer && !negative_zero ? Value(*v.integer) : Value(v.number));
}

std::string one_line(const JsonValue& v) {
  switch (v.kind) {
    case Kind::Null:
      return "null";
    case Kind::Bool:
      return v.boolean ? "true" : "false";
    case Kind::Number:
      return number_text(v);
    case Kind::Text:
      return quote_json(v.text);
    case Kind::Array:
      break;
    case Kind::Object:
      break;
  }
  std::vector<std::string> parts;
  for (const JsonValue& item : v.items) parts.push_back(one_line(item));
  for (const JsonMember& m : v.members) parts.push_back(quote_json(m.key) + ": " + one_line(m.value));
  return v.kind == Kind::Array ? "[" + join(parts) + "]" : "{" + join(parts) + "}";
}

/// A list of lists or objects is a list of things: each of them gets a line.
bool holds_list_of_containers(const JsonValue& v) {
  return std::any_of(v.items.begin(), v.items.end(), is_container) ||
         std::any_of(v.members.begin(), v.members.end(),
                     [](const JsonMember& m) { return holds_list_of_containers(m.value); });
}

class Printer {
 public:
  /// @param used  columns already taken on the line by what stands before the value.
  void print(const JsonValue& v, int indent, int used, bool spread) {
    if (!is_container(v) || (v.items.empty() && v.members.empty())) {
      out += one_line(v);
      return;
    }
    if (!spread && !holds_list_of_containers(v)) {
      const std::string line = one_line(v);
      if (used + static_cast<int>(line.size()) + 1 <= kJsonColumns) {  // 1: a comma may follow
        out += line;
        return;
      }
    }
    const bool list = v.kind == Kind::Array;
    out += list ? "[" : "{";
    if (list && std::none_of(v.items.begin(), v.items.end(), is_container))
      fill_lines(v, indent + 2);
    else
      put_each_on_a_line(v, indent + 2);
    new_line(indent);
    out += list ? "]" : "}";
  }

  std::string out;

 private:
  void new_line(int indent) { out.append("\n").append(static_cast<std::size_t>(indent), ' '); }

  void fill_lines(const JsonValue& list, int indent) {
    int used = kJsonColumns;
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      const std::string word = one_line(list.items[i]) + (i + 1 < list.items.size() ? "," : "");
      const int width = static_cast<int>(word.size());
      if (used + 1 + width > kJsonColumns) {
        new_line(indent);
        used = indent + width;
      } else {
        out += ' ';
        used += 1 + width;
      }
      out += word;
    }
  }

  void put_each_on_a_line(const JsonValue& v, int indent) {
    bool first = true;
    const auto begin = [&] {
      if (!first) out += ',';
      first = false;
      new_line(indent);
    };
    for (const JsonValue& item : v.items) {
      begin();
      print(item, indent, indent, false);
    }
    for (const JsonMember& m : v.members) {
      begin();
      const std::string key = quote_json(m.key) + ": ";
      out += key;
      print(m.value, indent, indent + static_cast<int>(key.size()), false);
    }
  }
};

}  // namespace

std::string format_json(const JsonValue& value, bool spread_root) {
  Printer printer;
  printer.print(value, 0, 0, spread_root);
  return std::move(printer.out);
}

std::string quote_json(std::string_view text) {
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const char c = text[i];
    if (length == 0) {
      out += "\xEF\xBF\xBD";
    } else if (c == '"' || c == '\\') {
      out.append("\\").append(1, c);
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else if ((c >= 0 && c < 0x20) || c == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(c));
      out += escape;
    } else {
      out += text.substr(i, length);
    }
    i += std::max<std::size_t>(1, length);
  }
  return out + '"';
}

std::string quote_for_message(std::string_view text) {
  constexpr std::size_t kLongest = 60;  // bytes; more would hide the rest of the sentence
  if (text.size() <= kLongest) return quote_json(text);
  std::size_t cut = 0;
  while (cut < kLongest) cut += std::max<std::size_t>(1, utf8_length(text, cut));
  return quote_json(std::string(text.substr(0, cut)) + "...");
}

}  // namespace brume
