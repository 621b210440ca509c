#include "planning/pacs/connection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"

namespace arthronaut::pacs {
namespace {

using ::testing::HasSubstr;

std::string refusal_of(const std::string& text) {
  try {
    (void)parse_peer(text);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(PacsPeer, IsReadAndWritten) {
  const Peer peer = parse_peer("MAIN PACS@pacs-1.hospital.example:11112");
  EXPECT_EQ(peer.ae_title, "MAIN PACS");
  EXPECT_EQ(peer.host, "pacs-1.hospital.example");
  EXPECT_EQ(peer.port, 11112);
  EXPECT_EQ(to_text(peer), "MAIN PACS@pacs-1.hospital.example:11112");
}

TEST(PacsPeer, SaysWhatIsWrongWithIt) {
  EXPECT_THAT(refusal_of("pacs:104"), HasSubstr("has no AE title"));
  EXPECT_THAT(refusal_of("PACS@host"), HasSubstr("has no port"));
  EXPECT_THAT(refusal_of("PACS@:104"), HasSubstr("host"));
  EXPECT_THAT(refusal_of("PACS@ho st:104"), HasSubstr("host"));
  EXPECT_THAT(refusal_of("PACS@[::1]:104"), HasSubstr("[::1] is an IPv6 address"));
  EXPECT_THAT(refusal_of("PACS@2001:db8::1:104"), HasSubstr("is an IPv6 address"));
  EXPECT_THAT(refusal_of("@host:104"), HasSubstr("AE title"));
  EXPECT_THAT(refusal_of("SEVENTEENLETTERS!@host:104"), HasSubstr("1 to 16"));
  for (const char* text : {"PACS@host:0", "PACS@host:65536", "PACS@host:", "PACS@host:10x", "PACS@host:-1"})
    EXPECT_THAT(refusal_of(text), HasSubstr("1 to 65535")) << text;
}

TEST(PacsUid, IsDigitsAndDots) {
  EXPECT_TRUE(is_uid("1.2.840.10008.5.1.4.1.1.2"));
  EXPECT_TRUE(is_uid(std::string(64, '1')));
  for (const std::string& text :
       {std::string(), std::string(65, '1'), std::string("1..2"), std::string("../etc"), std::string(".1"),
        std::string("1."), std::string("1.2/3"), std::string("1.2\n")})
    EXPECT_FALSE(is_uid(text)) << text;
}

TEST(PacsConnection, OptionsSayTheirLimits) {
  const auto refusal = [](const ConnectionOptions& options) {
    try {
      check(options);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal({}), "");
  ConnectionOptions options;
  options.answer_timeout_s = 0;
  EXPECT_THAT(refusal(options), HasSubstr("answer_timeout_s"));
  options = {};
  options.retries = -1;
  EXPECT_THAT(refusal(options), HasSubstr("retries"));
  options = {};
  options.our_ae_title = "A\\B";
  EXPECT_THAT(refusal(options), HasSubstr("our AE title"));
  options = {};
  options.tls.emplace();
  EXPECT_THAT(refusal(options), HasSubstr("our certificate"));
  options.tls->certificate = "/none/c.pem";
  EXPECT_THAT(refusal(options), HasSubstr("/none/c.pem"));
}

}  // namespace
}  // namespace arthronaut::pacs
