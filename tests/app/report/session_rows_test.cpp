#include "app/report/session_rows.h"

#include <gtest/gtest.h>

namespace arthronaut::report {
namespace {

// A file may be called after its patient; nothing else is.
TEST(SessionRows, Hazard19ARecordingsFileIsNotNamed) {
  EXPECT_EQ(neutral_source("/media/Mueller, Jane.mkv"), "recording (mkv)");
  for (const char* source : {"Capture card", "Simulated operation: drill", "udp://127.0.0.1:5000",
                             "rtsp://tower.or3/scope.sdp", "gst:videotestsrc ! appsink"})
    EXPECT_EQ(neutral_source(source), source);
}

}  // namespace
}  // namespace arthronaut::report
