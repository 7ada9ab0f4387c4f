#include "renderer/scene_io/write_node.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "renderer/scene_io/read_node.h"
#include "tests/unit/scene_io/test_tables.h"

namespace brume {
namespace {

using test_tables::studio;
using test_tables::studio_family;

std::string written(const Node& node, const Family& family = studio_family(), const WriteOptions& options = {"/base"}) {
  return write_node(node, family, options);
}

Node reread(const std::string& text, const Family& family, const std::string& base) {
  const auto json = parse_json(text, "s.json");
  EXPECT_TRUE(json.ok()) << json.error().to_string() << "\nin " << text;
  auto node = read_node(*json, family, {"s.json", base});
  EXPECT_TRUE(node.ok()) << node.error().to_string() << "\nin " << text;
  return node ? *node : Node(*family.tables.front());
}

void set(Node& node, const char* key, Value value) {
  const auto done = node.set(key, std::move(value));
  EXPECT_TRUE(done.ok()) << done.error().to_string();
}

Node volume(const std::string& file) {
  Node n(*test_tables::volume_family().tables[0]);
  set(n, "file", file);
  return n;
}

TEST(WriteNode, DefaultsAreLeftOut) { EXPECT_EQ(written(studio()), "{}\n"); }

TEST(WriteNode, KeepsKindNameAndRequiredParameters) {
  Node s = studio();
  s.list("lights").emplace_back(*test_tables::light_family().tables[0]);
  s.list("lights").emplace_back(*test_tables::light_family().tables[1]);
  set(s.list("lights")[1], "name", "key");
  s.list("volumes").push_back(volume("/base/smoke.vdb"));
  EXPECT_EQ(written(s),
            "{\n"
            "  \"volumes\": [\n"
            "    {\"shader\": \"vdb\", \"file\": \"smoke.vdb\"}\n"
            "  ],\n"
            "  \"lights\": [\n"
            "    {\"type\": \"point\"},\n"
            "    {\"name\": \"key\", \"type\": \"sun\"}\n"
            "  ]\n"
            "}\n");
}

TEST(WriteNode, LooksLikeThis) {
  Node s = studio();
  set(s.child("film"), "resolution", Numbers{1920, 1080});
  set(s.child("film"), "exposure", 0.5);
  Node v = volume("/base/smoke.vdb");
  set(v, "name", std::string("plume"));
  set(v, "density_scale", 20.0);
  set(v, "albedo", Numbers{0.25, 0.5, 1});
  set(v, "step", 0.1);
  v.child("phase") = Node(*test_tables::phase_family().tables[1]);
  set(v.child("phase"), "g", 0.2);
  s.list("volumes").push_back(v);
  EXPECT_EQ(written(s),
            "{\n"
            "  \"film\": {\"resolution\": [1920, 1080], \"exposure\": 0.5},\n"
            "  \"volumes\": [\n"
            "    {\n"
            "      \"name\": \"plume\",\n"
            "      \"shader\": \"vdb\",\n"
            "      \"file\": \"smoke.vdb\",\n"
            "      \"density_scale\": 20,\n"
            "      \"step\": 0.1,\n"
            "      \"albedo\": [0.25, 0.5, 1],\n"
            "      \"phase\": {\"type\": \"lobe\", \"g\": 0.2}\n"
            "    }\n"
            "  ]\n"
            "}\n");
}

TEST(WriteNode, AllWritesDefaultsToo) {
  const std::string text = written(studio(), studio_family(), {"/base", true});
  EXPECT_EQ(
      text,
      "{\"film\": {\"resolution\": [640, 480], \"exposure\": 0, \"seed\": 0}, \"volumes\": [], \"lights\": []}\n");
  const std::string lines = written(volume("/base/a"), test_tables::volume_family(), {"/base", true});
  for (const Param& p : test_tables::volume_family().tables[0]->params)
    EXPECT_NE(lines.find("\"" + p.key + "\""), std::string::npos) << p.key;
  EXPECT_NE(lines.find("\"step\": \"auto\""), std::string::npos) << lines;
}

TEST(WriteNode, AnotherKindInASlotIsWrittenEvenWhenAllElseIsDefault) {
  Node v = volume("/base/a");
  v.child("phase") = Node(*test_tables::phase_family().tables[1]);
  EXPECT_EQ(written(v, test_tables::volume_family()),
            "{\"shader\": \"vdb\", \"file\": \"a\", \"phase\": {\"type\": \"lobe\"}}\n");
}

TEST(WriteNode, FilesNearTheTargetBecomeRelative) {
  const auto file = [](const std::string& path, const std::string& target) {
    const std::string text = written(volume(path), test_tables::volume_family(), {target});
    EXPECT_EQ(reread(text, test_tables::volume_family(), target.empty() ? "/" : target).text("file"), path);
    const auto json = parse_json(text, "");
    return json.ok() ? json->find("file")->value.text : "";
  };
  EXPECT_EQ(file("/a/b/smoke.vdb", "/a/b"), "smoke.vdb");
  EXPECT_EQ(file("/a/b/smoke.vdb", "/a/b/"), "smoke.vdb");
  EXPECT_EQ(file("/a/b/smoke.vdb", "/a/./x/../b"), "smoke.vdb");
  EXPECT_EQ(file("/a/b/c/d/e/smoke.vdb", "/a/b"), "c/d/e/smoke.vdb");
  EXPECT_EQ(file("/a/c/smoke.vdb", "/a/b"), "../c/smoke.vdb");
  EXPECT_EQ(file("/a/smoke.vdb", "/a/b/c"), "../../smoke.vdb");
  EXPECT_EQ(file("/a/smoke.vdb", "/a/b/c/d"), "/a/smoke.vdb");          // three up
  EXPECT_EQ(file("/home/me/smoke.vdb", "/tmp"), "/home/me/smoke.vdb");  // nothing but the root in common
  EXPECT_EQ(file("/home/me/smoke.vdb", "/tmp/x"), "/home/me/smoke.vdb");
  EXPECT_EQ(file("/smoke.vdb", "/"), "smoke.vdb");
  EXPECT_EQ(file("/a/b", "/a/b"), "/a/b");                              // the target itself
  EXPECT_EQ(file("/a/./b/../smoke.vdb", "/a"), "/a/./b/../smoke.vdb");  // not normal: would not read back the same
  EXPECT_EQ(file("/a//smoke.vdb", "/a"), "/a//smoke.vdb");
  EXPECT_EQ(file("/a/b/smoke.vdb", ""), "/a/b/smoke.vdb");
  EXPECT_EQ(file("/a/\xC3\xA4 \xE7\x85\x99.vdb", "/a"), "\xC3\xA4 \xE7\x85\x99.vdb");
}

TEST(WriteNode, EmptyFilesStayEmpty) {
  const Node v = volume("/base/a");
  EXPECT_NE(written(v, test_tables::volume_family(), {"/base", true}).find("\"fire\": \"\""), std::string::npos);
}

class RandomNodes {
 public:
  explicit RandomNodes(unsigned seed) : random_(seed) {}

