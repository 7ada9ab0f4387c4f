#include "renderer/params/param.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

namespace brume {

Param&& Param::between(double lo, double hi) && {
  low = lo, high = hi;
  slider_low = lo, slider_high = hi;
  return std::move(*this);
}
Param&& Param::at_least(double lo) && { return low = lo, std::move(*this); }
Param&& Param::more_than(double lo) && { return low = lo, low_open = true, std::move(*this); }
Param&& Param::slider(double lo, double hi) && { return slider_low = lo, slider_high = hi, std::move(*this); }
Param&& Param::log_slider(double lo, double hi) && {
  slider_low = lo, slider_high = hi, logarithmic = true;
  return std::move(*this);
}
Param&& Param::in(std::string unit_) && { return unit = std::move(unit_), std::move(*this); }
Param&& Param::says(std::string doc_) && { return doc = std::move(doc_), std::move(*this); }
Param&& Param::or_auto(std::string what) && { return automatic = std::move(what), std::move(*this); }
Param&& Param::auto_by_default(std::string what) && {
  automatic = std::move(what);
  default_value = Auto{};
  return std::move(*this);
}
Param&& Param::must_be_given() && { return required = true, std::move(*this); }
Param&& Param::costs(Affects a) && { return affects = a, std::move(*this); }

namespace param {
namespace {

Param make(std::string key, std::string label, ParamType type, Value value) {
  Param p;
  p.key = std::move(key);
  p.label = std::move(label);
  p.type = type;
  p.manual_value = value;
  p.default_value = std::move(value);
  return p;
}

}  // namespace

Param flag(std::string key, std::string label, bool value) {
  return make(std::move(key), std::move(label), ParamType::Bool, value);
}
Param integer(std::string key, std::string label, std::int64_t value) {
  return make(std::move(key), std::move(label), ParamType::Int, value);
}
Param number(std::string key, std::string label, double value) {
  return make(std::move(key), std::move(label), ParamType::Number, value);
}
Param text(std::string key, std::string label, std::string value) {
  return make(std::move(key), std::move(label), ParamType::Text, std::move(value));
}
Param file(std::string key, std::string label) {
  return make(std::move(key), std::move(label), ParamType::File, std::string()).costs(Affects::Geometry);
}
Param grid(std::string key, std::string label, std::string value) {
  return make(std::move(key), std::move(label), ParamType::Grid, std::move(value)).costs(Affects::Geometry);
}
Param choice(std::string key, std::string label, std::string value, std::vector<Choice> choices) {
  Param p = make(std::move(key), std::move(label), ParamType::Choice, std::move(value));
  p.choices = std::move(choices);
  return p;
}
Param resolution(std::string key, std::string label, int width, int height) {
  return make(std::move(key), std::move(label), ParamType::Resolution, Numbers{double(width), double(height)});
}
Param point(std::string key, std::string label, double x, double y, double z) {
  return make(std::move(key), std::move(label), ParamType::Point, Numbers{x, y, z}).in("world units");
}
Param vector(std::string key, std::string label, double x, double y, double z) {
  return make(std::move(key), std::move(label), ParamType::Vector, Numbers{x, y, z});
}
Param color(std::string key, std::string label, double r, double g, double b) {
  return make(std::move(key), std::move(label), ParamType::Color, Numbers{r, g, b}).at_least(0);
}
Param numbers(std::string key, std::string label, Numbers value) {
  return make(std::move(key), std::move(label), ParamType::NumberList, std::move(value));
}
Param matrix(std::string key, std::string label) {
  return make(std::move(key), std::move(label), ParamType::Matrix, Numbers{});
}
Param settings(std::string key, std::string label) {
  return make(std::move(key), std::move(label), ParamType::SettingList, Settings{});
}

}  // namespace param

namespace {

std::string number_text(double v) {
  char buffer[32];
  // Below 1e15 a whole number is exact and short enough to be written out.
  const bool whole = std::abs(v) < 1e15 && v == std::floor(v);
  const auto end = whole ? std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::fixed).ptr
                         : std::to_chars(buffer, buffer + sizeof buffer, v).ptr;
  return {buffer, end};
}

std::string range_text(const Param& p) {
  const bool has_low = std::isfinite(p.low), has_high = std::isfinite(p.high);
  const std::string low = number_text(p.low), high = number_text(p.high);
  if (has_low && has_high) return (p.low_open ? " in (" : " in [") + low + ", " + high + "]";
  if (has_low) return (p.low_open ? " greater than " : " at least ") + low;
  if (has_high) return " at most " + high;
  return "";
}

/// Count of components a type asks for; nothing when any count will do.
std::optional<std::size_t> component_count(ParamType type) {
  switch (type) {
    case ParamType::Resolution:
      return 2;
    case ParamType::Point:
    case ParamType::Vector:
    case ParamType::Color:
      return 3;
    default:
      return std::nullopt;
  }
}

bool in_range(const Param& p, double v) {
  return std::isfinite(v) && v <= p.high && (p.low_open ? v > p.low : v >= p.low);
}

/// Right type and range, once "auto" is dealt with.
bool acceptable(const Param& p, const Value& value) {
  switch (p.type) {
    case ParamType::Bool:
      return std::holds_alternative<bool>(value);
    case ParamType::Int: {
      const auto* v = std::get_if<std::int64_t>(&value);
      return v && in_range(p, static_cast<double>(*v));
    }
    case ParamType::Number: {
      const auto* v = std::get_if<double>(&value);
      return v && in_range(p, *v);
    }
    case ParamType::Text:
    case ParamType::Grid:
      return std::holds_alternative<std::string>(value);
    case ParamType::File: {
      const auto* v = std::get_if<std::string>(&value);
      return v && !(p.required && v->empty());
    }
    case ParamType::SettingList: {
      const auto* v = std::get_if<Settings>(&value);
      if (!v) return false;
      std::set<std::string> paths{""};
      return std::all_of(v->begin(), v->end(), [&](const Setting& s) { return paths.insert(s.path).second; });
    }
    case ParamType::Choice: {
      const auto* v = std::get_if<std::string>(&value);
      return v && std::any_of(p.choices.begin(), p.choices.end(), [&](const Choice& c) { return c.key == *v; });
    }
    default:
      break;
  }
  const auto* v = std::get_if<Numbers>(&value);
  if (!v || !std::all_of(v->begin(), v->end(), [&](double x) { return in_range(p, x); })) return false;
  if (p.type == ParamType::Matrix) return v->empty() || v->size() == 16;
  if (p.type == ParamType::Resolution &&
      !std::all_of(v->begin(), v->end(), [](double x) { return x == std::floor(x); }))
    return false;
  const auto count = component_count(p.type);
  return !count || v->size() == *count;
}

std::string_view trim(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
  return s;
}

std::optional<double> parse_number(std::string_view s) {
  s = trim(s);
  if (s.starts_with('+') && !s.starts_with("+-")) s.remove_prefix(1);
  double v = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), v);
  if (error != std::errc() || end != s.data() + s.size()) return std::nullopt;
  return v;
}

