// Messages as OpenIGTLink's own library packs them, whole, in pieces, spoilt and made up.
#include "navigation/openigtlink/igtl_reader.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/navigation/openigtlink/igtl_promises.h"

namespace arthronaut::openigtlink {
namespace {

using test::Bytes;

struct Heard : MessageListener {
  struct Pose {
    std::string device;
    std::optional<geometry::RigidTransform> pose;
    double stamp_utc_s;
  };
  void pose(std::string_view device, const std::optional<geometry::RigidTransform>& target_from_source,
            double stamp_utc_s) override {
    poses.push_back({std::string(device), target_from_source, stamp_utc_s});
  }
  void status(std::string_view device, bool is_ok, std::string_view words) override {
    statuses.push_back(std::string(device) + (is_ok ? " ok " : " not ok ") + std::string(words));
  }
  void refused(const std::string& why) override { refusals.push_back(why); }
  std::vector<Pose> poses;
  std::vector<std::string> statuses, refusals;
};

geometry::RigidTransform sent_pose() {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized())),
          {12.5, -80, 33}};
}

void expect_sent(const Heard& heard, const std::string& device) {
  ASSERT_EQ(heard.poses.size(), 1U);
  EXPECT_EQ(heard.poses[0].device, device);
  ASSERT_TRUE(heard.poses[0].pose);
  // Messages carry floats.
  EXPECT_LT((heard.poses[0].pose->translation_mm - sent_pose().translation_mm).norm(), 1e-4);
  EXPECT_LT(heard.poses[0].pose->rotation.angularDistance(sent_pose().rotation), 1e-6);
  EXPECT_NEAR(heard.poses[0].stamp_utc_s, 1.8e9 + 0.25, 1e-6);
  EXPECT_TRUE(heard.refusals.empty());
}

using test::seal;

TEST(IgtlReader, ReadsTransformsOfBothHeaderVersionsInPiecesOfAnySize) {
  for (const int version : {1, 2}) {
    const Bytes message = test::transform_message("Probe", sent_pose(), 1.8e9 + 0.25, version);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{58}, message.size()}) {
      Heard heard;
      IgtlReader reader(heard);
      for (std::size_t at = 0; at < message.size(); at += piece)
        EXPECT_TRUE(reader.take(std::span(message).subspan(at, std::min(piece, message.size() - at))));
      expect_sent(heard, "Probe");
      EXPECT_FALSE(reader.is_within_message());
    }
  }
}

TEST(IgtlReader, ReadsTrackingDataAsMatricesAndAsQuaternions) {
  Heard heard;
  IgtlReader reader(heard);
  EXPECT_TRUE(reader.take(test::matrix_message("Guide", sent_pose(), 1.8e9 + 0.25)));
  expect_sent(heard, "Guide");
  heard.poses.clear();
  EXPECT_TRUE(reader.take(test::quaternion_message("Drill", sent_pose(), 1.8e9 + 0.25)));
  expect_sent(heard, "Drill");
}

TEST(IgtlReader, ReadsStatusAndPassesOverTheRest) {
  Heard heard;
  IgtlReader reader(heard);
  EXPECT_TRUE(reader.take(test::status_message("Probe", false, "out of volume")));
  // A picture of 8 MB, of which nothing is kept.
  Bytes picture = test::status_message("Video", true, "");
  std::copy_n("IMAGE\0\0\0\0\0\0", 12, picture.begin() + 2);
  picture.resize(IgtlReader::kHeaderSize + 8'000'000);
  seal(picture);
  EXPECT_TRUE(reader.take(picture));
  EXPECT_TRUE(reader.take(test::transform_message("Probe", sent_pose(), 1.8e9 + 0.25)));
  expect_sent(heard, "Probe");
  EXPECT_EQ(heard.statuses, std::vector<std::string>{"Probe not ok out of volume"});
}

