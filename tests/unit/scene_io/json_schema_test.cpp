#include "renderer/scene_io/json_schema.h"

#include <gtest/gtest.h>

#include "renderer/scene_io/families.h"
#include "renderer/scene_io/json_tree.h"
#include "tests/unit/scene_io/test_tables.h"

namespace brume {
namespace {

using Kind = JsonValue::Kind;

JsonValue schema_of(const Family& root) {
  const auto json = parse_json(json_schema(root), "schema.json");
  EXPECT_TRUE(json.ok()) << json.error().to_string();
  return json ? *json : JsonValue();
}

/// The value behind keys, which must be there.
const JsonValue& at(const JsonValue& v, std::initializer_list<const char*> keys) {
  static const JsonValue none;
  const JsonValue* place = &v;
  for (const char* key : keys) {
    const JsonMember* m = place->find(key);
    EXPECT_NE(m, nullptr) << key;
    if (!m) return none;
    place = &m->value;
  }
  return *place;
}

void collect_references(const JsonValue& v, std::vector<std::string>& out) {
  for (const JsonValue& item : v.items) collect_references(item, out);
  for (const JsonMember& m : v.members) {
    if (m.key == "$ref") out.push_back(m.value.text);
    collect_references(m.value, out);
  }
}

TEST(JsonSchema, SaysWhichDraftItFollows) {
  EXPECT_EQ(at(schema_of(test_tables::studio_family()), {"$schema"}).text,
            "https://json-schema.org/draft/2020-12/schema");
}

TEST(JsonSchema, HoldsEveryKeyOfEveryKind) {
  const JsonValue schema = schema_of(test_tables::studio_family());
  for (const Family* f : reachable_families(test_tables::studio_family())) {
    for (const ParamTable* t : f->tables) {
      std::string name = f->noun == "phase function" ? "phase_function" : f->noun;
      if (!f->type_key.empty()) name += "." + t->key;
      const JsonValue& kind = f == &test_tables::studio_family() ? schema : at(schema, {"$defs", name.c_str()});
      EXPECT_EQ(at(kind, {"additionalProperties"}).kind, Kind::Bool);
      EXPECT_FALSE(at(kind, {"additionalProperties"}).boolean);
      for (const Param& p : t->params) at(kind, {"properties", p.key.c_str()});
      for (const Slot& s : t->slots) at(kind, {"properties", s.key.c_str()});
    }
  }
}

TEST(JsonSchema, AsksForTheFormatVersion) {
  const JsonValue schema = schema_of(test_tables::studio_family());
  EXPECT_EQ(at(schema, {"properties", "brume", "const"}).integer, 1);
  ASSERT_EQ(at(schema, {"required"}).items.size(), 1u);
  EXPECT_EQ(at(schema, {"required"}).items[0].text, "brume");
}

TEST(JsonSchema, EveryReferenceLeadsToADefinition) {
  const JsonValue schema = schema_of(test_tables::studio_family());
  std::vector<std::string> references;
  collect_references(schema, references);
  EXPECT_GE(references.size(), 8u);
  for (const std::string& r : references) {
    ASSERT_TRUE(r.starts_with("#/$defs/")) << r;
    EXPECT_NE(at(schema, {"$defs"}).find(r.substr(8)), nullptr) << r;
  }
}

TEST(JsonSchema, SaysRangesUnitsChoicesAndDefaults) {
  const JsonValue schema = schema_of(test_tables::studio_family());
  const JsonValue& vdb = at(schema, {"$defs", "volume.vdb"});
  EXPECT_EQ(at(vdb, {"required"}).items.at(0).text, "file");
  EXPECT_EQ(at(vdb, {"properties", "file", "minLength"}).integer, 1);
  EXPECT_EQ(at(vdb, {"properties", "density_scale", "minimum"}).integer, 0);
  const JsonValue& step = at(vdb, {"properties", "step"});
  EXPECT_EQ(at(step, {"anyOf"}).items.at(0).find("const")->value.text, "auto");
  EXPECT_EQ(at(step, {"anyOf"}).items.at(1).find("exclusiveMinimum")->value.integer, 0);
  EXPECT_NE(at(step, {"description"}).text.find("world units"), std::string::npos);
  EXPECT_EQ(at(step, {"default"}).text, "auto");
  const JsonValue& sampling = at(vdb, {"properties", "sampling"});
  ASSERT_EQ(at(sampling, {"oneOf"}).items.size(), 3u);
  EXPECT_EQ(at(sampling, {"oneOf"}).items[0].find("const")->value.text, "density");
  EXPECT_EQ(at(sampling, {"oneOf"}).items[0].find("description")->value.text, "dense | thick");
  EXPECT_EQ(at(vdb, {"properties", "albedo", "default"}).items.size(), 3u);
  EXPECT_EQ(at(schema, {"properties", "lights", "type"}).text, "array");
  EXPECT_EQ(at(schema, {"properties", "lights", "items", "$ref"}).text, "#/$defs/light");
}

TEST(JsonSchema, OnlyTheFirstKindMayLeaveItsTypeOut) {
  const JsonValue schema = schema_of(test_tables::studio_family());
  const JsonValue& branches = at(schema, {"$defs", "light", "allOf"});
  ASSERT_EQ(branches.items.size(), 2u);
  EXPECT_EQ(at(branches.items[0], {"if"}).find("required"), nullptr);
  EXPECT_NE(at(branches.items[1], {"if"}).find("required"), nullptr);
}

TEST(JsonSchema, FamiliesThatShareANounStayApart) {
  static const ParamTable one{"a", "A", "", {param::flag("first", "First", true)}, {}};
  static const ParamTable two{"b", "B", "", {param::flag("second", "Second", true)}, {}};
  static const Family first{"thing", "", {&one}}, second{"thing", "", {&two}};
  static const ParamTable root{"root", "Root", "", {}, {{"x", "X", "", &first}, {"y", "Y", "", &second}}};
  static const Family family{"root", "", {&root}};
  const JsonValue schema = schema_of(family);
  EXPECT_EQ(at(schema, {"properties", "x", "$ref"}).text, "#/$defs/thing");
  EXPECT_EQ(at(schema, {"properties", "y", "$ref"}).text, "#/$defs/thing2");
  at(schema, {"$defs", "thing2", "properties", "second"});
}

}  // namespace
}  // namespace brume
