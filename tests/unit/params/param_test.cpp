#include "renderer/params/param.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace brume {
namespace {

using param::choice;
using param::color;
using param::file;
using param::flag;
using param::integer;
using param::matrix;
using param::number;
using param::numbers;
using param::point;
using param::resolution;
using param::text;

Param sampling() {
  return choice("sampling", "Sampling", "mis", {{"density", "", ""}, {"equi_angular", "", ""}, {"mis", "", ""}});
}

std::string refused(const Param& p, std::string_view typed) {
  const auto value = parse_value(p, typed);
  if (value.ok()) return "accepted as " + format_value(*value);
  EXPECT_EQ(value.error().source.key, p.key);
  return value.error().message;
}

Value taken(const Param& p, std::string_view typed) {
  const auto value = parse_value(p, typed);
  EXPECT_TRUE(value.ok()) << p.key << " = " << typed << ": " << value.error().message;
  return value ? *value : Value();
}

TEST(Param, BuildersSetWhatTheySay) {
  const Param p =
      number("step", "Step", 0.5).more_than(0).log_slider(0.1, 2).in("m").says("A step.").auto_by_default("what fits");
  EXPECT_EQ(p.default_value, Value(Auto{}));
  EXPECT_EQ(p.automatic, "what fits");
  EXPECT_EQ(p.low, 0);
  EXPECT_TRUE(p.low_open);
  EXPECT_TRUE(p.logarithmic);
  EXPECT_EQ(p.unit, "m");
  EXPECT_EQ(p.affects, Affects::Accumulation);
  EXPECT_EQ(file("f", "F").affects, Affects::Geometry);
  EXPECT_TRUE(file("f", "F").must_be_given().required);
  EXPECT_EQ(number("n", "N", 0).between(-2, 3).slider_high, 3);
  EXPECT_EQ(number("n", "N", 0).or_auto("x").default_value, Value(0.0));
}

TEST(Param, ParsesWhatPeopleType) {
  EXPECT_EQ(taken(number("n", "", 0), " 0.3 "), Value(0.3));
  EXPECT_EQ(taken(number("n", "", 0), "+1e-3"), Value(1e-3));
  EXPECT_EQ(taken(integer("i", "", 0), "42"), Value(std::int64_t{42}));
  EXPECT_EQ(taken(integer("i", "", 0), "1e3"), Value(std::int64_t{1000}));
  EXPECT_EQ(taken(flag("b", "", false), "true"), Value(true));
  EXPECT_EQ(taken(flag("b", "", true), "0"), Value(false));
  EXPECT_EQ(taken(text("t", ""), " as it is "), Value(std::string(" as it is ")));
  EXPECT_EQ(taken(sampling(), " mis "), Value(std::string("mis")));
  EXPECT_EQ(taken(color("c", "", 0, 0, 0), "1,2,3"), Value(Numbers{1, 2, 3}));
  EXPECT_EQ(taken(color("c", "", 0, 0, 0), "[1, 2 ,3]"), Value(Numbers{1, 2, 3}));
  EXPECT_EQ(taken(color("c", "", 0, 0, 0), "0.5"), Value(Numbers{0.5, 0.5, 0.5}));
  EXPECT_EQ(taken(resolution("r", "", 1, 1), "640x480"), Value(Numbers{640, 480}));
  EXPECT_EQ(taken(resolution("r", "", 1, 1), "640, 480"), Value(Numbers{640, 480}));
  EXPECT_EQ(taken(numbers("l", "", {}), ""), Value(Numbers{}));
  EXPECT_EQ(taken(numbers("l", "", {}), "[]"), Value(Numbers{}));
  EXPECT_EQ(taken(number("n", "", 0).or_auto("it"), "auto"), Value(Auto{}));
}

TEST(Param, RefusesWhatItCannotMean) {
  const Param n = number("n", "", 0);
  for (const char* typed :
       {"", "x", "1x", "1 2", "0x10", "nan", "inf", "-inf", "1e999", "+-3", "++3", "--3", "auto", "1,2"})
    EXPECT_EQ(refused(n, typed), "found \"" + std::string(typed) + "\", expected a number");
  EXPECT_EQ(refused(integer("i", "", 0), "1.5"), "found \"1.5\", expected a whole number");
  EXPECT_EQ(refused(integer("i", "", 0), "1e300"), "found \"1e300\", expected a whole number");
  EXPECT_EQ(refused(flag("b", "", true), "yes"), "found \"yes\", expected true or false");
  for (const char* typed : {"1,2", "1,2,3,4", "1,2,", ",1,2", "1,,2", "1,2,3,", "[1,2,3", "1 2 3", "1,2,inf"})
    EXPECT_EQ(refused(point("p", "", 0, 0, 0), typed), "found \"" + std::string(typed) + "\", expected three numbers");
  EXPECT_EQ(refused(resolution("r", "", 1, 1), "640x"), "found \"640x\", expected two whole numbers");
  EXPECT_EQ(refused(resolution("r", "", 1, 1), "640x1.5"), "found \"640x1.5\", expected two whole numbers");
  EXPECT_EQ(refused(matrix("m", ""), "1,2"),
            "found \"1,2\", expected 16 numbers (a 4x4 matrix by rows) or an empty list");
  EXPECT_EQ(refused(file("f", "").must_be_given(), ""), "found \"\", expected the path of a file");
}

TEST(Param, AWrongChoiceIsToldTheNearestOnes) {
  EXPECT_EQ(refused(sampling(), "denisty"),
            "found \"denisty\", expected one of density, equi_angular, mis; did you mean density?");
  EXPECT_EQ(validate(sampling(), std::string("equi")).error().message,
            "found equi, expected one of density, equi_angular, mis; did you mean equi_angular?");
}

TEST(Param, RangesIncludeTheirEndsUnlessOpen) {
  const Param closed = number("n", "", 0).between(-1, 1), open = number("n", "", 1).more_than(0),
              least = number("n", "", 1).at_least(0);
  EXPECT_TRUE(validate(closed, -1.0).ok());
  EXPECT_TRUE(validate(closed, 1.0).ok());
  EXPECT_FALSE(validate(closed, std::nextafter(1.0, 2.0)).ok());
  EXPECT_FALSE(validate(open, 0.0).ok());
  EXPECT_TRUE(validate(open, std::numeric_limits<double>::denorm_min()).ok());
  EXPECT_TRUE(validate(least, 0.0).ok());
  EXPECT_FALSE(validate(least, -std::numeric_limits<double>::denorm_min()).ok());
  EXPECT_FALSE(validate(number("n", "", 0), std::numeric_limits<double>::quiet_NaN()).ok());
  EXPECT_FALSE(validate(number("n", "", 0), std::numeric_limits<double>::infinity()).ok());
  EXPECT_FALSE(validate(color("c", "", 0, 0, 0), Numbers{1, -1, 1}).ok());
  EXPECT_TRUE(validate(integer("i", "", 1).between(1, 256), std::int64_t{256}).ok());
  EXPECT_FALSE(validate(integer("i", "", 1).between(1, 256), std::int64_t{257}).ok());
}

TEST(Param, ValidateRefusesOtherTypes) {
  EXPECT_FALSE(validate(number("n", "", 0), std::int64_t{1}).ok());
  EXPECT_FALSE(validate(integer("i", "", 0), 1.0).ok());
  EXPECT_FALSE(validate(flag("b", "", true), std::string("true")).ok());
  EXPECT_FALSE(validate(text("t", ""), true).ok());
  EXPECT_FALSE(validate(point("p", "", 0, 0, 0), 1.0).ok());
  EXPECT_FALSE(validate(number("n", "", 0), Auto{}).ok());
  EXPECT_TRUE(validate(number("n", "", 0).or_auto("it"), Auto{}).ok());
  EXPECT_EQ(validate(number("n", "", 0), std::string()).error().message, "found nothing, expected a number");
}

TEST(Param, ExpectationSaysTypeAndRange) {
  EXPECT_EQ(expectation(number("n", "", 0)), "a number");
  EXPECT_EQ(expectation(number("n", "", 1).more_than(0)), "a number greater than 0");
  EXPECT_EQ(expectation(number("n", "", 1).at_least(2)), "a number at least 2");
  EXPECT_EQ(expectation(number("n", "", 1).between(0, 100000)), "a number in [0, 100000]");
  EXPECT_EQ(expectation(integer("i", "", 1).between(1, 3).or_auto("it")), "a whole number in [1, 3], or auto");
  EXPECT_EQ(expectation(color("c", "", 0, 0, 0)), "three numbers at least 0");
  EXPECT_EQ(expectation(sampling()), "one of density, equi_angular, mis");
}

TEST(Param, FormatIsShort) {
  EXPECT_EQ(format_value(Auto{}), "auto");
  EXPECT_EQ(format_value(true), "true");
  EXPECT_EQ(format_value(std::int64_t{-5}), "-5");
  EXPECT_EQ(format_value(1.0), "1");
  EXPECT_EQ(format_value(0.1), "0.1");
  EXPECT_EQ(format_value(100000.0), "100000");
  EXPECT_EQ(format_value(-0.0), "-0");
  EXPECT_EQ(format_value(1e20), "1e+20");
  EXPECT_EQ(format_value(Numbers{100000, 0.5}), "[100000, 0.5]");
  EXPECT_EQ(format_value(Numbers{}), "[]");
}

TEST(Param, FormattedNumbersParseBackWithTheSameBits) {
  std::mt19937_64 random(1);
  const Param n = number("n", "", 0), l = numbers("l", "", {});
  for (int i = 0; i < 20000; ++i) {
    double v = std::bit_cast<double>(random());
    if (i % 2 == 0) v = std::round(std::ldexp(v, -static_cast<int>(random() % 64)));
    if (!std::isfinite(v)) continue;
    const Value again = taken(n, format_value(v));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::get<double>(again)), std::bit_cast<std::uint64_t>(v))
        << format_value(v);
    EXPECT_EQ(taken(l, format_value(Numbers{v, 1, v})), Value(Numbers{v, 1, v}));
  }
}

