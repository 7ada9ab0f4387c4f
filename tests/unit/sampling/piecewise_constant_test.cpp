#include "renderer/sampling/piecewise_constant.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderer/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

Vec2 random_pair(std::uint32_t i) { return Sampler(SamplerKind::Independent, 8, 2, i).u2(Decision::LightPoint); }

constexpr float kEnds[] = {0.0f, 0x1.fffffep-1f};

struct Table {
  int width, height;
  std::vector<float> weights;

  PiecewiseConstant2D made() const { return {width, height, weights}; }
  std::size_t cell_of(Vec2 p) const {
    return static_cast<std::size_t>(p.y * static_cast<float>(height)) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(p.x * static_cast<float>(width));
  }
};

/// Empty rows and cells at the ends and between others, weights over six decades.
const Table kUneven{5, 4, {0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 0, 0, 0, 3, 1e-3f, 0, 1e3f, 5}};

/// Weights of all sizes, none of them 0.
Table random_table(int width, int height) {
  Table t{width, height, {}};
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(width * height); ++i)
    t.weights.push_back(std::exp(6 * random_pair(i).x));
  return t;
}

double sum(const std::vector<float>& weights) {
  double s = 0;
  for (const float w : weights) s += double(w);
  return s;
}

TEST(PiecewiseConstant2D, SamplesFollowTheWeightsAndAreUniformInsideTheCells) {
  constexpr int kN = 200000, kInside = 3;  // bins per cell each way
  for (const Table& t : {kUneven, random_table(9, 7), random_table(1, 13), random_table(13, 1)}) {
    const PiecewiseConstant2D made = t.made();
    const int columns = t.width * kInside, rows = t.height * kInside;
    std::vector<double> observed(static_cast<std::size_t>(columns * rows)), expected;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x)
        expected.push_back(kN * double(t.weights[static_cast<std::size_t>(y / kInside * t.width + x / kInside)]) /
                           (sum(t.weights) * kInside * kInside));
    for (std::uint32_t i = 0; i < kN; ++i) {
      const Vec2 p = made.sample(random_pair(i)).position;
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      ++observed[static_cast<std::size_t>(p.y * static_cast<float>(rows)) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(p.x * static_cast<float>(columns))];
    }
    EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance) << t.width << " x " << t.height;
  }
}

TEST(PiecewiseConstant2D, DensityIsTheWeightOverTheMeanWeight) {
  for (const Table& t : {kUneven, random_table(9, 7)}) {
    const PiecewiseConstant2D made = t.made();
    double integral = 0;
    for (int y = 0; y < t.height; ++y)
      for (int x = 0; x < t.width; ++x) {
        const float density = made.pdf({(static_cast<float>(x) + 0.5f) / static_cast<float>(t.width),
                                        (static_cast<float>(y) + 0.5f) / static_cast<float>(t.height)});
        const double cells = static_cast<double>(t.weights.size());
        const double expected = double(t.weights[static_cast<std::size_t>(y * t.width + x)]) * cells / sum(t.weights);
        // Differences of a distribution function in float: 6e-8 of the row, and of the sum.
        EXPECT_NEAR(density, expected, 2e-7 * cells) << x << ", " << y;
        integral += double(density) / cells;
      }
    EXPECT_NEAR(integral, 1, 1e-6);
  }
}

TEST(PiecewiseConstant2D, ReportedDensityIsTheOneOfThePosition) {
  for (const Table& t : {kUneven, random_table(9, 7), random_table(300, 200)}) {
    const PiecewiseConstant2D made = t.made();
    int compared = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const auto s = made.sample(random_pair(i));
      // On the edge between two cells rounding decides whose density pdf() gives.
      const float x = s.position.x * static_cast<float>(t.width), y = s.position.y * static_cast<float>(t.height);
      if (std::abs(x - std::round(x)) < 1e-4f || std::abs(y - std::round(y)) < 1e-4f) continue;
      ASSERT_FLOAT_EQ(made.pdf(s.position), s.pdf) << x << ", " << y;
      ++compared;
    }
    EXPECT_GT(compared, 19000);
  }
}