// A tool that its tracker does not see goes out with its last pose and a stamp of now; what tells stands in
// the metadata behind it.
TEST(IgtlReader, Hazard43AToolThatItsTrackerDoesNotSeeHasNoPose) {
  Heard heard;
  IgtlReader reader(heard);
  const Bytes plain = test::transform_message("Probe", sent_pose(), 1.8e9 + 0.25);
  EXPECT_TRUE(reader.take(test::as_version_2(plain, "MISSING")));
  EXPECT_TRUE(heard.poses.empty());
  EXPECT_EQ(heard.statuses, std::vector<std::string>{"Probe not ok MISSING"});
  EXPECT_TRUE(reader.take(test::as_version_2(plain, "OK")));
  expect_sent(heard, "Probe");
  // Sizes that do not fit into the metadata, and metadata that are cut off.
  for (const std::size_t at : {59 + 12 + 48 + 0, 59 + 12 + 48 + 2, 59 + 12 + 48 + 8}) {
    Bytes spoilt = test::as_version_2(plain, "MISSING");
    spoilt[at] = 200;
    seal(spoilt);
    EXPECT_TRUE(reader.take(spoilt)) << at;
  }
  EXPECT_EQ(heard.poses.size(), 1U);
  EXPECT_EQ(heard.refusals.size(), 3U);
}

TEST(IgtlReader, RefusesAWrongChecksumAndGoesOn) {
  Heard heard;
  IgtlReader reader(heard);
  Bytes spoilt = test::transform_message("Probe", sent_pose(), 1);
  spoilt[IgtlReader::kHeaderSize + 40] ^= 1;
  EXPECT_TRUE(reader.take(spoilt));
  EXPECT_TRUE(heard.poses.empty());
  ASSERT_EQ(heard.refusals.size(), 1U);
  EXPECT_NE(heard.refusals[0].find("checksum"), std::string::npos);
  heard.refusals.clear();
  EXPECT_TRUE(reader.take(test::transform_message("Probe", sent_pose(), 1.8e9 + 0.25)));
  expect_sent(heard, "Probe");
}

TEST(IgtlReader, RefusesWhatIsNoRigidPose) {
  const float bad[] = {2.F, -1.F, std::numeric_limits<float>::quiet_NaN()};
  for (const float factor : bad) {
    const auto message = igtl::TransformMessage::New();
    igtl::Matrix4x4 matrix;
    test::into_matrix(sent_pose(), matrix);
    for (int row = 0; row < 3; ++row) matrix[row][0] *= factor;  // stretched, mirrored, not a number
    message->SetMatrix(matrix);
    Heard heard;
    IgtlReader reader(heard);
    EXPECT_TRUE(reader.take(test::packed(*message, "Probe", 1)));
    ASSERT_EQ(heard.poses.size(), 1U);
    EXPECT_FALSE(heard.poses[0].pose) << factor;
  }
}

TEST(IgtlReader, RefusesLengthsThatDoNotFitWithoutHarm) {
  Heard heard;
  IgtlReader reader(heard);
  // A transform that is too short, a tracking datum and a half, an extended header longer than the body.
  for (const std::size_t size : {std::size_t{0}, std::size_t{47}, std::size_t{105}}) {
    for (const char* type : {"TRANSFORM", "TDATA", "QTDATA", "STATUS"}) {
      for (const int version : {1, 2}) {
        Bytes message = test::transform_message("Probe", sent_pose(), 1);
        message[1] = static_cast<std::uint8_t>(version);
        std::fill_n(message.begin() + 2, 12, std::uint8_t{0});
        std::copy_n(type, std::char_traits<char>::length(type), message.begin() + 2);
        message.resize(IgtlReader::kHeaderSize + size, 0xFF);
        seal(message);
        EXPECT_TRUE(reader.take(message)) << type << size;
      }
    }
  }
  for (const Heard::Pose& pose : heard.poses) EXPECT_FALSE(pose.pose);
  // One that claims to be too large for what it is: said before it comes, and passed over.
  heard.refusals.clear();
  Bytes large = test::transform_message("Probe", sent_pose(), 1);
  large.resize(IgtlReader::kHeaderSize + 10 * IgtlReader::kMostBody);
  seal(large);
  EXPECT_TRUE(reader.take(large));
  ASSERT_EQ(heard.refusals.size(), 1U);
  EXPECT_NE(heard.refusals[0].find("too large"), std::string::npos);
  EXPECT_TRUE(reader.take(test::transform_message("Probe", sent_pose(), 1.8e9 + 0.25)));
}

