#include "renderer/scene_io/json_print.h"

#include <gtest/gtest.h>

#include <bit>
#include <cfloat>
#include <cmath>
#include <random>

namespace brume {
namespace {

std::string reprinted(std::string_view text, bool spread_root = false) {
  const auto json = parse_json(text, "test.json");
  return json.ok() ? format_json(*json, spread_root) : json.error().to_string();
}

TEST(JsonPrint, ShortObjectsStayOnOneLine) {
  EXPECT_EQ(reprinted("{\"a\":[1,2,3],\"b\":{\"c\":true,\"d\":null},\"e\":[],\"f\":{}}"),
            "{\"a\": [1, 2, 3], \"b\": {\"c\": true, \"d\": null}, \"e\": [], \"f\": {}}");
  EXPECT_EQ(reprinted("{\"a\":1,\"b\":{\"c\":2}}", true), "{\n  \"a\": 1,\n  \"b\": {\"c\": 2}\n}");
  EXPECT_EQ(reprinted("{}", true), "{}");
}

TEST(JsonPrint, ListsOfObjectsAreSpread) {
  EXPECT_EQ(reprinted("{\"l\":[{\"a\":1},{\"a\":2}]}"), "{\n  \"l\": [\n    {\"a\": 1},\n    {\"a\": 2}\n  ]\n}");
}

TEST(JsonPrint, LongListsFillLines) {
  JsonValue list = JsonValue::array();
  for (int i = 0; i < 200; ++i) list.items.emplace_back(i * 0.25);
  const std::string text = format_json(JsonValue::object().add("edges", list));
  EXPECT_EQ(text.find("{\n  \"edges\": [\n    0, 0.25, 0.5, 0.75, 1,"), 0u) << text;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    EXPECT_LE(end - begin, static_cast<std::size_t>(kJsonColumns));
    EXPECT_NE(text[end - 1], ' ');
    begin = end + 1;
  }
  EXPECT_EQ(reprinted(text), text);
}

TEST(JsonPrint, LinesBreakAtTheLastColumn) {
  // {"a": "xxx"} has 9 characters beside the x; one column is kept for a comma.
  const auto object = [](std::size_t n) { return JsonValue::object().add("a", std::string(n, 'x')); };
  EXPECT_EQ(format_json(object(90)).find('\n'), std::string::npos);
  EXPECT_NE(format_json(object(91)).find('\n'), std::string::npos);
}

TEST(JsonPrint, NumbersAreShort) {
  const auto text = [](double v) { return format_json(JsonValue(v)); };
  EXPECT_EQ(text(1), "1");
  EXPECT_EQ(text(-0.0), "-0");
  EXPECT_EQ(text(0.1), "0.1");
  EXPECT_EQ(text(0.1 + 0.2), "0.30000000000000004");
  EXPECT_EQ(text(100000), "100000");
  EXPECT_EQ(text(1e22), "1e+22");
  EXPECT_EQ(format_json(JsonValue(INT64_MIN)), "-9223372036854775808");
}

TEST(JsonPrint, AnyDoubleReadsBackWithTheSameBits) {
  std::vector<double> values{0.0,
                             -0.0,
                             5e-324,
                             -5e-324,
                             DBL_MIN,
                             DBL_MAX,
                             -DBL_MAX,
                             DBL_EPSILON,
                             1.0 / 3,
                             1e15,
                             999999999999999.,
                             1e15 + 2,
                             1e22,
                             1e23,
                             9007199254740993.,
                             9.2233720368547758e18,
                             1.8446744073709552e19,
                             -9.2233720368547758e18,
                             123456789012345680.0};
  std::mt19937_64 random(11);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    const double v = std::bit_cast<double>(bits);
    if (std::isfinite(v)) values.push_back(v);
    values.push_back(
        std::round(std::ldexp(static_cast<double>(static_cast<std::int64_t>(bits)), -static_cast<int>(random() % 64))));
  }
  for (double v : values) {
    const auto json = parse_json(format_json(JsonValue(v)), "test.json");
    ASSERT_TRUE(json.ok()) << v;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(json->number), std::bit_cast<std::uint64_t>(v)) << format_json(JsonValue(v));
  }
}

TEST(JsonPrint, TextsAreEscaped) {
  using namespace std::string_literals;
  EXPECT_EQ(quote_json("a\"b\\c\n\t\r\x01\x7F/"), "\"a\\\"b\\\\c\\n\\t\\r\\u0001\\u007f/\"");
  EXPECT_EQ(quote_json("a\0b"s), "\"a\\u0000b\"");
  EXPECT_EQ(quote_json("\xC3\xA4\xF0\x9F\x94\xA5"), "\"\xC3\xA4\xF0\x9F\x94\xA5\"");
  EXPECT_EQ(quote_json("a\xE4"), "\"a\xEF\xBF\xBD\"");
  for (const std::string& text : {"a\"b\\c\n\t\r\x01\x7F/"s, "\0\x1F"s, "\xF0\x9F\x94\xA5"s}) {
    const auto json = parse_json(quote_json(text), "test.json");
    ASSERT_TRUE(json.ok());
    EXPECT_EQ(json->text, text);
  }
}

TEST(JsonPrint, MessagesCutLongTextsBetweenCharacters) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "\xE2\x82\xAC";
  const std::string shown = quote_for_message(text);
  EXPECT_TRUE(shown.ends_with("...\""));
  EXPECT_EQ(shown.find("\xEF\xBF\xBD"), std::string::npos);
  EXPECT_LT(shown.size(), 80u);
  EXPECT_EQ(quote_for_message("short"), "\"short\"");
  EXPECT_LT(quote_for_message(std::string(100, '\x80')).size(), 250u);
}

}  // namespace
}  // namespace brume
