#include "renderer/scene_io/read_node.h"

#include <algorithm>

#include "renderer/scene_io/file_paths.h"
#include "renderer/scene_io/json_print.h"

namespace brume {
namespace {

using Kind = JsonValue::Kind;

bool takes_one_number_for_three(ParamType type) { return type == ParamType::Vector || type == ParamType::Color; }

/// A key or kind of the file as part of a message: no line breaks, not endless.
std::string shown(std::string_view word) {
  const std::string quoted = quote_for_message(word);
  return quoted.substr(1, quoted.size() - 2);
}

/// Reads one tree; knows the way from the root to where it is.
class NodeReader {
 public:
  explicit NodeReader(const ReadContext& context) : context_(context) {}

  Result<Node> read(const JsonValue& json, const Family& family, const std::string& path) const {
    if (json.kind != Kind::Object) return wrong_object(json, family, path);
    const auto table = kind_of(json, family, path);
    if (!table) return table.error();
    Node node(**table);
    for (const JsonMember& member : json.members) {
      if (!family.type_key.empty() && member.key == family.type_key) continue;
      if (auto done = read_member(member, family, path, node); !done) return done.error();
    }
    if (auto done = check_required(json, node.table(), path, json); !done) return done.error();
    return node;
  }

 private:
  Error error_at(const JsonValue& json, const std::string& path, std::string message) const {
    return bad_input(std::move(message), {context_.file, json.line, json.column, path});
  }

  static std::string below(const std::string& path, const std::string& key) {
    return path.empty() ? shown(key) : path + "." + shown(key);
  }

  Error wrong_object(const JsonValue& json, const Family& family, const std::string& path) const {
    std::string expected = "an object in braces";
    if (!family.type_key.empty()) {
      const bool names_a_kind = json.kind == Kind::Text && family.find(json.text);
      const std::string& kind = names_a_kind ? json.text : family.tables.front()->key;
      expected += ", such as {" + quote_json(family.type_key) + ": " + quote_json(kind) + "}";
    }
    return error_at(json, path, "found " + describe(json) + ", expected " + expected);
  }

  Result<const ParamTable*> kind_of(const JsonValue& json, const Family& family, const std::string& path) const {
    const JsonMember* type = family.type_key.empty() ? nullptr : json.find(family.type_key);
    if (!type) return family.tables.front();
    const std::string type_path = below(path, family.type_key);
    if (type->value.kind != Kind::Text)
      return error_at(type->value, type_path,
                      "found " + describe(type->value) + ", expected one of " + join(family.kinds()));
    const ParamTable* table = family.find(type->value.text);
    if (!table)
      return error_at(type->value, type_path, unknown_name(family.noun, shown(type->value.text), family.kinds()));
    return table;
  }

  Result<void> read_member(const JsonMember& member, const Family& family, const std::string& path, Node& node) const {
    const std::string member_path = below(path, member.key);
    if (const Param* param = node.table().find(member.key)) {
      auto value = read_value(*param, member.value, member_path);
      if (!value) return value.error();
      if (auto done = node.set(param->key, std::move(*value)); !done)
        return error_at(member.value, member_path, done.error().message);
      return {};
    }
    if (const Slot* slot = node.table().find_slot(member.key)) return read_slot(*slot, member.value, member_path, node);
    return unknown_key(member, family, node.table(), member_path);
  }

  Result<void> read_slot(const Slot& slot, const JsonValue& json, const std::string& path, Node& node) const {
    if (!slot.list) {
      auto child = read(json, *slot.family, path);
      if (!child) return child.error();
      node.child(slot.key) = std::move(*child);
      return {};
    }
    if (json.kind != Kind::Array)
      return error_at(json, path, "found " + describe(json) + ", expected a list of objects in square brackets");
    for (std::size_t i = 0; i < json.items.size(); ++i) {
      auto element = read(json.items[i], *slot.family, path + "[" + std::to_string(i) + "]");
      if (!element) return element.error();
      node.list(slot.key).push_back(std::move(*element));
    }
    return {};
  }