TEST(PiecewiseConstant2D, EmptyRowsAndCellsAreNeverDrawn) {
  const PiecewiseConstant2D made = kUneven.made();
  for (std::uint32_t i = 0; i < 100000; ++i) {
    const auto s = made.sample(random_pair(i));
    ASSERT_GT(kUneven.weights[kUneven.cell_of(s.position)], 0) << s.position.x << ", " << s.position.y;
    ASSERT_GT(s.pdf, 0);
  }
  // The distribution function's own values, where a cell ends and empty ones follow.
  for (const float x : {0.0f, 2.0f / 3, 0.003f, 0.9950249f, 0x1.fffffep-1f})
    for (const float y : {0.0f, 3.0f / 1011.001f, 6.0f / 1011.001f, 0x1.fffffep-1f})
      EXPECT_GT(made.sample({x, y}).pdf, 0) << x << ", " << y;
}

/// A position at either end of a full cell must not be rounded into the empty one beside it, where pdf() is 0.
TEST(PiecewiseConstant2D, TheEndsOfACellAreStillInIt) {
  for (const int n : {2, 3, 5, 8, 40, 41, 100, 1000, 4096}) {
    for (int full = 0; full < n; full += 1 + n / 100) {
      Table row{n, 1, std::vector<float>(static_cast<std::size_t>(n))}, column{1, n, row.weights};
      row.weights[static_cast<std::size_t>(full)] = column.weights[static_cast<std::size_t>(full)] = 1;
      const PiecewiseConstant2D across = row.made(), down = column.made();
      for (const float u : {0.0f, 0x1p-24f, 0x1.fff8p-1f, 0x1.fffffep-1f}) {
        const auto a = across.sample({u, 0.5f}), d = down.sample({0.5f, u});
        ASSERT_EQ(across.pdf(a.position), a.pdf) << full << " of " << n << " columns, u = " << u;
        ASSERT_EQ(down.pdf(d.position), d.pdf) << full << " of " << n << " rows, u = " << u;
      }
    }
  }
}

TEST(PiecewiseConstant2D, EndsOfTheUnitSquareAreInsideIt) {
  for (const Table& t : {kUneven, random_table(9, 7), random_table(4096, 3), Table{1, 1, {2}}, Table{2, 1, {0, 1}},
                         Table{2, 1, {1, 0}}, Table{1, 2, {0, 1}}, Table{1, 2, {1, 0}}}) {
    const PiecewiseConstant2D made = t.made();
    for (const float x : kEnds)
      for (const float y : kEnds) {
        const auto s = made.sample({x, y});
        EXPECT_TRUE(s.position.x >= 0 && s.position.x < 1 && s.position.y >= 0 && s.position.y < 1);
        EXPECT_GT(s.pdf, 0);
        EXPECT_GT(t.weights[t.cell_of(s.position)], 0) << t.width << " x " << t.height << ", u = " << x << ", " << y;
      }
  }
}

TEST(PiecewiseConstant2D, NothingButZerosIsUniform) {
  constexpr int kN = 50000;
  const Table zeros{6, 3, std::vector<float>(18)};
  const PiecewiseConstant2D made = zeros.made();
  std::vector<double> observed(18), expected(18, kN / 18.0);
  for (std::uint32_t i = 0; i < kN; ++i) {
    const auto s = made.sample(random_pair(i));
    ASSERT_NEAR(s.pdf, 1, 2e-6);
    ASSERT_NEAR(made.pdf(s.position), 1, 2e-6);
    ++observed[zeros.cell_of(s.position)];
  }
  EXPECT_GT(chi_square_p_value(observed, expected), kChiSquareSignificance);
}

TEST(PiecewiseConstant2D, TheScaleOfTheWeightsDoesNotMatter) {
  const Table t = random_table(4, 4);
  for (const float scale : {1e-30f, 1e30f}) {
    Table scaled = t;
    for (float& w : scaled.weights) w *= scale;
    for (std::uint32_t i = 0; i < 100; ++i) {
      const auto a = t.made().sample(random_pair(i)), b = scaled.made().sample(random_pair(i));
      ASSERT_NEAR(a.position.x, b.position.x, 1e-5f) << scale;
      ASSERT_NEAR(a.position.y, b.position.y, 1e-5f) << scale;
      ASSERT_NEAR(a.pdf / b.pdf, 1, 1e-5) << scale;
    }
  }
}

}  // namespace
}  // namespace brume
