// Packets of the transport made by hand (ISO/IEC 13818-1, 2.4.3): what is put in, and that nothing else is.
#include "navigation/sources/transport_ends.h"

#include <gtest/gtest.h>

namespace arthronaut::sources {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr int kPid = 256;
constexpr std::size_t kPacket = 188;

// adaptation: its bytes after its length; stuffing beside them. The payload counts on.
Bytes packet(int pid, bool begins, int count, const Bytes& adaptation = {}, std::size_t stuffing = 0) {
  Bytes made{0x47, static_cast<std::uint8_t>((begins ? 0x40 : 0) | pid >> 8), static_cast<std::uint8_t>(pid)};
  const bool adapts = !adaptation.empty() || stuffing > 0;
  made.push_back(static_cast<std::uint8_t>((adapts ? 0x30 : 0x10) | count));
  if (adapts) {
    made.push_back(static_cast<std::uint8_t>(adaptation.size() + stuffing));
    made.insert(made.end(), adaptation.begin(), adaptation.end());
    made.insert(made.end(), stuffing, 0xFF);
  }
  for (std::uint8_t i = 0; made.size() < kPacket; ++i) made.push_back(i);
  return made;
}
Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}
// A time of the programme's clock (PCR), and nothing else.
const Bytes kClock{0x10, 1, 2, 3, 4, 5, 6};

struct Passed {
  TransportEnds ends;
  Bytes all;
  explicit Passed(const Bytes& came, int pid = kPid) {
    ends.follow(pid);
    ends.pass_on(came, all);
  }
};

// A picture of three packets: behind its last one, which is stuffed, an empty one begins, counted as that
// one.
TEST(TransportEnds, EndAPictureBehindItsLastByte) {
  const Bytes first = packet(kPid, true, 4, kClock), second = packet(kPid, false, 5),
              last = packet(kPid, false, 6, {0}, 40), other = packet(17, true, 0, {0}, 100);
  const Passed passed(other + first + second + last + other);
  ASSERT_EQ(passed.all.size(), 6 * kPacket);
  const auto piece = [&](std::size_t i) {
    return Bytes(passed.all.begin() + static_cast<std::ptrdiff_t>(i * kPacket),
                 passed.all.begin() + static_cast<std::ptrdiff_t>((i + 1) * kPacket));
  };
  EXPECT_EQ(piece(0) + piece(1) + piece(2) + piece(3), other + first + second + last);
  EXPECT_EQ(piece(5), other);
  const Bytes put_in = piece(4);
  EXPECT_EQ(Bytes(put_in.begin(), put_in.begin() + 6), (Bytes{0x47, 0x41, 0x00, 0x36, 174, 0x80}));
  EXPECT_EQ(Bytes(put_in.end() - 9, put_in.end()), (Bytes{0, 0, 1, 0xE0, 0, 0, 0x80, 0, 0}));
  EXPECT_TRUE(passed.ends.was_ended(kPacket)) << "where the picture began";
  EXPECT_FALSE(passed.ends.was_ended(0));
}

// Where what it does not need is one byte, or two: the adaptation's length alone, and its flags.
TEST(TransportEnds, SeeTheShortestStuffing) {
  Bytes one = packet(kPid, false, 2, {0});
  one[4] = 0;
  for (const Bytes& last : {one, packet(kPid, false, 2, {0})})
    EXPECT_EQ(Passed(packet(kPid, true, 1) + last).all.size(), 3 * kPacket);
}

// What fills its last packet, what is of another stream, and an adaptation that says something, end nothing.
TEST(TransportEnds, PutNothingInElse) {
  const Bytes full = packet(kPid, true, 1, kClock) + packet(kPid, false, 2) + packet(kPid, true, 3);
  EXPECT_EQ(Passed(full).all, full);
  const Bytes clock_between = packet(kPid, true, 1) + packet(kPid, false, 2, kClock) + packet(kPid, false, 3);
  EXPECT_EQ(Passed(clock_between).all, clock_between);
  const Bytes priv = packet(kPid, true, 1) + packet(kPid, false, 2, {0x02, 3, 7, 7, 7});
  EXPECT_EQ(Passed(priv).all, priv);
  const Bytes picture = packet(kPid, true, 1) + packet(kPid, false, 2, {0}, 9);
  EXPECT_EQ(Passed(picture, -1).all, picture) << "none is followed";
  EXPECT_EQ(Passed(picture, 300).all, picture);
  const Bytes begun_before = packet(kPid, false, 2, {0}, 9);
  EXPECT_EQ(Passed(begun_before).all, begun_before) << "its beginning was not seen";
}

// What is no transport is passed on as it came.
TEST(TransportEnds, PassOnWhatTheyDoNotKnow) {
  for (const Bytes& came :
       {Bytes(100, 7), Bytes(kPacket, 7), packet(kPid, true, 1) + Bytes{1, 2, 3}, Bytes()})
    EXPECT_EQ(Passed(came).all, came);
}

}  // namespace
}  // namespace arthronaut::sources