  Error unknown_key(const JsonMember& member, const Family& family, const ParamTable& table,
                    const std::string& path) const {
    std::vector<std::string> valid;
    if (!family.type_key.empty()) valid.push_back(family.type_key);
    for (const Param& p : table.params) valid.push_back(p.key);
    for (const Slot& s : table.slots) valid.push_back(s.key);

    std::vector<std::string> other_kinds;
    for (const ParamTable* t : family.tables)
      if (t->find(member.key) || t->find_slot(member.key)) other_kinds.push_back(t->key);
    std::string message = unknown_name("key", shown(member.key), valid);
    if (!other_kinds.empty())
      message += "; this is a " + table.key + " " + family.noun + ", and that key belongs to " + join(other_kinds);
    return bad_input(std::move(message), {context_.file, member.line, member.column, path});
  }

  /// `where` is the object that should have held the parameter: the last one that is in the file.
  Result<void> check_required(const JsonValue& json, const ParamTable& table, const std::string& path,
                              const JsonValue& where) const {
    for (const Param& p : table.params)
      if (p.required && !json.find(p.key))
        return error_at(where, below(path, p.key), quote_json(p.key) + " is missing, expected " + expectation(p));
    for (const Slot& s : table.slots) {
      if (s.list || json.find(s.key)) continue;
      const auto done = check_required(JsonValue::object(), *s.family->tables.front(), below(path, s.key), where);
      if (!done) return done;
    }
    return {};
  }

  Result<Value> read_value(const Param& param, const JsonValue& json, const std::string& path) const {
    const auto wrong = [&] {
      return error_at(json, path, "found " + describe(json) + ", expected " + expectation(param));
    };
    if (param.automatic && json.kind == Kind::Text && json.text == "auto") return Value(Auto{});
    switch (param.type) {
      case ParamType::Bool:
        if (json.kind != Kind::Bool) return wrong();
        return Value(json.boolean);
      case ParamType::Int:
        if (json.kind != Kind::Number || !json.integer) return wrong();
        return Value(*json.integer);
      case ParamType::Number:
        if (json.kind != Kind::Number) return wrong();
        return Value(json.number);
      case ParamType::Text:
      case ParamType::Grid:
      case ParamType::Choice:
        if (json.kind != Kind::Text) return wrong();
        return Value(json.text);
      case ParamType::File:
        if (json.kind != Kind::Text || json.text.find('\0') != std::string::npos) return wrong();
        return Value(absolute_path(json.text, context_.base_dir));
      case ParamType::SettingList:
        return read_settings(param, json, path);
      default:
        return read_numbers(param, json, path);
    }
  }

  /// {"render.step_size": 0.1, "render.integrator": "ray_march"}: values as they would stand at their own place.
  Result<Value> read_settings(const Param& param, const JsonValue& json, const std::string& path) const {
    if (json.kind != Kind::Object)
      return error_at(json, path, "found " + describe(json) + ", expected " + expectation(param));
    Settings settings;
    for (const JsonMember& member : json.members) {
      const auto text = setting_text(member.value);
      if (!text)
        return error_at(member.value, below(path, member.key),
                        "found " + describe(member.value) + ", expected the value of a parameter");
      settings.push_back({member.key, *text});
    }
    return Value(std::move(settings));
  }

  static std::optional<std::string> setting_text(const JsonValue& json) {
    if (json.kind == Kind::Text) return json.text;
    if (json.kind == Kind::Bool) return format_value(json.boolean);
    if (json.kind == Kind::Number) return format_value(json.number);
    if (json.kind != Kind::Array) return std::nullopt;
    Numbers numbers;
    for (const JsonValue& item : json.items) {
      if (item.kind != Kind::Number) return std::nullopt;
      numbers.push_back(item.number);
    }
    return format_value(numbers);
  }

  Result<Value> read_numbers(const Param& param, const JsonValue& json, const std::string& path) const {
    if (json.kind == Kind::Number && takes_one_number_for_three(param.type)) return Value(Numbers(3, json.number));
    if (json.kind != Kind::Array)
      return error_at(json, path, "found " + describe(json) + ", expected " + expectation(param));
    Numbers numbers;
    for (const JsonValue& item : json.items) {
      if (item.kind != Kind::Number)
        return error_at(item, path, "found " + describe(item) + " in the list, expected " + expectation(param));
      numbers.push_back(item.number);
    }
    return Value(std::move(numbers));
  }

  const ReadContext& context_;
};

}  // namespace

Result<Node> read_node(const JsonValue& json, const Family& family, const ReadContext& context) {
  return NodeReader(context).read(json, family, "");
}

}  // namespace brume