std::optional<Numbers> parse_numbers(std::string_view s) {
  s = trim(s);
  if (s.starts_with('[') && s.ends_with(']')) s = trim(s.substr(1, s.size() - 2));
  Numbers list;
  if (s.empty()) return list;
  while (true) {
    const auto comma = s.find(',');
    const auto v = parse_number(s.substr(0, comma));
    if (!v) return std::nullopt;
    list.push_back(*v);
    if (comma == std::string_view::npos) return list;
    s = s.substr(comma + 1);
  }
}

/// "render.step_size=0.1; render.bounces=2"
std::optional<Settings> parse_settings(std::string_view s) {
  Settings settings;
  while (!trim(s).empty()) {
    const auto end = std::min(s.find(';'), s.size());
    const std::string_view one = s.substr(0, end);
    const auto equals = one.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    settings.push_back({std::string(trim(one.substr(0, equals))), std::string(trim(one.substr(equals + 1)))});
    s = s.substr(std::min(end + 1, s.size()));
  }
  return settings;
}

/// Edits (insert, delete, replace, swap of neighbours) that turn a into b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string lower_case(std::string_view s) {
  std::string lower(s);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

std::string expectation(const Param& p) {
  std::string text;
  switch (p.type) {
    case ParamType::Bool:
      text = "true or false";
      break;
    case ParamType::Int:
      text = "a whole number" + range_text(p);
      break;
    case ParamType::Number:
      text = "a number" + range_text(p);
      break;
    case ParamType::Text:
      text = "a text";
      break;
    case ParamType::Grid:
      text = "the name of a grid in the file";
      break;
    case ParamType::File:
      text = "the path of a file";
      break;
    case ParamType::Choice: {
      std::vector<std::string> keys;
      for (const Choice& c : p.choices) keys.push_back(c.key);
      text = "one of " + join(keys);
      break;
    }
    case ParamType::Resolution:
      text = "two whole numbers" + range_text(p);
      break;
    case ParamType::Point:
    case ParamType::Vector:
      text = "three numbers" + range_text(p);
      break;
    case ParamType::Color:
      text = "three numbers" + range_text(p);
      break;
    case ParamType::NumberList:
      text = "a list of numbers" + range_text(p);
      break;
    case ParamType::Matrix:
      text = "16 numbers (a 4x4 matrix by rows) or an empty list";
      break;
    case ParamType::SettingList:
      text = "settings of parameters, each once, such as render.step_size=0.1";
      break;
  }
  if (p.automatic) text += ", or auto";
  return text;
}

