// Parameter tables: data about data. Scene files, --set, widgets, tooltips, JSON Schema, the reference page and undo
// all follow from them, so nothing about a parameter is said twice.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "renderer/core/error.h"

namespace brume {

/// "auto" in a scene file: the program chooses, as Param::automatic says.
struct Auto {
  bool operator==(const Auto&) const = default;
};

using Numbers = std::vector<double>;

/// One parameter of a scene set to another value, both as --set takes them: "render.step_size", "0.1".
struct Setting {
  std::string path, value;
  bool operator==(const Setting&) const = default;
};
using Settings = std::vector<Setting>;

using Value = std::variant<Auto, bool, std::int64_t, double, std::string, Numbers, Settings>;

enum class ParamType {
  Bool,
  Int,
  Number,
  Text,
  File,         ///< text: a path, absolute or relative to the scene file
  Grid,         ///< text: name of a grid in the file that the same object's "file" names; empty for none
  Choice,       ///< text: one of Param::choices
  Resolution,   ///< two whole numbers
  Point,        ///< three numbers, world units
  Vector,       ///< three numbers
  Color,        ///< three linear values
  NumberList,   ///< any count of numbers
  Matrix,       ///< 16 numbers by rows (a 4x4 affine matrix), or none
  SettingList,  ///< settings of other parameters, each named by its path from the root
};

/// How much of the work done so far a change throws away.
enum class Affects {
  Display,       ///< nothing: only how the picture is shown
  Accumulation,  ///< the picture restarts
  Geometry,      ///< files are read or grids rebuilt, then the picture restarts
};

struct Choice {
  std::string key, label, doc;
};

/// One parameter. Made by the functions below and refined by chaining: number("g", "Mean cosine", 0).between(-1, 1)...
struct Param {
  std::string key;
  std::string label;
  ParamType type;
  Value default_value;
  Value manual_value;  ///< what a widget starts from when it leaves "auto"; the default where that is not "auto"
  double low = -std::numeric_limits<double>::infinity();  ///< hard range of every component, ends included ...
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;                   ///< ... except that the low end may be excluded
  double slider_low = 0, slider_high = 1;  ///< range of the widget; typing reaches the whole hard range
  bool logarithmic = false;                ///< the widget moves by ratios
  std::string unit;
  std::string doc;                       ///< one sentence
  std::optional<std::string> automatic;  ///< set when "auto" is allowed: what it does
  std::vector<Choice> choices;
  bool required = false;  ///< a scene file must give it
  Affects affects = Affects::Accumulation;

  Param&& between(double lo, double hi) &&;
  Param&& at_least(double lo) &&;
  Param&& more_than(double lo) &&;
  Param&& slider(double lo, double hi) &&;
  Param&& log_slider(double lo, double hi) &&;
  Param&& in(std::string unit_) &&;
  Param&& says(std::string doc_) &&;
  Param&& or_auto(std::string what_it_does) &&;
  Param&& auto_by_default(std::string what_it_does) &&;
  Param&& must_be_given() &&;
  Param&& costs(Affects a) &&;
};

namespace param {

Param flag(std::string key, std::string label, bool value);
Param integer(std::string key, std::string label, std::int64_t value);
Param number(std::string key, std::string label, double value);
Param text(std::string key, std::string label, std::string value = "");
Param file(std::string key, std::string label);
Param grid(std::string key, std::string label, std::string value = "");
Param choice(std::string key, std::string label, std::string value, std::vector<Choice> choices);
Param resolution(std::string key, std::string label, int width, int height);
Param point(std::string key, std::string label, double x, double y, double z);
Param vector(std::string key, std::string label, double x, double y, double z);
Param color(std::string key, std::string label, double r, double g, double b);
Param numbers(std::string key, std::string label, Numbers value);
Param matrix(std::string key, std::string label);
Param settings(std::string key, std::string label);

}  // namespace param

/// What is accepted, in words: "a number greater than 0", "one of density, equi_angular, mis".
std::string expectation(const Param& param);

/// Type and range. The error says what was found and what was expected; its source names only the key.
Result<void> validate(const Param& param, const Value& value);

/// Reads what a person types: 0.3, true, auto, mis, 1,2,3 or [1, 2, 3], a.b=1; c.d=2. Validates.
Result<Value> parse_value(const Param& param, std::string_view text);

/// A short text that parse_value reads back as the same value. Numbers have the fewest digits that do; whole ones below
/// 1e15 are written out ("100000", not "1e+05").
std::string format_value(const Value& value);

/// Up to three of `names` that resemble `wrong`, best first; for "did you mean".
std::vector<std::string> similar_names(std::string_view wrong, const std::vector<std::string>& names);

/// 'unknown light "pont"; did you mean point? (valid: point, quad)'
/// @param what  "light", "key"
std::string unknown_name(std::string_view what, std::string_view word, const std::vector<std::string>& valid);

/// "a, b, c"
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ");

}  // namespace brume
