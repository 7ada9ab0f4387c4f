#include "renderer/scene_io/json_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace brume {
namespace {

using Kind = JsonValue::Kind;

JsonValue parsed(std::string_view text) {
  auto json = parse_json(text, "test.json");
  EXPECT_TRUE(json.ok()) << json.error().to_string() << "\nin " << text;
  return json ? *json : JsonValue();
}

/// "line:column" where the value of a path of keys and indices begins.
std::string at(const JsonValue& v) { return std::to_string(v.line) + ":" + std::to_string(v.column); }

std::string error_of(std::string_view text) {
  const auto json = parse_json(text, "test.json");
  return json.ok() ? "no error" : json.error().to_string();
}

TEST(JsonTree, ReadsEveryKindOfValue) {
  const JsonValue v =
      parsed(R"({"n": null, "t": true, "f": false, "i": -12, "d": 1.5e-3, "s": "a", "l": [1, []], "o": {}})");
  ASSERT_EQ(v.kind, Kind::Object);
  ASSERT_EQ(v.members.size(), 8u);
  EXPECT_EQ(v.find("n")->value.kind, Kind::Null);
  EXPECT_TRUE(v.find("t")->value.boolean);
  EXPECT_FALSE(v.find("f")->value.boolean);
  EXPECT_EQ(v.find("i")->value.integer, -12);
  EXPECT_EQ(v.find("d")->value.number, 1.5e-3);
  EXPECT_FALSE(v.find("d")->value.integer);
  EXPECT_EQ(v.find("s")->value.text, "a");
  EXPECT_EQ(v.find("l")->value.items.size(), 2u);
  EXPECT_EQ(v.find("o")->value.kind, Kind::Object);
  EXPECT_EQ(v.find("missing"), nullptr);
}

TEST(JsonTree, KeepsTheOrderOfKeys) {
  const JsonValue v = parsed(R"({"zebra": 1, "ape": 2, "mole": 3})");
  EXPECT_EQ(v.members[0].key, "zebra");
  EXPECT_EQ(v.members[1].key, "ape");
  EXPECT_EQ(v.members[2].key, "mole");
}

TEST(JsonTree, KnowsWhereValuesAndKeysBegin) {
  const JsonValue v = parsed(
      "{\n"
      "  \"a\" :1,\"b\":  -2.5e3 ,\n"
      "\t\"c\": [ 1,22 ,\n"
      "    \"x\" , [true,false],{\"k\":null}]\n"
      ", \"d\": {}\n"
      "}\n");
  EXPECT_EQ(at(v), "1:1");
  EXPECT_EQ(v.members[0].line, 2);
  EXPECT_EQ(v.members[0].column, 3);
  EXPECT_EQ(at(v.members[0].value), "2:8");
  EXPECT_EQ(v.members[1].column, 10);
  EXPECT_EQ(at(v.members[1].value), "2:16");
  const JsonValue& list = v.members[2].value;
  EXPECT_EQ(at(list), "3:7");
  EXPECT_EQ(at(list.items[0]), "3:9");
  EXPECT_EQ(at(list.items[1]), "3:11");
  EXPECT_EQ(at(list.items[2]), "4:5");
  EXPECT_EQ(at(list.items[3]), "4:11");
  EXPECT_EQ(at(list.items[3].items[1]), "4:17");
  EXPECT_EQ(at(list.items[4]), "4:24");
  EXPECT_EQ(list.items[4].members[0].column, 25);
  EXPECT_EQ(at(list.items[4].members[0].value), "4:29");
  EXPECT_EQ(v.members[3].line, 5);
  EXPECT_EQ(v.members[3].column, 3);
  EXPECT_EQ(at(v.members[3].value), "5:8");
}

TEST(JsonTree, PositionsSurviveEscapesAndUnicode) {
  // Columns count bytes: the two letters take two bytes each, the flame four.
  const JsonValue v = parsed(
      "{\"\\u00e4\\\"\\\\\": \"\\ud83d\\udd25 ,:[]{}//\" , \"\xC3\xA4\xC3\xB6\": \"\xF0\x9F\x94\xA5\" , \"z\": 1}");
  EXPECT_EQ(v.members[0].key, "\xC3\xA4\"\\");
  EXPECT_EQ(v.members[0].value.text, "\xF0\x9F\x94\xA5 ,:[]{}//");
  EXPECT_EQ(v.members[0].value.column, 16);
  EXPECT_EQ(v.members[1].column, 42);
  EXPECT_EQ(v.members[1].value.column, 50);
  EXPECT_EQ(v.members[2].column, 59);
  EXPECT_EQ(v.members[2].value.column, 64);
}

TEST(JsonTree, PositionsSurviveComments) {
  const JsonValue v = parsed(
      "// first\n"
      "/* { \"no\": 1 } **/ { // \"neither\": 2\n"
      "  \"a\" /* : 5 */ : /* \"b\" */ 7 // end\n"
      "  , \"b\": [/**/1/* x */,/*\n*/2]\r\n"
      "} // last");
  EXPECT_EQ(at(v), "2:20");
  EXPECT_EQ(v.members[0].line, 3);
  EXPECT_EQ(at(v.members[0].value), "3:29");
  EXPECT_EQ(at(v.members[1].value.items[0]), "4:15");
  EXPECT_EQ(at(v.members[1].value.items[1]), "5:3");
}

TEST(JsonTree, IgnoresTheByteOrderMark) {
  const JsonValue v = parsed("\xEF\xBB\xBF{\"a\": 1}");
  EXPECT_EQ(at(v), "1:1");
  EXPECT_EQ(at(v.members[0].value), "1:7");
}

TEST(JsonTree, WholeNumbersAreKnownInAnySpelling) {
  for (const char* text : {"3", "3.0", "3e0", "0.3e1", "30e-1"}) EXPECT_EQ(parsed(text).integer, 3) << text;
  EXPECT_EQ(parsed("9223372036854775807").integer, INT64_MAX);
  EXPECT_EQ(parsed("-9223372036854775808").integer, INT64_MIN);
  EXPECT_EQ(parsed("9007199254740993").integer, 9007199254740993);  // 2^53 + 1 has no double
  EXPECT_FALSE(parsed("9223372036854775808").integer);
  EXPECT_FALSE(parsed("18446744073709551615").integer);
  EXPECT_EQ(parsed("18446744073709551616").number, 18446744073709551616.0);
  EXPECT_FALSE(parsed("3.5").integer);
  EXPECT_FALSE(parsed("1e300").integer);
}

TEST(JsonTree, NegativeZeroKeepsItsSign) {
  for (const char* text : {"-0", "-0.0", "-0e5"}) {
    const JsonValue v = parsed(text);
    EXPECT_EQ(v.number, 0);
    EXPECT_TRUE(std::signbit(v.number)) << text;
    EXPECT_EQ(v.integer, 0);
  }
}

TEST(JsonTree, TinyNumbersBecomeSubnormalOrZero) {
  EXPECT_EQ(parsed("5e-324").number, 5e-324);
  EXPECT_EQ(parsed("1e-999").number, 0);
}

struct Fault {
  const char* text;
  const char* error;
};

TEST(JsonTree, PointsAtEachSyntaxErrorInPlainWords) {
  const Fault faults[] = {
      {"", "test.json:1:1: found nothing, expected a value"},
      {"  // nothing\n", "test.json:2:1: found nothing, expected a value"},
      {"{", "test.json:1:2: the file ends too early, expected a key in double quotes for the { of line 1"},
      {"\n[1,\n", "test.json:3:1: the file ends too early, expected a value"},
      {"\n[1\n", "test.json:3:1: the file ends too early, expected ] for the [ of line 2"},
      {"{\"a\"", "test.json:1:5: the file ends too early, expected a colon behind the key"},
      {"{\"a\":", "test.json:1:6: the file ends too early, expected a value"},
      {"{\"a\":1", "test.json:1:7: the file ends too early, expected } for the { of line 1"},
      {"{\"a\" 1}", "test.json:1:6: found \"1\", expected a colon behind the key"},
      {"{\"a\":: 1}", "test.json:1:6: found :, expected a value"},
      {"{\"a\": 1,}", "test.json:1:8: found a comma before }, expected none behind the last member"},
      {"[1, 2 , ]", "test.json:1:7: found a comma before ], expected none behind the last value"},
      {"[1,,2]", "test.json:1:4: found ,, expected a value"},
      {"[,1]", "test.json:1:2: found ,, expected a value"},
      {"{\"a\": 1 \"b\": 2}", "test.json:1:9: found \"b\", expected a comma or } for the { of line 1"},
      {"{\n\"a\": [1 2]}", "test.json:2:9: found \"2\", expected a comma or ] for the [ of line 2"},
      {"{\"a\": 1]", "test.json:1:8: found ], expected a comma or } for the { of line 1"},
      {"{a: 1}", "test.json:1:2: found \"a\", expected a key in double quotes"},
      {"{1: 1}", "test.json:1:2: found \"1\", expected a key in double quotes"},
      {"{\"a\": 1, [", "test.json:1:10: found [, expected a key in double quotes for the { of line 1"},
      {"{} x", "test.json:1:4: found \"x\" after the end, expected nothing more"},
      {"{}\n{}", "test.json:2:1: found { after the end, expected nothing more"},
      {"1 2", "test.json:1:3: found \"2\" after the end, expected nothing more"},
      {"[1] // ok\n /* not ok", "test.json:2:2: found a comment without its end, expected */"},
      {"[1, /*/ 2]", "test.json:1:5: found a comment without its end, expected */"},
      {"[1, / 2]", "test.json:1:5: found \"/\", expected a value; texts stand in double quotes"},
      {"[True]", "test.json:1:2: found \"True\", expected true in small letters"},
      {"[truefalse]", "test.json:1:2: found \"truefalse\", expected a value; texts stand in double quotes"},
      {"[tru", "test.json:1:2: found \"tru\", expected a value; texts stand in double quotes"},
      {"['a']", "test.json:1:2: found \"'a'\", expected a text in double quotes"},
      {"[NaN]", "test.json:1:2: found \"NaN\", expected a finite number"},
      {"[-Infinity]", "test.json:1:2: found \"-Infinity\", expected a finite number"},
      {"[1, 1e999]", "test.json:1:5: found \"1e999\", expected a number within +-1.8e308"},
      {"[1, -1e999 ]", "test.json:1:5: found \"-1e999\", expected a number within +-1.8e308"},
      {"[01]", "test.json:1:2: found \"01\", expected a number written like 0.5, -2 or 1e-3"},
      {"[.5]", "test.json:1:2: found \".5\", expected a number written like 0.5, -2 or 1e-3"},
      {"[1.]", "test.json:1:2: found \"1.\", expected a number written like 0.5, -2 or 1e-3"},
      {"[+1]", "test.json:1:2: found \"+1\", expected a number written like 0.5, -2 or 1e-3"},
      {"[-]", "test.json:1:2: found \"-\", expected a number written like 0.5, -2 or 1e-3"},
      {"[1e]", "test.json:1:2: found \"1e\", expected a number written like 0.5, -2 or 1e-3"},
      {"[0x1F]", "test.json:1:2: found \"0x1F\", expected a number written like 0.5, -2 or 1e-3"},
      {"[1-2]", "test.json:1:2: found \"1-2\", expected a number written like 0.5, -2 or 1e-3"},
      {"[1,\xC2\xA0"
       "2]",
       "test.json:1:4: found a no-break space, expected a plain one"},
      {"{\"a\": \"b\n\"}", "test.json:1:7: found a text without its closing quote"},
      {"{\"a\": \"b", "test.json:1:7: found a text without its closing quote"},
      {"{\"a\": \"b\\", "test.json:1:7: found a text without its closing quote"},
      {"{\"a", "test.json:1:2: found a text without its closing quote"},
      {"[\"a\tb\"]", "test.json:1:4: found a tab inside a text, expected \\t"},
      {"[\"a\x01\"]", "test.json:1:4: found a control character inside a text, expected an escape such as \\u0007"},
      {"[\"C:\\dir\"]",
       "test.json:1:5: found a backslash before \"d\", expected one of \\\" \\\\ \\/ \\b \\f \\n \\r \\t \\u0000; "
       "write \\\\ for a "
       "plain backslash"},
      {"[\"\\u12\"]", "test.json:1:3: found an incomplete escape, expected \\u and four hexadecimal digits"},
      {"[\"\\ud83d\"]",
       "test.json:1:3: found half of a surrogate pair, expected \\uD800-\\uDBFF followed by \\uDC00-\\uDFFF"},
      {"[\"\\udd25\"]",
       "test.json:1:3: found half of a surrogate pair, expected \\uD800-\\uDBFF followed by \\uDC00-\\uDFFF"},
      {"[\"a\xE4\"]", "test.json:1:4: found a byte that is not UTF-8; save the file as UTF-8"},
      {"{\"a\xE4\": 1}", "test.json:1:4: found a byte that is not UTF-8; save the file as UTF-8"},
      {"\xEF\xBB{}",
       "test.json:1:1: found \"\xEF\xBF\xBD\xEF\xBF\xBD\", expected a value; texts stand in double quotes"},
      {"\xEF\xBB\xBF\xEF\xBB\xBF{}", "test.json:1:1: found a second byte order mark, expected at most one"},
      {"\xFF\xFE{", "test.json:1:1: found UTF-16, expected UTF-8; save the file as UTF-8"},
      {"{\"a\": 1,\n \"b\": 2, \"a\": 3}",
       "test.json:2:10: found the key \"a\" a second time, after line 1; expected it once"},
      {"[{\"a\": {\"a\": 1}, \"b\": 2, \"\\u0061\": 3}]",
       "test.json:1:26: found the key \"a\" a second time, after line 1; expected it once"},
  };
  for (const Fault& f : faults) EXPECT_EQ(error_of(f.text), f.error) << "in " << f.text;
}

TEST(JsonTree, RefusesZeroBytesEverywhere) {
  using namespace std::string_literals;
  EXPECT_EQ(error_of("{}\0"s), "test.json:1:3: found a zero byte, expected a text file");
  EXPECT_EQ(error_of("{\n\"a\0\": 1}"s), "test.json:2:3: found a zero byte, expected a text file");
  EXPECT_EQ(parsed("\"a\\u0000b\"").text, "a\0b"s);
}

TEST(JsonTree, LimitsNesting) {
  const auto nested = [](int depth) {
    return std::string(static_cast<std::size_t>(depth), '[') + std::string(static_cast<std::size_t>(depth), ']');
  };
  EXPECT_EQ(error_of(nested(kMaxJsonDepth)), "no error");
  EXPECT_EQ(error_of(nested(kMaxJsonDepth + 1)), "test.json:1:65: found brackets nested more than 64 deep");
  EXPECT_EQ(error_of(std::string(1000000, '[')), "test.json:1:65: found brackets nested more than 64 deep");
  std::string objects;
  for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
  EXPECT_EQ(error_of(objects), "test.json:1:321: found brackets nested more than 64 deep");
}

TEST(JsonTree, DescribesWhatWasFound) {
  EXPECT_EQ(describe(parsed("null")), "null");
  EXPECT_EQ(describe(parsed("true")), "true");
  EXPECT_EQ(describe(parsed("-2.50")), "-2.5");
  EXPECT_EQ(describe(parsed("\"a\\nb\"")), "the text \"a\\nb\"");
  EXPECT_EQ(describe(parsed("[]")), "an empty list");
  EXPECT_EQ(describe(parsed("[1]")), "a list of 1 value");
  EXPECT_EQ(describe(parsed("[1, 2]")), "a list of 2 values");
  EXPECT_EQ(describe(parsed("{}")), "an object");
  EXPECT_LT(describe(JsonValue(std::string(1000, 'x'))).size(), 100u);
}

/// Whatever the bytes, there is a value or an error inside the text.
void expect_sane(const std::string& text) {
  const auto json = parse_json(text, "test.json");
  if (json.ok()) return;
  const Error& e = json.error();
  EXPECT_EQ(e.code, ErrorCode::BadInput) << e.message;
  EXPECT_FALSE(e.message.empty());
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  EXPECT_GE(e.source.line, 1) << text;
  EXPECT_LE(e.source.line, lines) << text;
  EXPECT_GE(e.source.column, 1) << text;
  EXPECT_LE(static_cast<std::size_t>(e.source.column), text.size() + 1) << text;
}

const char* const kSample =
    "\xEF\xBB\xBF{ // comment\n \"a\\u00e4\": [1, -2.5e-3, true, null, \"x\\n\xC3\xA4\"], /* more */\n"
    " \"b\": {\"c\": {}, \"d\": [[], {}]}, \"e\": \"\\ud83d\\udd25\"}\n";

TEST(JsonTree, EveryTruncationIsAnErrorAndNoCrash) {
  const std::string text = kSample;
  ASSERT_EQ(error_of(text), "no error");
  const std::size_t last = text.rfind('}');
  for (std::size_t n = 0; n <= last; ++n) {
    expect_sane(text.substr(0, n));
    EXPECT_FALSE(parse_json(text.substr(0, n), "test.json").ok()) << n;
  }
}

TEST(JsonTree, RandomDamageIsNoCrash) {
  std::mt19937 random(7);
  const std::string alphabet = "{}[],:\"\\/*u0dD8-+.eE1 \n\ttruefalsn\xC3\xA4\xFF";
  for (int i = 0; i < 20000; ++i) {
    std::string text = kSample;
    const int edits = 1 + static_cast<int>(random() % 4);
    for (int e = 0; e < edits; ++e) {
      const std::size_t where = random() % text.size();
      const char c = alphabet[random() % alphabet.size()];
      if (random() % 3 == 0)
        text.erase(where, 1 + random() % 5);
      else if (random() % 2 == 0)
        text.insert(where, 1, c);
      else
        text[where] = c;
      if (text.empty()) text = "x";
    }
    expect_sane(text);
  }
}

}  // namespace
}  // namespace brume