TEST(IgtlReader, WhatIsNoOpenIgtLinkEndsIt) {
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i) {
    Bytes noise(4000);
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random());
    Heard heard;
    IgtlReader reader(heard);
    EXPECT_FALSE(reader.take(noise));
    EXPECT_TRUE(heard.poses.empty());
  }
  Heard heard;
  IgtlReader reader(heard);
  const std::string web = "HTTP/1.1 400 Bad Request\r\nContent-Type: text/plain\r\nConnection: close\r\n\r\n";
  EXPECT_FALSE(reader.take(Bytes(web.begin(), web.end())));
}

// Any byte of a message's body changed: what is read is what was sent, or nothing. The header, with name and
// stamp, is not under the checksum.
TEST(IgtlReader, NoChangedByteMakesAnotherPose) {
  const Bytes message = test::transform_message("Probe", sent_pose(), 1.8e9 + 0.25, 2);
  for (std::size_t at = IgtlReader::kHeaderSize; at < message.size(); ++at) {
    Bytes changed = message;
    changed[at] ^= 0x20;
    Heard heard;
    IgtlReader reader(heard);
    EXPECT_TRUE(reader.take(changed));
    EXPECT_TRUE(heard.poses.empty()) << at;
  }
}

// Messages whose every part was made up by somebody who knows how to make a checksum: what comes of them is a
// pose, or nothing.
TEST(IgtlReader, MadeUpMessagesGiveRigidPosesOrNone) {
  std::mt19937 random(17);
  const std::vector<Bytes> seeds{test::transform_message("Probe", sent_pose(), 1.8e9),
                                 test::transform_message("Probe", sent_pose(), 1.8e9, 2),
                                 test::status_message("Probe", true, "all is well")};
  long poses = 0;
  for (int i = 0; i < 20'000; ++i) {
    Bytes message = seeds[random() % seeds.size()];
    if (i % 4 == 0) std::copy_n("TDATA\0\0\0\0", 9, message.begin() + 2);
    if (i % 4 == 1) std::copy_n("QTDATA\0\0\0", 9, message.begin() + 2);
    if (i % 3 == 0) message.resize(IgtlReader::kHeaderSize + random() % 300);
    const std::size_t body = message.size() - IgtlReader::kHeaderSize;
    for (std::size_t k = 0; body > 0 && k < 1 + random() % 4; ++k)
      message[IgtlReader::kHeaderSize + random() % body] = static_cast<std::uint8_t>(random());
    seal(message);
    Heard heard;
    IgtlReader reader(heard);
    ASSERT_TRUE(reader.take(message));
    for (const Heard::Pose& pose : heard.poses) {
      ++poses;
      if (!pose.pose) continue;
      ASSERT_TRUE(pose.pose->translation_mm.allFinite());
      ASSERT_NEAR(pose.pose->rotation.norm(), 1, 1e-9);
    }
  }
  EXPECT_GT(poses, 1000);
}

// Streams of messages that were spoilt anywhere, also in their headers, cut, doubled and put out of order, as
// they came and with checksums that are right: the fuzzer's promises, for a fixed seed.
TEST(IgtlReader, KeepsItsPromisesOfSpoiltStreams) {
  std::mt19937 random(29);
  std::vector<Bytes> examples;
  for (const auto& [name, message] : test::igtl_examples()) {
    ASSERT_EQ(test::broken_promise(message), "") << name;
    examples.push_back(message);
  }
  long poses = 0;
  for (int i = 0; i < 5'000; ++i) {
    Bytes stream;
    for (std::size_t k = 0; k < 1 + random() % 4; ++k) {
      const Bytes& next = examples[random() % examples.size()];
      stream.insert(stream.end(), next.begin(), next.end());
    }
    for (std::size_t k = random() % 6; k > 0; --k) {
      const std::size_t at = random() % stream.size();
      switch (random() % 4) {
        case 0:
          stream[at] = static_cast<std::uint8_t>(random());
          break;
        case 1:
          stream[at] ^= static_cast<std::uint8_t>(1U << random() % 8);
          break;
        case 2:
          stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(at), std::uint8_t{0xFF});
          break;
        default:
          stream.resize(std::max(at, std::size_t{1}));
          break;
      }
    }
    ASSERT_EQ(test::broken_promise(stream, &poses), "") << i;
    test::seal_all(stream);
    ASSERT_EQ(test::broken_promise(stream, &poses), "") << i;
  }
  EXPECT_GT(poses, 5'000) << "most of what is read is still read";
}

}  // namespace
}  // namespace arthronaut::openigtlink
