#include "app/pedals/theatre_settings.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <fstream>

#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::pedals {
namespace {

class Settings : public ::testing::Test {
 protected:
  [[nodiscard]] TheatreSettings load(const std::string& rest) const {
    std::ofstream(file()) << R"({"format": "arthronaut.theatre", "version": 1)" << rest << "}";
    return load_theatre_settings(file());
  }
  // What is said of it; empty: it is taken.
  [[nodiscard]] std::string refusal(const std::string& rest) const {
    try {
      (void)load(rest);
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_ / "theatre.json"; }
  const test::TemporaryFolder folder_;
};

TEST_F(Settings, AreTheUsualOnesWithoutAFile) {
  const TheatreSettings settings = load_theatre_settings(file());
  EXPECT_EQ(settings.codes.at(KEY_B), Pedal::DoIt);
  EXPECT_EQ(settings.keys.at(GLFW_KEY_PAGE_DOWN), Pedal::DoIt);
  EXPECT_FALSE(settings.screen_diagonal_in);
  EXPECT_EQ(key_of(Pedal::DoIt), GLFW_KEY_SPACE);
}

TEST_F(Settings, MapEveryPedalAnew) {
  const TheatreSettings settings =
      load(R"(, "screen_diagonal_in": 31.5, "foot_switches": ["/dev/input/by-id/x"],
    "pedals": {"do_it": ["KEY_Z", "184"], "back": ["BTN_LEFT"], "overlay": []},
    "keys": {"do_it": ["F8", "Page down"], "back": ["B"]})");
  EXPECT_EQ(*settings.screen_diagonal_in, 31.5);
  EXPECT_EQ(settings.foot_switches, std::vector<std::filesystem::path>{"/dev/input/by-id/x"});
  const std::map<int, Pedal> codes{{KEY_Z, Pedal::DoIt}, {184, Pedal::DoIt}, {BTN_LEFT, Pedal::Back}};
  EXPECT_EQ(settings.codes, codes) << "what the file names is all there is";
  const std::map<int, Pedal> keys{
      {GLFW_KEY_F8, Pedal::DoIt}, {GLFW_KEY_PAGE_DOWN, Pedal::DoIt}, {GLFW_KEY_B, Pedal::Back}};
  EXPECT_EQ(settings.keys, keys);
}

TEST_F(Settings, SayWhereTheScreenIsSentTo) {
  EXPECT_EQ(load("").screen_stream, "");
  EXPECT_EQ(load("").igtl_port, -1) << "nothing goes out unasked";
  EXPECT_EQ(load(R"(, "igtl_port": 18944)").igtl_port, 18944);
  EXPECT_FALSE(load(R"(, "igtl_port": 18944)").igtl_network) << "not to other machines unasked";
  EXPECT_TRUE(load(R"(, "igtl_port": 18944, "igtl_network": true)").igtl_network);
  EXPECT_NE(refusal(", \"igtl_network\": 1").find("igtl_network"), std::string::npos);
  for (const char* bad : {"-1", "65536", "\"18944\"", "1.5"})
    EXPECT_NE(refusal(", \"igtl_port\": " + std::string(bad)).find("igtl_port"), std::string::npos) << bad;
  EXPECT_EQ(load(R"(, "screen_stream": "udp://10.0.0.9:5004")").screen_stream, "udp://10.0.0.9:5004");
  for (const char* bad : {R"("tcp://10.0.0.9:5004")", R"("udp://10.0.0.9")", R"("")"})
    EXPECT_NE(refusal(", \"screen_stream\": " + std::string(bad)).find("screen_stream"), std::string::npos)
        << bad;
}

// File, place and reason, for whoever wrote it by hand.
TEST_F(Settings, SayWhatIsWrongWithTheFile) {
  struct Case {
    const char *rest, *place, *reason;
  };
  for (const Case& wrong :
       {Case{R"(, "pedals": {"do_it": ["KEY_NONE"]})", "pedals.do_it", "KEY_NONE"},
        Case{R"(, "pedals": {"do_it": ["0"]})", "pedals.do_it", "no key"},
        Case{R"(, "pedals": {"do_it": ["99999"]})", "pedals.do_it", "no key"},
        Case{R"(, "pedals": {"do_it": ["KEY_A"], "back": ["KEY_A"]})", "pedals.back", "two things"},
        Case{R"(, "keys": {"overlay": [""]})", "keys.overlay", "no key"},
        Case{R"(, "keys": {"overlay": ["Space"]})", "keys", "keep their meaning"},
        Case{R"(, "keys": {"overlay": "B"})", "keys.overlay", ""},
        Case{R"(, "screen_diagonal_in": -27)", "screen_diagonal_in", ""},
        Case{R"(, "screen_diagonal_in": 2000)", "screen_diagonal_in", "200 inches"},
        Case{R"(, "foot_switches": [7])", "foot_switches", ""}}) {
    const std::string said = refusal(wrong.rest);
    EXPECT_NE(said.find(file().string()), std::string::npos) << wrong.rest << ": " << said;
    EXPECT_NE(said.find(wrong.place), std::string::npos) << said;
    EXPECT_NE(said.find(wrong.reason), std::string::npos) << said;
  }
  std::ofstream(file()) << "{";
  EXPECT_THROW((void)load_theatre_settings(file()), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::pedals
