#include "app/report/session_rows.h"

#include <gtest/gtest.h>

namespace arthronaut::report {
namespace {

// A file may be called after its patient; nothing else is.
TEST(SessionRows, Hazard19ARecordingsFileIsNotNamed) {
  const auto neutral = [](const char* kind, const char* source) {
    recording::SessionHeader header;
    header.source_kind = kind;
    header.source = source;
    return neutral_source(header);
  };
  EXPECT_EQ(neutral("recording", "/media/Mueller, Jane.mkv"), "recording (mkv)");
  for (const char* named : {"Mueller_Jane", "Dr. Mueller Jane", "/media/Jane.Mueller"})
    EXPECT_EQ(neutral("recording", named), "recording") << named;
  EXPECT_EQ(neutral("", "Mueller_Jane"), "recording") << "an old session does not say of what kind it is";
  EXPECT_EQ(neutral("simulation", "Simulated operation: drill"), "Simulated operation: drill");
  for (const char* source :
       {"Capture card", "udp://127.0.0.1:5000", "rtsp://tower.or3/scope.sdp", "gst:videotestsrc ! appsink"})
    EXPECT_EQ(neutral("live", source), source);
}

}  // namespace
}  // namespace arthronaut::report
