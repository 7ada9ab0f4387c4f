#include "renderer/scene_io/json_schema.h"

#include <cmath>
#include <map>

#include "renderer/scene_io/families.h"
#include "renderer/scene_io/json_print.h"
#include "renderer/scene_io/scene_format.h"
#include "renderer/scene_io/write_node.h"

namespace brume {
namespace {

JsonValue object_with(std::string key, JsonValue value) {
  return JsonValue::object().add(std::move(key), std::move(value));
}

/// A number or, in a list, one of its components.
JsonValue number_schema(const Param& p, bool whole) {
  JsonValue schema = object_with("type", whole ? "integer" : "number");
  if (std::isfinite(p.low)) schema.add(p.low_open ? "exclusiveMinimum" : "minimum", p.low);
  if (std::isfinite(p.high)) schema.add("maximum", p.high);
  return schema;
}

JsonValue list_schema(JsonValue items) { return object_with("type", "array").add("items", std::move(items)); }

JsonValue list_schema(JsonValue items, int count) {
  return list_schema(std::move(items)).add("minItems", count).add("maxItems", count);
}

JsonValue any_of(std::vector<JsonValue> options) { return object_with("anyOf", JsonValue::array(std::move(options))); }

JsonValue with_texts(JsonValue schema, const std::string& title, const std::string& description) {
  if (!title.empty()) schema.add("title", title);
  if (!description.empty()) schema.add("description", description);
  return schema;
}

JsonValue choices_schema(const Param& p) {
  JsonValue options = JsonValue::array();
  for (const Choice& c : p.choices) options.items.push_back(with_texts(object_with("const", c.key), c.label, c.doc));
  return object_with("oneOf", std::move(options));
}

JsonValue type_schema(const Param& p) {
  switch (p.type) {
    case ParamType::Bool:
      return object_with("type", "boolean");
    case ParamType::Int:
      return number_schema(p, true);
    case ParamType::Number:
      return number_schema(p, false);
    case ParamType::Text:
    case ParamType::Grid:
      return object_with("type", "string");
    case ParamType::File: {
      JsonValue schema = object_with("type", "string");
      if (p.required) schema.add("minLength", 1);
      return schema;
    }
    case ParamType::Choice:
      return choices_schema(p);
    case ParamType::Resolution:
      return list_schema(number_schema(p, true), 2);
    case ParamType::Point:
      return list_schema(number_schema(p, false), 3);
    case ParamType::Vector:
    case ParamType::Color:
      return any_of({list_schema(number_schema(p, false), 3), number_schema(p, false)});
    case ParamType::NumberList:
      return list_schema(number_schema(p, false));
    case ParamType::Matrix:
      return any_of({list_schema(number_schema(p, false), 16), list_schema(JsonValue::object(), 0)});
    case ParamType::SettingList:
      return object_with("type", "object");
  }
  return JsonValue::object();
}

JsonValue param_schema(const Param& p) {
  JsonValue schema = type_schema(p);
  std::string description = p.doc;
  if (!p.unit.empty()) description += (description.empty() ? "Unit: " : " Unit: ") + p.unit + ".";
  if (p.automatic) {
    schema = any_of({object_with("const", "auto").add("description", "Chosen by the program: " + *p.automatic + "."),
                     std::move(schema)});
  }
  schema = with_texts(std::move(schema), p.label, description);
  if (!p.required) schema.add("default", value_to_json(p.default_value));
  return schema;
}

/// Writes the definitions: a family is called by its noun, a kind by noun.kind.
class SchemaWriter {
 public:
  explicit SchemaWriter(const Family& root) {
    std::map<std::string, int> uses;
    for (const Family* f : reachable_families(root)) {
      std::string name;
      for (char c : f->noun) name += c == ' ' || c == '/' || c == '~' || c == '%' || c == '#' ? '_' : c;
      // Two families may share a noun.
      if (const int earlier = uses[name]++; earlier > 0) name += std::to_string(earlier + 1);
      names_[f] = name;
    }
  }

