#include "renderer/scene_io/write_node.h"

#include "renderer/scene_io/file_paths.h"
#include "renderer/scene_io/json_print.h"
#include "renderer/scene_io/json_tree.h"

namespace brume {
namespace {

constexpr std::string_view kNameKey = "name";

bool is_written(const Param& param, const Value& value, bool all) {
  if (all || param.required || !(value == param.default_value)) return true;
  const auto* text = std::get_if<std::string>(&value);
  return param.key == kNameKey && text && !text->empty();
}

JsonValue param_to_json(const Param& param, const Value& value, const WriteOptions& options) {
  const auto* text = std::get_if<std::string>(&value);
  return param.type == ParamType::File && text ? JsonValue(relative_path(*text, options.target_dir))
                                               : value_to_json(value);
}

}  // namespace

JsonValue value_to_json(const Value& value) {
  struct ToJson {
    JsonValue operator()(Auto) const { return "auto"; }
    JsonValue operator()(bool v) const { return v; }
    JsonValue operator()(std::int64_t v) const { return v; }
    JsonValue operator()(double v) const { return v; }
    JsonValue operator()(const std::string& v) const { return v; }
    JsonValue operator()(const Numbers& v) const { return JsonValue::array({v.begin(), v.end()}); }
    JsonValue operator()(const Settings& v) const {
      JsonValue object = JsonValue::object();
      for (const Setting& s : v) object.add(s.path, setting_value(s.value));
      return object;
    }
    /// A text that is JSON for a truth value, a number or a list stands as that: it is read back as the same text.
    static JsonValue setting_value(const std::string& text) {
      auto json = parse_json(text, "");
      if (!json) return text;
      switch (json->kind) {
        case JsonValue::Kind::Bool:
          return json->boolean;
        case JsonValue::Kind::Number:
          return format_value(json->number) == text ? JsonValue(json->number) : JsonValue(text);
        case JsonValue::Kind::Array: {
          Numbers numbers;
          for (const JsonValue& item : json->items)
            if (item.kind == JsonValue::Kind::Number) numbers.push_back(item.number);
          return format_value(numbers) == text ? value_to_json(numbers) : JsonValue(text);
        }
        default:
          return text;
      }
    }
  };
  return std::visit(ToJson{}, value);
}

JsonValue node_to_json(const Node& node, const Family& family, const WriteOptions& options) {
  JsonValue json = JsonValue::object();
  const ParamTable& table = node.table();
  const auto add_kind = [&] {
    if (!family.type_key.empty()) json.add(family.type_key, node.kind());
  };
  // A name says what the object is: it stands before the kind.
  const bool name_first = !table.params.empty() && table.params.front().key == kNameKey;
  if (!name_first) add_kind();
  for (const Param& p : table.params) {
    if (is_written(p, node.value(p.key), options.all)) json.add(p.key, param_to_json(p, node.value(p.key), options));
    if (name_first && &p == &table.params.front()) add_kind();
  }

  for (const Slot& s : table.slots) {
    if (s.list) {
      JsonValue list = JsonValue::array();
      for (const Node& n : node.list(s.key)) list.items.push_back(node_to_json(n, *s.family, options));
      if (options.all || !list.items.empty()) json.add(s.key, std::move(list));
      continue;
    }
    const Node& child = node.child(s.key);
    JsonValue object = node_to_json(child, *s.family, options);
    const bool only_kind = object.members.size() == (s.family->type_key.empty() ? 0u : 1u);
    const bool default_kind = &child.table() == s.family->tables.front();
    if (options.all || !only_kind || !default_kind) json.add(s.key, std::move(object));
  }
  return json;
}

std::string write_node(const Node& node, const Family& family, const WriteOptions& options) {
  return format_json(node_to_json(node, family, options)) + "\n";
}

}  // namespace brume
