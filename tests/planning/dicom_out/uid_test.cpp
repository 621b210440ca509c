#include "planning/dicom_out/uid.h"

#include <gtest/gtest.h>

#include <set>

namespace arthronaut::dicom_out {
namespace {

// The decimal number back as 32 hexadecimal digits.
std::string hexadecimal(const std::string& uid) {
  std::string digits = uid.substr(5), hex;
  while (!digits.empty()) {
    int rest = 0;
    std::string quotient;
    for (const char c : digits) {
      rest = 10 * rest + (c - '0');
      if (!quotient.empty() || rest >= 16) quotient += static_cast<char>('0' + rest / 16);
      rest %= 16;
    }
    hex.insert(hex.begin(), "0123456789abcdef"[rest]);
    digits = quotient;
  }
  return std::string(32 - hex.size(), '0') + hex;
}

TEST(Uid, IsAUuidOfVersion8InDecimal) {
  for (int i = 0; i < 100; ++i) {
    const std::string uid = uid_of("test", std::to_string(i));
    EXPECT_EQ(uid.substr(0, 5), "2.25.");
    EXPECT_NE(uid[5], '0');
    EXPECT_TRUE(is_uid(uid));
    const std::string hex = hexadecimal(uid);
    EXPECT_EQ(hex[12], '8');
    EXPECT_TRUE(hex[16] >= '8' && hex[16] <= 'b') << hex;
  }
}

TEST(Uid, FollowsFromPurposeAndContents) {
  EXPECT_EQ(uid_of("a", "b"), uid_of("a", "b"));
  const std::set<std::string> uids{uid_of("a", "b"), uid_of("b", "a"), uid_of("ab", ""), uid_of("", "ab"),
                                   uid_of("a", "c")};
  EXPECT_EQ(uids.size(), 5U);
}

TEST(Uid, OnesOfOthersAreTold) {
  EXPECT_TRUE(is_uid("1.2.840.10008.5.1.4.1.1.2"));
  for (const std::string& text : {std::string(), std::string("1.2."), std::string(".1"), std::string("1.2 3"),
                                  std::string("1\\2"), std::string(65, '1')})
    EXPECT_FALSE(is_uid(text)) << text;
}

}  // namespace
}  // namespace arthronaut::dicom_out
