#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/film/image_io.h"
#include "tests/cli/program.h"

namespace brume {
namespace {

/// Two pictures that differ in ways whose numbers can be told by hand.
class CompareCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    Image reference(8, 4), test(8, 4);
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x) {
        reference.at(x, y) = Color(0.5f);
        test.at(x, y) = Color(x < 4 ? 0.5f : 0.75f);  // half of it brighter by a quarter
      }
    ASSERT_TRUE(write_exr(path("reference.exr"), reference));
    ASSERT_TRUE(write_exr(path("test.exr"), test));
    ASSERT_TRUE(write_exr(path("small.exr"), Image(4, 4)));
    test.at(3, 2).g = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(write_exr(path("nan.exr"), test));
  }
};

TEST_F(CompareCommand, PrintsTheMetricsAndTheirNumbers) {
  const Outcome o = run({"compare", "test.exr", "reference.exr", "--json"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto json = nlohmann::json::parse(o.out);
  EXPECT_NEAR(json["rmse"], 0.25 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(json["relative_mse"], 0.5 * 0.0625 / (0.25 + 0.01), 1e-9);
  EXPECT_NEAR(json["mean_bias"], 0.125, 1e-9);
  EXPECT_NEAR(json["relative_mean_bias"], 0.25, 1e-9);
  EXPECT_NEAR(json["median_of_tiles"], 0.25 / std::sqrt(2.0), 1e-9);
  EXPECT_GT(json["flip"], 0.01);
  EXPECT_LT(json["flip"], 0.5);
  EXPECT_GT(json["hdr_flip"], 0.01);
  EXPECT_LT(json["hdr_flip"], 0.5);

  const Outcome text = run({"compare", "test.exr", "reference.exr", "--metric", "mean_bias"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.out.find("0.125"), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("rmse"), std::string::npos) << text.out;
}

TEST_F(CompareCommand, WhatABlackReferenceLeavesUndefinedIsLeftEmpty) {
  ASSERT_TRUE(write_exr(path("black.exr"), Image(8, 4)));
  const Outcome o = run({"compare", "test.exr", "black.exr", "--json"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto json = nlohmann::json::parse(o.out);
  EXPECT_TRUE(json["relative_mean_bias"].is_null());
  EXPECT_NEAR(json["mean_bias"], 0.625, 1e-6);
  expect_refused({"compare", "test.exr", "black.exr", "--metric", "relative_mean_bias"}, "black");
}

TEST_F(CompareCommand, ExitCodeThreeBeyondTheThreshold) {
  EXPECT_EQ(run({"compare", "test.exr", "reference.exr", "--metric", "rmse", "--threshold", "0.1"}).exit_code, 3);
  EXPECT_EQ(run({"compare", "test.exr", "reference.exr", "--metric", "rmse", "--threshold", "0.2"}).exit_code, 0);
  // A picture that is too dark is as wrong as one that is too bright.
  EXPECT_EQ(run({"compare", "reference.exr", "test.exr", "--metric", "mean_bias", "--threshold", "0.1"}).exit_code, 3);
  expect_refused({"compare", "test.exr", "reference.exr", "--threshold", "0.1"}, "--threshold: found no single metric");
}

TEST_F(CompareCommand, HdrFlipNeedsNoExposure) {
  const auto value = [&](const std::string& metric, const std::string& exposure) {
    const Outcome o = run({"compare", "test.exr", "reference.exr", "--json", "--metric", metric, exposure});
    return o.exit_code == 0 ? nlohmann::json::parse(o.out)[metric].get<double>() : -1;
  };
  EXPECT_GT(value("hdr_flip", "--exposure=0"), 0.01);
  EXPECT_EQ(value("hdr_flip", "--exposure=4"), value("hdr_flip", "--exposure=0"));
  EXPECT_GT(value("flip", "--exposure=0"), 0.01);
  EXPECT_EQ(value("flip", "--exposure=4"), 0);  // both white
}

TEST_F(CompareCommand, HdrFlipTakesARangeOfExposures) {
  const auto value = [&](const std::vector<std::string>& range) {
    std::vector<std::string> args{"compare", "test.exr", "reference.exr", "--json", "--metric", "hdr_flip"};
    args.insert(args.end(), range.begin(), range.end());
    const Outcome o = run(args);
    return o.exit_code == 0 ? nlohmann::json::parse(o.out)["hdr_flip"].get<double>() : -1;
  };
  EXPECT_LT(value({"--start-exposure=-14", "--stop-exposure=-12"}), 0.2 * value({})) << "almost black";
  EXPECT_GT(value({"--start-exposure=-14", "--stop-exposure=0"}), 0.01);
  expect_refused({"compare", "test.exr", "reference.exr", "--start-exposure", "2", "--stop-exposure", "1"},
                 "--stop-exposure: found 1, expected more than --start-exposure, which is 2");
}

TEST_F(CompareCommand, DrawsTheDifference) {
  ASSERT_EQ(run({"compare", "test.exr", "reference.exr", "-o", "difference.png"}).exit_code, 0);
  const auto difference = read_png(path("difference.png"));
  ASSERT_TRUE(difference);
  EXPECT_EQ(difference->image.width, 8);
  const auto brightness = [&](int x) {
    const std::uint8_t* p = difference->image.at(x, 2);
    return p[0] + p[1] + p[2];
  };
  EXPECT_GT(brightness(6), brightness(0) + 30);
}

TEST_F(CompareCommand, APngIsTakenAsSrgb) {
  Image8 grey(8, 4, 3);
  for (std::uint8_t& b : grey.bytes) b = 188;  // 0.5 in linear light
  ASSERT_TRUE(write_png(path("grey.png"), grey));
  const Outcome o = run({"compare", "grey.png", "reference.exr", "--json", "--metric", "rmse"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_LT(nlohmann::json::parse(o.out)["rmse"], 0.004);
}

TEST_F(CompareCommand, RefusesWhatCannotBeCompared) {
  expect_refused({"compare", "small.exr", "reference.exr"}, "small.exr: ");
  expect_refused({"compare", "nan.exr", "reference.exr"}, "nan.exr: ");
  expect_refused({"compare", "reference.exr", "nan.exr", "--metric", "flip"}, "nan.exr: ");
  expect_refused({"compare", "missing.exr", "reference.exr"}, "missing.exr: ");
  expect_refused({"compare", "test.exr", "reference.exr", "--metric", "beauty"}, "--metric: found \"beauty\"");
  expect_refused({"compare", "test.exr", "reference.exr", "-o", "difference.jpg"}, "difference.jpg");
  EXPECT_FALSE(exists("difference.jpg"));
}

}  // namespace
}  // namespace brume
