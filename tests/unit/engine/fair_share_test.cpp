#include "renderer/engine/fair_share.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace brume {
namespace {

/// Jobs whose passes cost `cost[i]` seconds, in slices of at most `slice`, until `seconds` have been spent.
std::vector<Turn> simulate(const std::vector<double>& cost, Share share, double slice, double seconds) {
  std::vector<Turn> jobs(cost.size(), {.waits = true, .shown = true, .samples = 0, .cpu_seconds = 0});
  for (double spent = 0; spent < seconds;) {
    const std::size_t i = next_turn(jobs, share).value();
    const double turn = std::min(slice, cost[i]);
    jobs[i].cpu_seconds += turn;
    jobs[i].samples += turn / cost[i];
    spent += turn;
  }
  return jobs;
}

TEST(FairShare, EqualTimeIsEqualWhateverAPassCosts) {
  const auto jobs = simulate({0.003, 0.05, 1.7, 11}, Share::EqualTime, 0.1, 40);
  for (const Turn& job : jobs) EXPECT_NEAR(job.cpu_seconds, 10, 0.1);
}

TEST(FairShare, EqualSamplesAreEqualWhateverAPassCosts) {
  const auto jobs = simulate({0.003, 0.05, 0.4}, Share::EqualSamples, 0.1, 100);
  for (const Turn& job : jobs) EXPECT_NEAR(job.samples, 100 / 0.453, 1);
}

TEST(FairShare, ALateJobCatchesUp) {
  std::vector<Turn> jobs{{true, true, 10, 5}, {true, true, 0, 0}};
  EXPECT_EQ(next_turn(jobs, Share::EqualTime), 1u);
  jobs[1].cpu_seconds = 5.01;
  EXPECT_EQ(next_turn(jobs, Share::EqualTime), 0u);
}

TEST(FairShare, WhatHasShownNothingGoesFirstInTurn) {
  const std::vector<Turn> jobs{{true, false, 0, 9}, {true, true, 0, 0}, {true, false, 0, 0}};
  EXPECT_EQ(next_turn(jobs, Share::EqualTime, 0), 0u);
  EXPECT_EQ(next_turn(jobs, Share::EqualTime, 1), 2u);
  EXPECT_EQ(next_turn(jobs, Share::EqualTime, 3), 0u);
}

TEST(FairShare, NobodyWaitsNobodyIsNext) {
  EXPECT_FALSE(next_turn({}, Share::EqualTime));
  const std::vector<Turn> jobs{{false, false, 0, 0}, {false, true, 0, 0}};
  EXPECT_FALSE(next_turn(jobs, Share::EqualSamples, 7));
}

}  // namespace
}  // namespace brume