namespace {

Error refusal(const Param& p, std::string_view word, const std::string& found) {
  std::string message = "found " + found + ", expected " + expectation(p);
  std::vector<std::string> keys;
  for (const Choice& c : p.choices) keys.push_back(c.key);
  const auto close = similar_names(word, keys);
  if (!close.empty()) message += "; did you mean " + join(close, " or ") + "?";
  return bad_input(message, {"", 0, 0, p.key});
}

}  // namespace

Result<void> validate(const Param& p, const Value& value) {
  if (std::holds_alternative<Auto>(value) ? p.automatic.has_value() : acceptable(p, value)) return {};
  const std::string found = format_value(value);
  return refusal(p, found, found.empty() ? "nothing" : found);
}

Result<Value> parse_value(const Param& p, std::string_view text) {
  const std::string_view word = trim(text);
  const auto wrong = [&] { return refusal(p, word, "\"" + std::string(text) + "\""); };
  Value value;
  if (p.automatic && word == "auto") {
    value = Auto{};
  } else if (p.type == ParamType::Bool) {
    if (word != "true" && word != "false" && word != "1" && word != "0") return wrong();
    value = word == "true" || word == "1";
  } else if (p.type == ParamType::Int || p.type == ParamType::Number) {
    const auto v = parse_number(word);
    if (!v || !in_range(p, *v)) return wrong();
    if (p.type == ParamType::Int) {
      if (*v != std::floor(*v) || std::abs(*v) > 9e15) return wrong();
      value = static_cast<std::int64_t>(*v);
    } else {
      value = *v;
    }
  } else if (p.type == ParamType::Text || p.type == ParamType::Grid || p.type == ParamType::File ||
             p.type == ParamType::Choice) {
    value = std::string(p.type == ParamType::Choice ? word : text);
  } else if (p.type == ParamType::SettingList) {
    auto settings = parse_settings(word);
    if (!settings) return wrong();
    value = std::move(*settings);
  } else if (p.type == ParamType::Resolution && word.find('x') != std::string_view::npos) {
    const auto x = word.find('x');
    const auto width = parse_number(word.substr(0, x)), height = parse_number(word.substr(x + 1));
    if (!width || !height) return wrong();
    value = Numbers{*width, *height};
  } else {
    auto list = parse_numbers(word);
    if (!list) return wrong();
    // One number for a colour or a scale means the same in all three.
    if (list->size() == 1 && (p.type == ParamType::Color || p.type == ParamType::Vector))
      list->resize(3, list->front());
    value = std::move(*list);
  }
  if (const auto ok = validate(p, value); !ok) return wrong();
  return value;
}

std::string format_value(const Value& value) {
  struct Format {
    std::string operator()(Auto) const { return "auto"; }
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return std::to_string(v); }
    std::string operator()(double v) const { return number_text(v); }
    std::string operator()(const std::string& v) const { return v; }
    std::string operator()(const Numbers& v) const {
      std::vector<std::string> parts;
      for (double x : v) parts.push_back(number_text(x));
      return "[" + join(parts) + "]";
    }
    std::string operator()(const Settings& v) const {
      std::vector<std::string> parts;
      for (const Setting& s : v) parts.push_back(s.path + "=" + s.value);
      return join(parts, "; ");
    }
  };
  return std::visit(Format{}, value);
}

std::vector<std::string> similar_names(std::string_view wrong, const std::vector<std::string>& names) {
  const std::string word = lower_case(wrong);
  std::vector<std::pair<std::size_t, std::string>> close;
  for (const std::string& original : names) {
    const std::string name = lower_case(original);
    const std::size_t most = std::max(word.size(), name.size()), least = std::min(word.size(), name.size());
    if (most == 0) continue;
    // Fewer than three letters are found in any word.
    const bool contained = least >= 3 && (name.find(word) != std::string::npos || word.find(name) != std::string::npos);
    const std::size_t allowed = std::min(most - 1, std::max<std::size_t>(1, name.size() / 3));
    // The difference in length is a lower bound of the distance, and spares the work on very long words.
    const std::size_t d = most - least <= allowed ? edit_distance(word, name) : most - least;
    if (d <= allowed || contained) close.emplace_back(d, original);
  }
  std::stable_sort(close.begin(), close.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min<std::size_t>(3, close.size()); ++i) out.push_back(close[i].second);
  return out;
}

std::string unknown_name(std::string_view what, std::string_view word, const std::vector<std::string>& valid) {
  std::string message = "unknown " + std::string(what) + " \"" + std::string(word) + "\"";
  const auto close = similar_names(word, valid);
  if (!close.empty()) message += "; did you mean " + join(close, " or ") + "?";
  return message + (valid.empty() ? "; there are none" : " (valid: " + join(valid) + ")");
}

std::string join(const std::vector<std::string>& words, std::string_view separator) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += separator;
    text += words[i];
  }
  return text;
}

}  // namespace brume