  JsonValue reference(const Family& f) const { return object_with("$ref", "#/$defs/" + names_.at(&f)); }

  void add_definitions(const Family& f, JsonValue& definitions) const {
    const std::string& name = names_.at(&f);
    if (f.type_key.empty()) {
      definitions.add(name, kind_schema(f, *f.tables.front()));
      return;
    }
    JsonValue kinds = JsonValue::array(), branches = JsonValue::array();
    for (const ParamTable* t : f.tables) {
      kinds.items.push_back(with_texts(object_with("const", t->key), t->label, t->doc));
      const bool is_default = t == f.tables.front();
      JsonValue condition = object_with("properties", object_with(f.type_key, object_with("const", t->key)));
      if (!is_default) condition.add("required", JsonValue::array({f.type_key}));
      branches.items.push_back(
          object_with("if", std::move(condition)).add("then", object_with("$ref", "#/$defs/" + name + "." + t->key)));
    }
    JsonValue type = object_with("oneOf", std::move(kinds)).add("default", f.tables.front()->key);
    definitions.add(name, object_with("type", "object")
                              .add("properties", object_with(f.type_key, std::move(type)))
                              .add("allOf", std::move(branches)));
    for (const ParamTable* t : f.tables) definitions.add(name + "." + t->key, kind_schema(f, *t));
  }

  JsonValue kind_schema(const Family& f, const ParamTable& t) const {
    JsonValue properties = JsonValue::object(), required = JsonValue::array();
    if (!f.type_key.empty()) properties.add(f.type_key, JsonValue::object());  // checked where the kind was chosen
    for (const Param& p : t.params) {
      properties.add(p.key, param_schema(p));
      if (p.required) required.items.emplace_back(p.key);
    }
    for (const Slot& s : t.slots) {
      // In a schema that has other keywords beside $ref, these describe the slot instead of what it holds.
      JsonValue schema = s.list ? list_schema(reference(*s.family)) : reference(*s.family);
      properties.add(s.key, with_texts(std::move(schema), s.label, s.doc));
      if (!s.list && needs_content(*s.family)) required.items.emplace_back(s.key);
    }
    JsonValue schema = with_texts(object_with("type", "object"), t.label, t.doc);
    schema.add("properties", std::move(properties));
    if (!required.items.empty()) schema.add("required", std::move(required));
    return schema.add("additionalProperties", false);
  }

 private:
  /// Whether an object of the family cannot be left out, since something in it is required.
  static bool needs_content(const Family& f) {
    for (const Param& p : f.tables.front()->params)
      if (p.required) return true;
    for (const Slot& s : f.tables.front()->slots)
      if (!s.list && needs_content(*s.family)) return true;
    return false;
  }

  std::map<const Family*, std::string> names_;
};

/// The root object is special: it carries the version.
JsonValue with_format(JsonValue root) {
  for (JsonMember& m : root.members) {
    if (m.key == "properties") {
      JsonMember format{kSceneFormatKey,
                        with_texts(object_with("const", kSceneFormat), "Format", "Version of the scene format.")};
      m.value.members.insert(m.value.members.begin(), std::move(format));
    }
  }
  for (JsonMember& m : root.members) {
    if (m.key != "required") continue;
    m.value.items.insert(m.value.items.begin(), kSceneFormatKey);
    return root;
  }
  root.add("required", JsonValue::array({kSceneFormatKey}));
  return root;
}

}  // namespace

std::string json_schema(const Family& root) {
  const SchemaWriter writer(root);
  JsonValue schema = object_with("$schema", "https://json-schema.org/draft/2020-12/schema");
  for (JsonMember& m : with_format(writer.kind_schema(root, *root.tables.front())).members)
    schema.members.push_back(std::move(m));
  JsonValue definitions = JsonValue::object();
  for (const Family* f : reachable_families(root))
    if (f != &root) writer.add_definitions(*f, definitions);
  schema.add("$defs", std::move(definitions));
  return format_json(schema, true) + "\n";
}

}  // namespace brume
