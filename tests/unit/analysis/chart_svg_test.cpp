#include "renderer/analysis/chart_svg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <locale>
#include <map>

namespace brume {
namespace {

struct Tag {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  ///< up to the next tag, as written
};

/// Reads the elements of a well-formed document in the order of their start; an empty list and a failure otherwise.
/// Knows what XML 1.0 asks of tags, attributes and references, and nothing of comments or CDATA, which are not used.
std::vector<Tag> parse(const std::string& xml) {
  std::vector<Tag> tags;
  std::vector<std::string> open;
  const auto fail = [&](const std::string& why, std::size_t at) {
    ADD_FAILURE() << why << " at " << at << ": " << xml.substr(at, 60);
    return std::vector<Tag>();
  };
  const auto references_are_known = [](const std::string& text) {
    for (std::size_t i = text.find('&'); i != std::string::npos; i = text.find('&', i + 1)) {
      bool known = false;
      for (const char* name : {"&amp;", "&lt;", "&gt;", "&quot;"})
        known |= text.compare(i, std::string(name).size(), name) == 0;
      if (!known) return false;
    }
    return true;
  };
  std::size_t at = xml.find("?>");
  if (!xml.starts_with("<?xml ") || at == std::string::npos) return fail("no declaration", 0);
  for (at = xml.find('<', at); at != std::string::npos; at = xml.find('<', at)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) return fail("tag without end", at);
    std::string inside = xml.substr(at + 1, end - at - 1);
    if (inside.find('<') != std::string::npos) return fail("< in a tag", at);
    if (inside.starts_with('/')) {
      if (open.empty() || open.back() != inside.substr(1)) return fail("unbalanced", at);
      open.pop_back();
      if (open.empty() && xml.find_first_not_of('\n', end + 1) != std::string::npos) return fail("after the end", end);
      at = end;
      continue;
    }
    if (open.empty() && !tags.empty()) return fail("second root", at);
    const bool closed = inside.ends_with('/');
    if (closed) inside.pop_back();
    Tag tag{.name = inside.substr(0, inside.find(' ')), .attributes = {}, .text = {}};
    for (std::size_t i = tag.name.size(); i < inside.size();) {
      const std::size_t equals = inside.find("=\"", i);
      if (inside[i] != ' ' || equals == std::string::npos) return fail("bad attribute", at);
      const std::size_t quote = inside.find('"', equals + 2);
      if (quote == std::string::npos) return fail("open quote", at);
      const std::string name = inside.substr(i + 1, equals - i - 1),
                        value = inside.substr(equals + 2, quote - equals - 2);
      if (!references_are_known(value) || !tag.attributes.emplace(name, value).second) return fail("bad value", at);
      i = quote + 1;
    }
    tag.text = xml.substr(end + 1, xml.find('<', end) - end - 1);
    if (!references_are_known(tag.text)) return fail("bare &", end);
    if (!closed) open.push_back(tag.name);
    tags.push_back(tag);
    at = end;
  }
  if (!open.empty()) return fail("open at the end", xml.size());
  return tags;
}

double number(const Tag& tag, const std::string& name) { return std::strtod(tag.attributes.at(name).c_str(), nullptr); }

std::vector<Tag> named(const std::vector<Tag>& tags, const std::string& name) {
  std::vector<Tag> result;
  for (const Tag& tag : tags)
    if (tag.name == name) result.push_back(tag);
  return result;
}

Drawing drawing_of(Drawing::Shape shape) {
  return {.width = 100, .height = 50, .background = {255, 255, 255}, .shapes = {std::move(shape)}};
}

TEST(ChartSvg, EveryPointOfEverySeriesIsThere) {
  Chart chart{.title = "Error", .x = {.label = "samples", .logarithmic = true}, .y = {.label = "error"}};
  for (std::size_t s = 0; s < 4; ++s) {
    chart.series.push_back({.name = "method", .color = series_color(s)});
    for (int i = 1; i < 9; ++i)
      chart.series.back().points.push_back({std::pow(2.0, i), static_cast<double>(s + 1) / i});
  }
  const ChartLayout layout = lay_out(chart);
  const std::vector<Tag> tags = parse(to_svg(layout.drawing));
  const std::vector<Tag> circles = named(tags, "circle"), lines = named(tags, "polyline");
  ASSERT_EQ(lines.size(), 4u);
  ASSERT_EQ(circles.size(), 4u * 8 + 4) << "markers, and one each in the legend";
  for (std::size_t s = 0; s < 4; ++s) {
    const char* rest = lines[s].attributes.at("points").c_str();
    for (std::size_t i = 0; i < 8; ++i) {
      const std::array<float, 2> pixel = layout.projection.to_pixels(chart.series[s].points[i]);
      EXPECT_NEAR(number(circles[s * 8 + i], "cx"), pixel[0], 0.006);  // two decimals
      EXPECT_NEAR(number(circles[s * 8 + i], "cy"), pixel[1], 0.006);
      char* end = nullptr;
      EXPECT_NEAR(std::strtod(rest, &end), pixel[0], 0.006);
      EXPECT_EQ(*end, ',');
      EXPECT_NEAR(std::strtod(end + 1, &end), pixel[1], 0.006);
      rest = end;
    }
    EXPECT_EQ(*rest, '\0');
  }
}

TEST(ChartSvg, StandsAlone) {
  const std::string svg = to_svg(drawing_of(Disc{{10, 20}, 3, {0, 128, 255}}));
  const std::vector<Tag> tags = parse(svg);
  ASSERT_EQ(tags.size(), 3u);
  EXPECT_EQ(tags[0].name, "svg");
  EXPECT_EQ(tags[0].attributes.at("xmlns"), "http://www.w3.org/2000/svg");
  EXPECT_EQ(tags[0].attributes.at("viewBox"), "0 0 100 50");
  EXPECT_TRUE(tags[0].attributes.at("font-family").ends_with("sans-serif")) << "a font that every machine has";
  EXPECT_EQ(svg.find("href"), std::string::npos);
  EXPECT_EQ(tags[1].name, "rect");
  EXPECT_EQ(tags[1].attributes.at("fill"), "#ffffff");
  EXPECT_EQ(number(tags[1], "width"), 100);
  EXPECT_EQ(tags[2].attributes.at("fill"), "#0080ff");
}

TEST(ChartSvg, TextsAreEscaped) {
  const auto shown = [](const std::string& words) {
    const std::vector<Tag> texts = named(parse(to_svg(drawing_of(Text{.text = words}))), "text");
    return texts.size() == 1 ? texts[0].text : "?";
  };
  EXPECT_EQ(shown("a < b && b > \"c\""), "a &lt; b &amp;&amp; b &gt; &quot;c&quot;");
  EXPECT_EQ(shown("</text></svg>"), "&lt;/text&gt;&lt;/svg&gt;");
  EXPECT_EQ(shown("σ² ≤ 1 \U0001F600"), "σ² ≤ 1 \U0001F600") << "UTF-8 stays";
  EXPECT_EQ(shown("a\x01z"), "a\uFFFDz") << "XML has no control characters";
  EXPECT_EQ(shown("a\xFFz"), "a\uFFFDz") << "no UTF-8";
  EXPECT_EQ(shown("\xBF\xBF"), "\uFFFD\uFFFD") << "the middle of characters";
  EXPECT_EQ(shown("a\xE2\x89"), "a\uFFFD\uFFFD") << "cut off";
  EXPECT_EQ(shown("\xC0\xAF"), "\uFFFD\uFFFD") << "too long a form of /";
  EXPECT_EQ(shown("\xED\xA0\x80"), "\uFFFD\uFFFD\uFFFD") << "half of a pair of UTF-16";
}

TEST(ChartSvg, ShapesKeepTheirStyle) {
  const auto only = [](Drawing::Shape shape) { return parse(to_svg(drawing_of(std::move(shape)))).at(2); };
  const Tag dashed = only(Line{{1, 2}, {3, 4.5f}, {255, 0, 0}, 2, true});
  EXPECT_EQ(dashed.attributes.at("stroke-dasharray"), "8 6");
  EXPECT_EQ(dashed.attributes.at("y2"), "4.5");
  EXPECT_FALSE(only(Line{}).attributes.contains("stroke-dasharray"));
  EXPECT_EQ(only(Polyline{{{0, 0}, {1, 1}}}).attributes.at("fill"), "none") << "or it would be an area";
  const Tag ring = only(Disc{{5, 5}, 4, {0, 0, 255}, 1.5f});
  EXPECT_EQ(ring.attributes.at("fill"), "none");
  EXPECT_EQ(ring.attributes.at("stroke-width"), "1.5");
  const Tag text = only(Text{{7, 9}, TextAnchor::End, 12, {}, "up", true});
  EXPECT_EQ(text.attributes.at("transform"), "rotate(-90 7 9)");
  EXPECT_EQ(text.attributes.at("text-anchor"), "end");
  EXPECT_EQ(text.attributes.at("font-size"), "12");
  const Tag rect = only(Rect{{1, 2}, {4, 8}, {1, 2, 3}});
  EXPECT_EQ(rect.attributes.at("height"), "6");
  EXPECT_EQ(rect.attributes.at("fill"), "#010203");
}

TEST(ChartSvg, NumbersAreTheSameInEveryLocaleAndNeverNan) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const Drawing drawing = drawing_of(Line{{-0.001f, 1234.567f}, {std::nanf(""), 1e30f}, {}, 0.25f, false});
  const std::string before = to_svg(drawing);
  const std::locale old = std::locale::global(std::locale(std::locale::classic(), new Comma));
  const std::string after = to_svg(drawing);
  std::locale::global(old);
  EXPECT_EQ(before, after);
  const Tag line = parse(before).at(2);
  EXPECT_EQ(line.attributes.at("x1"), "0");
  EXPECT_EQ(line.attributes.at("y1"), "1234.57");
  EXPECT_EQ(line.attributes.at("x2"), "0");
  EXPECT_EQ(line.attributes.at("y2"), "0");
  EXPECT_EQ(line.attributes.at("stroke-width"), "0.25");
}

}  // namespace
}  // namespace brume
