#include "renderer/params/node.h"

#include <gtest/gtest.h>

namespace brume {
namespace {

const Family& shape_family() {
  static const ParamTable box{
      "box", "Box", "", {param::point("min", "Min", -1, -1, -1), param::number("size", "Size", 1)}, {}};
  static const ParamTable ball{"ball", "Ball", "", {param::number("size", "Size", 2).more_than(0)}, {}};
  static const Family family{"shape", "type", {&box, &ball}};
  return family;
}

const Family& lamp_family() {
  static const ParamTable bulb{"bulb",
                               "Bulb",
                               "",
                               {param::text("name", "Name"), param::color("power", "Power", 1, 1, 1),
                                param::number("reach", "Reach", 5).auto_by_default("the room")},
                               {{"shape", "Shape", "", &shape_family()}}};
  static const ParamTable tube{
      "tube",
      "Tube",
      "",
      {param::text("name", "Name"), param::color("power", "Power", 2, 2, 2), param::text("reach", "Reach", "far"),
       param::integer("count", "Count", 1).between(1, 9)},
      {{"shape", "Shape", "", &shape_family()}}};
  static const Family family{"lamp", "kind", {&bulb, &tube}};
  return family;
}

const ParamTable& room_table() {
  static const ParamTable table{"room",
                                "Room",
                                "",
                                {param::number("height", "Height", 3).more_than(0)},
                                {{"hull", "Hull", "", &shape_family()}, {"lamps", "Lamps", "", &lamp_family(), true}}};
  return table;
}

/// A room with lamps called "key", "", "a.b" and "a".
Node room() {
  Node n(room_table());
  for (const char* name : {"key", "", "a.b", "a"}) {
    n.list("lamps").emplace_back(*lamp_family().tables[0]);
    EXPECT_TRUE(n.list("lamps").back().set("name", std::string(name)).ok());
  }
  return n;
}

std::string message(const Result<void>& result) { return result.ok() ? "no error" : result.error().message; }

TEST(Node, BeginsWithDefaults) {
  const Node n(*lamp_family().tables[0]);
  EXPECT_EQ(n.text("name"), "");
  EXPECT_EQ(n.numbers("power"), (Numbers{1, 1, 1}));
  EXPECT_TRUE(n.is_auto("reach"));
  EXPECT_EQ(n.child("shape").kind(), "box");
  EXPECT_TRUE(Node(room_table()).list("lamps").empty());
}

TEST(Node, ReadsValuesByType) {
  Node n(*lamp_family().tables[1]);
  ASSERT_TRUE(n.set("count", std::int64_t{4}).ok());
  EXPECT_EQ(n.integer("count"), 4);
  EXPECT_EQ(n.vec3("power").z, 2);
  EXPECT_EQ(n.color("power").g, 2.0f);
}

TEST(Node, RefusedValuesChangeNothing) {
  Node n = room();
  const Node before = n;
  EXPECT_FALSE(n.set("height", 0.0).ok());
  EXPECT_FALSE(n.set("height", std::string("tall")).ok());
  EXPECT_FALSE(n.set("height", Auto{}).ok());
  EXPECT_EQ(n, before);
}

TEST(Node, CopiesAreDeep) {
  const Node a = room();
  Node b = a;
  EXPECT_EQ(a, b);
  ASSERT_TRUE(b.list("lamps")[0].child("shape").set("size", 7.0).ok());
  EXPECT_NE(a, b);
  EXPECT_EQ(a.list("lamps")[0].child("shape").number("size"), 1);
}

TEST(Node, ConversionKeepsWhatBothKindsKnow) {
  Node bulb(*lamp_family().tables[0]);
  ASSERT_TRUE(bulb.set("name", std::string("n")).ok());
  ASSERT_TRUE(bulb.set("power", Numbers{5, 6, 7}).ok());
  ASSERT_TRUE(bulb.set("reach", 9.0).ok());
  bulb.child("shape") = Node(*shape_family().tables[1]);
  const Node tube = bulb.converted_to(*lamp_family().tables[1]);
  EXPECT_EQ(tube.kind(), "tube");
  EXPECT_EQ(tube.text("name"), "n");
  EXPECT_EQ(tube.numbers("power"), (Numbers{5, 6, 7}));
  EXPECT_EQ(tube.text("reach"), "far");  // another type under the same key
  EXPECT_EQ(tube.integer("count"), 1);
  EXPECT_EQ(tube.child("shape").kind(), "ball");
}

TEST(Node, ConversionDropsWhatTheNewKindWouldRefuse) {
  Node box(*shape_family().tables[0]);
  ASSERT_TRUE(box.set("size", -3.0).ok());
  EXPECT_EQ(box.converted_to(*shape_family().tables[1]).number("size"), 2);
}

TEST(ParamPath, LeadsToParameters) {
  Node n = room();
  EXPECT_EQ(find_param(n, "height")->node, &n);
  EXPECT_EQ(find_param(n, "hull.min")->node, &n.child("hull"));
  EXPECT_EQ(find_param(n, "lamps.key.power")->node, &n.list("lamps")[0]);
  EXPECT_EQ(find_param(n, "lamps.0.power")->node, &n.list("lamps")[0]);
  EXPECT_EQ(find_param(n, "lamps.1.shape.size")->node, &n.list("lamps")[1].child("shape"));
  EXPECT_EQ(find_param(n, "lamps.1.shape.size")->param->key, "size");
}

TEST(ParamPath, NamesMayHoldDots) {
  Node n = room();
  EXPECT_EQ(find_param(n, "lamps.a.b.power")->node, &n.list("lamps")[2]);
  EXPECT_EQ(find_param(n, "lamps.a.power")->node, &n.list("lamps")[3]);
}

TEST(ParamPath, ErrorsSayWhatIsValid) {
  Node n = room();
  const auto error = [&](const char* path) {
    const auto found = find_param(n, path);
    if (found.ok()) return std::string("no error");
    EXPECT_EQ(found.error().source.key, path);
    return found.error().message;
  };
  EXPECT_EQ(error("hight"), "unknown key \"hight\"; did you mean height? (valid: height, hull, lamps)");
  EXPECT_EQ(error(""), "unknown key \"\" (valid: height, hull, lamps)");
  EXPECT_EQ(error("hulk.min"), "unknown key \"hulk\"; did you mean hull? (valid: height, hull, lamps)");
  EXPECT_EQ(error("hull.mini"), "unknown key \"mini\"; did you mean min? (valid: type, min, size)");
  EXPECT_EQ(error("height.x"), "found more behind the parameter \"height\", expected the path to end there");
  EXPECT_EQ(error("hull"), "found a whole shape, expected one of its keys: type, min, size");
  EXPECT_EQ(error("lamps"), "found a whole list, expected one of its keys: key, 1, a.b, a");
  EXPECT_EQ(error("lamps.key"), "found a whole lamp, expected one of its keys: kind, name, power, reach, shape");
  EXPECT_EQ(error("lamps.key.shape"), "found a whole shape, expected one of its keys: type, min, size");
  EXPECT_EQ(error("lamps.kye.power"), "unknown lamp \"kye\"; did you mean key? (valid: key, 1, a.b, a)");
  EXPECT_EQ(error("lamps..power"), "unknown lamp \"\" (valid: key, 1, a.b, a)");
  EXPECT_EQ(error("lamps.4.power"), "unknown lamp \"4\" (valid: key, 1, a.b, a)");
  EXPECT_EQ(error("lamps.-1.power"), "unknown lamp \"-1\"; did you mean 1? (valid: key, 1, a.b, a)");
  EXPECT_EQ(error("lamps.99999999999999999999.power"), "unknown lamp \"99999999999999999999\" (valid: key, 1, a.b, a)");
  EXPECT_EQ(error("lamps.key."), "unknown key \"\" (valid: kind, name, power, reach, shape)");
  EXPECT_EQ(error("lamps.key.kind"), "found the kind of a lamp, expected one of its keys: name, power, reach, shape");
  Node empty(room_table());
  EXPECT_EQ(find_param(empty, "lamps.0.power").error().message, "unknown lamp \"0\"; there are none");
}

TEST(ParamPath, SetsValuesFromText) {
  Node n = room();
  EXPECT_EQ(message(set_by_path(n, "height", "4.5")), "no error");
  EXPECT_EQ(n.number("height"), 4.5);
  EXPECT_EQ(message(set_by_path(n, "lamps.key.power", "3")), "no error");
  EXPECT_EQ(n.list("lamps")[0].numbers("power"), (Numbers{3, 3, 3}));
  EXPECT_EQ(message(set_by_path(n, "height", "-1")), "found \"-1\", expected a number greater than 0");
  EXPECT_EQ(set_by_path(n, "height", "-1").error().source.key, "height");
  EXPECT_EQ(set_by_path(n, "lamps.key.power", "x").error().source.key, "lamps.key.power");
  EXPECT_EQ(n.number("height"), 4.5);
}

TEST(ParamPath, TellsTheTextThatWouldChangeNothing) {
  Node n = room();
  ASSERT_TRUE(set_by_path(n, "height", "4.5").ok());
  EXPECT_EQ(text_by_path(n, "height").value(), "4.5");
  ASSERT_TRUE(set_by_path(n, "lamps.0.kind", "tube").ok());
  EXPECT_EQ(text_by_path(n, "lamps.key.kind").value(), "tube");
  EXPECT_EQ(text_by_path(n, "hight").error().message, find_param(n, "hight").error().message);
}

TEST(ParamPath, SetsKinds) {
  Node n = room();
  EXPECT_EQ(message(set_by_path(n, "lamps.0.kind", "tube")), "no error");
  EXPECT_EQ(n.list("lamps")[0].kind(), "tube");
  EXPECT_EQ(n.list("lamps")[0].text("name"), "key");
  EXPECT_EQ(message(set_by_path(n, "lamps.key.shape.type", "ball")), "no error");
  EXPECT_EQ(n.list("lamps")[0].child("shape").kind(), "ball");
  EXPECT_EQ(message(set_by_path(n, "lamps.0.kind", "bulp")),
            "unknown lamp \"bulp\"; did you mean bulb? (valid: bulb, tube)");
  EXPECT_EQ(message(set_by_path(n, "lamps.key.kidn", "bulb")),
            "unknown key \"kidn\"; did you mean kind? (valid: kind, name, power, reach, count, shape)");
}

}  // namespace
}  // namespace brume
