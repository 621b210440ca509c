// Faults of a live source, put into a stream that another process sends, in an order that the seed says: each
// is told in words, guides nobody meanwhile, and the operation goes on by itself. How quickly is measured by
// tests/benchmarks/live_chain.cpp: here it is only bounded, since a machine that does much else is slow.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/live/fault_drill.h"

namespace arthronaut::test {
namespace {

class SourceFaults : public ::testing::Test {
 protected:
  static std::vector<Fault> all_faults() {
    std::vector<Fault> faults;
    for (int i = 0; i < kFaultCount; ++i) faults.push_back(static_cast<Fault>(i));
    return faults;
  }
  static void expect_told_and_overcome(std::vector<Fault> faults, const std::string& codec) {
    constexpr unsigned kSeed = 13;
    constexpr double kLasts_s = 0.8, kPatience_s = 20;
    std::shuffle(faults.begin(), faults.end(), std::mt19937(kSeed));
    FaultDrill drill(codec);
    const long frames_before = drill.live().latest()->operation->frame_count;
    for (const Fault fault : faults) {
      const FaultOutcome outcome = drill.run(fault, kLasts_s, kPatience_s);
      if (fault != Fault::Torn && fault != Fault::Repeated) {
        EXPECT_GE(outcome.gone_s, 0) << to_text(fault);
      }
      EXPECT_GE(outcome.told_s, 0) << to_text(fault);
      EXPECT_FALSE(outcome.words.empty()) << to_text(fault);
      EXPECT_GE(outcome.back_s, 0) << to_text(fault);
      RecordProperty(to_text(fault), outcome.words);
      std::printf("%-22s gone %.3f s, told %.3f s, back %.3f s: %s\n", to_text(fault).c_str(), outcome.gone_s,
                  outcome.told_s, outcome.back_s, outcome.words.c_str());
    }
    EXPECT_EQ(drill.live().latest()->phase, theatre::LiveState::Phase::Running);
    EXPECT_GT(drill.live().latest()->operation->frame_count, frames_before + 30)
        << "one source all the while";
    EXPECT_EQ(drill.live().failure(), "");
  }
};

TEST_F(SourceFaults, AreToldAndOvercome) { expect_told_and_overcome(all_faults(), "jpeg"); }

// Read picture by picture (rtsp_pictures.h), torn and repeated before they are coded.
TEST_F(SourceFaults, OfAnH264StreamAreToldAndOvercome) { expect_told_and_overcome(all_faults(), "h264"); }

}  // namespace
}  // namespace arthronaut::test