  Node node(const Family& family) {
    Node n(*family.tables[random_() % family.tables.size()]);
    for (const Param& p : n.table().params) set_randomly(n, p);
    for (const Slot& s : n.table().slots) {
      if (!s.list) {
        n.child(s.key) = node(*s.family);
        continue;
      }
      for (auto count = random_() % 4; count > 0; --count) n.list(s.key).push_back(node(*s.family));
    }
    return n;
  }

 private:
  double number() {
    switch (random_() % 8) {
      case 0:
        return 0;
      case 1:
        return -0.0;
      case 2:
        return static_cast<double>(random_() % 1000);
      case 3:
        return 0.1 * static_cast<double>(random_() % 1000);
      case 4:
        return 5e-324;
      default: {
        const double v = std::bit_cast<double>(random_());
        return std::isfinite(v) ? v : 1;
      }
    }
  }

  Numbers numbers(std::size_t count) {
    Numbers list;
    for (std::size_t i = 0; i < count; ++i) list.push_back(number());
    return list;
  }

  std::string text() {
    static const char* const kWords[] = {"",     "a", "caf\xC3\xA9 \xF0\x9F\x94\xA5", "\"\\/\b\f\n\r\t\x01\x7F", "auto",
                                         "// x", "{}"};
    return kWords[random_() % 7];
  }

