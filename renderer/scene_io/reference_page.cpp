#include "renderer/scene_io/reference_page.h"

#include <algorithm>

#include "renderer/scene_io/families.h"
#include "renderer/scene_io/json_print.h"
#include "renderer/scene_io/scene_format.h"
#include "renderer/scene_io/write_node.h"

namespace brume {
namespace {

/// Text in a table: no bars, no line breaks.
std::string cell(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '|') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

/// "a light", "an integrator"
std::string with_article(const std::string& noun) {
  const bool vowel = !noun.empty() && std::string_view("aeiou").find(noun[0]) != std::string_view::npos;
  return (vowel ? "an " : "a ") + noun;
}

/// To the section of the family; Markdown viewers make anchors from headings like this.
std::string link(const Family& f) {
  std::string anchor;
  for (char c : f.noun) anchor += c == ' ' ? '-' : c;
  return "[" + f.noun + "](#" + anchor + ")";
}

std::string type_name(const Param& p) {
  switch (p.type) {
    case ParamType::Bool:
      return "true or false";
    case ParamType::Int:
      return "whole number";
    case ParamType::Number:
      return "number";
    case ParamType::Text:
    case ParamType::Grid:
      return "text";
    case ParamType::File:
      return "file";
    case ParamType::Choice:
      return "choice";
    case ParamType::Resolution:
      return "two whole numbers";
    case ParamType::Point:
      return "three numbers";
    case ParamType::Vector:
      return "three numbers or one";
    case ParamType::Color:
      return "colour: three numbers or one";
    case ParamType::NumberList:
      return "list of numbers";
    case ParamType::Matrix:
      return "16 numbers or none";
    case ParamType::SettingList:
      return "settings: an object of paths and values";
  }
  return "";
}

std::string range_of(const Param& p) {
  const bool has_low = p.low > -std::numeric_limits<double>::infinity();
  const bool has_high = p.high < std::numeric_limits<double>::infinity();
  const std::string low = (p.low_open ? "> " : ">= ") + format_value(p.low), high = "<= " + format_value(p.high);
  return has_low && has_high ? low + ", " + high : has_low ? low : has_high ? high : "";
}

const char* restarts(Affects affects) {
  switch (affects) {
    case Affects::Display:
      return "nothing";
    case Affects::Accumulation:
      return "the picture";
    case Affects::Geometry:
      return "loading and the picture";
  }
  return "";
}

std::string default_of(const Param& p) {
  return p.required ? "required" : code(format_json(value_to_json(p.default_value)));
}

std::string row(const std::vector<std::string>& cells) {
  std::vector<std::string> parts;
  for (const std::string& c : cells) parts.push_back(cell(c));
  return "| " + join(parts, " | ") + " |\n";
}

std::string param_table(const ParamTable& t) {
  std::string out = row({"key", "label", "type", "default", "range", "unit", "restarts", "doc"}) +
                    "|---|---|---|---|---|---|---|---|\n";
  for (const Param& p : t.params) {
    const std::string type = type_name(p) + (p.automatic ? " or `\"auto\"`" : "");
    out += row({code(p.key), p.label, type, default_of(p), range_of(p), p.unit, restarts(p.affects), p.doc});
  }
  for (const Slot& s : t.slots) {
    const Family& f = *s.family;
    const std::string kind = f.type_key.empty() ? "" : code(f.tables.front()->key);
    const std::string type = (s.list ? "list of " : "object: ") + link(f);
    out += row({code(s.key), s.label, type, s.list ? "`[]`" : kind, "", "", "", s.doc});
  }
  return out + "\n";
}

/// What does not fit into the table: the choices, and what "auto" does.
std::string notes(const ParamTable& t) {
  std::string out;
  for (const Param& p : t.params) {
    if (p.automatic) out += "- " + code(p.key) + ": `\"auto\"` is " + *p.automatic + ".\n";
    if (p.choices.empty()) continue;
    out += "- " + code(p.key) + ":\n";
    for (const Choice& c : p.choices) out += "  - " + code(c.key) + (c.doc.empty() ? "" : ": " + c.doc) + "\n";
  }
  return out.empty() ? out : out + "\n";
}

std::string kind_section(const Family& f, const ParamTable& t) {
  std::string out;
  if (!f.type_key.empty()) {
    out += "### " + t.label + "\n\n";
    out += code("\"" + f.type_key + "\": \"" + t.key + "\"");
    out += &t == f.tables.front() ? " (the default)\n\n" : "\n\n";
  }
  if (!t.doc.empty()) out += t.doc + "\n\n";
  if (t.params.empty() && t.slots.empty()) return out + "It has no parameters.\n\n";
  return out + param_table(t) + notes(t);
}

}  // namespace

std::string reference_page(const Family& root) {
  const std::string format = code("\"" + std::string(kSceneFormatKey) + "\": " + std::to_string(kSceneFormat));
  std::string out = "# Scene reference\n\n";
  out +=
      "A scene file is JSON with " + format + " among the keys of " + with_article(root.noun) +
      ". Comments (`//` and `/* */`) are allowed. What is left out has its default; unknown keys are errors. Relative "
      "paths start from the folder of the scene file.\n\n";
  for (const Family* f : reachable_families(root)) {
    out += "## " + capitalised(f->noun) + "\n\n";
    if (f->tables.size() > 1) out += code(f->type_key) + " says which of these it is: " + join(f->kinds()) + ".\n\n";
    for (const ParamTable* t : f->tables) out += kind_section(*f, *t);
  }
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

}  // namespace brume