TEST(Param, SimilarNamesFindsSlips) {
  const std::vector<std::string> names{"position", "intensity", "enabled", "g", "up"};
  using Names = std::vector<std::string>;
  EXPECT_EQ(similar_names("intensty", names), Names{"intensity"});
  EXPECT_EQ(similar_names("Position", names), Names{"position"});
  EXPECT_EQ(similar_names("POSITION", names), Names{"position"});
  EXPECT_EQ(similar_names("psoition", names), Names{"position"});
  EXPECT_EQ(similar_names("pos", names), Names{"position"});
  EXPECT_EQ(similar_names("G", names), Names{"g"});
  EXPECT_EQ(similar_names("pu", names), Names{"up"});
  EXPECT_EQ(similar_names("colour", names), Names{});
  EXPECT_EQ(similar_names("supper", names), Names{});  // holds "up", and means nothing by it
  EXPECT_EQ(similar_names("x", names), Names{});
  EXPECT_EQ(similar_names("", names), Names{});
  EXPECT_EQ(similar_names("anything", {""}), Names{});
  EXPECT_EQ(similar_names("", {""}), Names{});
}

TEST(Param, SimilarNamesGivesAtMostThreeBestFirst) {
  EXPECT_EQ(similar_names("light", {"lights", "light_2", "lightly", "sight", "dark"}),
            (std::vector<std::string>{"lights", "sight", "light_2"}));
}

TEST(Param, SimilarNamesIsQuickOnHugeWords) {
  EXPECT_TRUE(similar_names(std::string(10000000, 'x'), {"position", "intensity"}).empty());
}

TEST(Param, UnknownNameListsTheValidOnes) {
  EXPECT_EQ(unknown_name("light", "pont", {"point", "quad"}),
            "unknown light \"pont\"; did you mean point? (valid: point, quad)");
  EXPECT_EQ(unknown_name("key", "zzz", {"a", "b"}), "unknown key \"zzz\" (valid: a, b)");
  EXPECT_EQ(unknown_name("key", "zzz", {}), "unknown key \"zzz\"; there are none");
}

TEST(Param, JoinKeepsEmptyWords) {
  EXPECT_EQ(join({}), "");
  EXPECT_EQ(join({"a", "b"}), "a, b");
  EXPECT_EQ(join({"", "b", ""}, "-"), "-b-");
}

}  // namespace
}  // namespace brume