  std::string file() {
    static const char* const kFiles[] = {"",
                                         "/base/smoke.vdb",
                                         "/base/sub/\xC3\xA4.vdb",
                                         "/other/smoke.vdb",
                                         "/base/\"q\"",
                                         "/base/x/../y.vdb",
                                         "/a/b/c/d/e/f"};
    return kFiles[random_() % 7];
  }

  /// Values out of range are refused by the node, which then keeps its default.
  void set_randomly(Node& n, const Param& p) {
    Value v;
    switch (p.type) {
      case ParamType::Bool:
        v = random_() % 2 == 0;
        break;
      case ParamType::Int:
        v = static_cast<std::int64_t>(random_());
        break;
      case ParamType::Number:
        v = number();
        break;
      case ParamType::Text:
        v = text();
        break;
      case ParamType::File:
        v = file();
        break;
      case ParamType::Choice:
        v = p.choices[random_() % p.choices.size()].key;
        break;
      case ParamType::Resolution:
        v = Numbers{static_cast<double>(1 + random_() % 9999), 16384};
        break;
      case ParamType::Matrix:
        v = numbers(random_() % 2 == 0 ? 0 : 16);
        break;
      case ParamType::NumberList:
        v = numbers(random_() % 40);
        break;
      case ParamType::SettingList:
        v = Settings{{"render.step_size", "0.25"},
                     {"render.integrator", text()},
                     {"a.b", "[1, 2.5, -3]"},
                     {"c", "true"},
                     {"d", "007"}};
        break;
      default:
        v = numbers(3);
        break;
    }
    if (p.automatic && random_() % 3 == 0) v = Auto{};
    const bool taken = n.set(p.key, std::move(v)).ok();
    if (!taken && p.required) set(n, p.key.c_str(), std::string("/base/needed.vdb"));
  }

  std::mt19937_64 random_;
};

void expect_same_bits(const Node& a, const Node& b) {
  ASSERT_EQ(&a.table(), &b.table());
  for (const Param& p : a.table().params) {
    const auto *x = std::get_if<Numbers>(&a.value(p.key)), *y = std::get_if<Numbers>(&b.value(p.key));
    if (!x || !y) continue;
    ASSERT_EQ(x->size(), y->size());
    for (std::size_t i = 0; i < x->size(); ++i)
      EXPECT_EQ(std::bit_cast<std::uint64_t>((*x)[i]), std::bit_cast<std::uint64_t>((*y)[i])) << p.key;
  }
}

TEST(WriteNode, RandomNodesReadBackExactly) {
  RandomNodes random(3);
  for (int i = 0; i < 500; ++i) {
    const Node node = random.node(studio_family());
    for (const bool all : {false, true}) {
      const std::string text = written(node, studio_family(), {"/base", all});
      const Node again = reread(text, studio_family(), "/base");
      ASSERT_EQ(again, node) << text;
      EXPECT_EQ(written(again, studio_family(), {"/base", all}), text);
      if (!all) continue;  // a default of 0 absorbs a value of -0
      for (std::size_t k = 0; k < node.list("volumes").size(); ++k)
        expect_same_bits(node.list("volumes")[k], again.list("volumes")[k]);
    }
  }
}

TEST(WriteNode, LinesStayWithinTheColumns) {
  RandomNodes random(5);
  for (int i = 0; i < 50; ++i) {
    const std::string text = written(random.node(studio_family()));
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = text.find('\n', begin);
      EXPECT_LE(end - begin, 100u) << text.substr(begin, end - begin);
      begin = end + 1;
    }
  }
}

}  // namespace
}  // namespace brume
