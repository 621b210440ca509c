#include "planning/files/json_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::files {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view kFormat = "arthronaut.test";
const std::string kWhole =
    R"({"format": "arthronaut.test", "version": 1, "n": 2.5, "i": 7, "b": true, "s": "x", "v": [1, 2, 3],
        "t": ["a", "b"], "o": {"k": [{"x": 1}, {"y": -0.5}]}, "pose": {"q_wxyz": [2.0006, 0, 0, 0], "t_mm": [1, 2, 3]}})";

JsonObject parse(std::string_view text) { return parse_json(text, "a.json", kFormat, 1); }

TEST(JsonDocument, ReadsWhatIsThere) {
  std::string text = kWhole;
  text.replace(text.find("2.0006"), 6, "1.0006");
  const JsonObject root = parse(text);
  EXPECT_EQ(root.number("n"), 2.5);
  EXPECT_EQ(root.integer("i"), 7);
  EXPECT_TRUE(root.boolean("b"));
  EXPECT_EQ(root.text("s"), "x");
  EXPECT_EQ(root.vector3("v"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(root.texts("t"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(root.object("o").objects("k")[1].number("y"), -0.5);
  EXPECT_NEAR(root.rigid_transform("pose").rotation.norm(), 1, 1e-12);
  EXPECT_FALSE(root.has("absent"));
}

TEST(JsonDocument, EveryMissNamesFilePlaceAndReason) {
  const JsonObject root = parse(kWhole);
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)root.number("absent"); }),
              AllOf(HasSubstr("a.json: absent: is missing")));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)root.object("o").objects("k")[1].number("z"); }),
              HasSubstr("a.json: o.k[1].z: is missing"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)root.vector2("v"); }), HasSubstr("holds 3"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)root.rigid_transform("pose"); }), HasSubstr("unit norm"));
  EXPECT_THROW((void)root.integer("n"), InvalidInput);
  EXPECT_THROW((void)root.number("s"), InvalidInput);
  EXPECT_THROW((void)root.boolean("i"), InvalidInput);
  EXPECT_THROW((void)root.objects("v"), InvalidInput);
  EXPECT_THAT(message_of<InvalidInput>([] { (void)parse("{\n\"format\": ,"); }), HasSubstr("line 2"));
}

TEST(JsonDocument, RefusesAnotherFormatOrANewerVersion) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)parse(R"({"format": "other", "version": 1})"); }),
              HasSubstr("other"));
  EXPECT_THAT(message_of<InvalidInput>([] { (void)parse(R"({"format": "arthronaut.test", "version": 2})"); }),
              HasSubstr("newer"));
  EXPECT_THROW((void)parse(R"({"format": "arthronaut.test", "version": 0})"), InvalidInput);
  EXPECT_THROW((void)parse(R"({"format": "arthronaut.test", "version": 1.0})"), InvalidInput);
  EXPECT_THROW((void)parse(R"({"format": "arthronaut.test"})"), InvalidInput);
  EXPECT_THROW((void)parse("[]"), InvalidInput);
  EXPECT_THROW((void)parse(""), InvalidInput);
}

// Of two values nobody knows which is meant. The same key in two objects is none of that.
TEST(JsonDocument, AKeyThatStandsTwiceIsRefused) {
  const std::string start = "{\"format\": \"arthronaut.test\", \"version\": 1,\n";
  EXPECT_THAT(message_of<InvalidInput>([&] {
                (void)parse(start +
                            "\"s\": \"a \\\" \\\\\", \"o\": [{\"size_mm\" : 4},\n {\"size_mm\": 4,\n"
                            "  \"size_mm\": 40}]}");
              }),
              HasSubstr("a.json: line 4, column 3: the key \"size_mm\" stands twice"));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)parse(start + "\"version\": 1}"); }),
              HasSubstr("line 2, column 1"));
  EXPECT_NO_THROW((void)parse(start + "\"o\": {\"k\": {\"k\": [{\"k\": 1}, {\"k\": 2}]}}, \"k\": null}"));
}

// An integer beyond 64 bits, signed, would wrap into another number.
TEST(JsonDocument, IntegersThatDoNotFitAreRefused) {
  const JsonObject root = parse(
      R"({"format": "arthronaut.test", "version": 1, "i": 18446744073709551615, "j": 9223372036854775807})");
  EXPECT_EQ(root.integer("j"), 9223372036854775807);
  EXPECT_THROW((void)root.integer("i"), InvalidInput);
}

// 2^32 + 4 is not 4.
TEST(JsonDocument, AnIntegerThatAnIntDoesNotHoldIsRefused) {
  const JsonObject root =
      parse(R"({"format": "arthronaut.test", "version": 1, "o": {"id": 4294967300, "least": -2147483648}})");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)root.object("o").int32("id"); }),
              HasSubstr("a.json: o.id: is out of range"));
  EXPECT_EQ(root.object("o").int32("least"), -2147483647 - 1);
}

// Also where a text before it reads like it.
TEST(JsonDocument, ANumberThatNoDoubleHoldsIsToldWithItsPlace) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)parse("{\"s\": \"1e999\",\n \"n\": -1e999}"); }),
              HasSubstr("a.json: line 2, column 7: holds a number out of range"));
}

TEST(JsonDocument, WritesWholeAndFiniteOrNothing) {
  const TemporaryFolder folder;
  nlohmann::ordered_json document = {{"format", kFormat}, {"version", 1}, {"x", {1.0, 0.1, 1e-300}}};
  write_json(folder / "a.json", document);
  const JsonObject back = read_json(folder / "a.json", kFormat, 1);
  EXPECT_EQ(back.numbers("x"), (std::vector<double>{1.0, 0.1, 1e-300}));
  document["x"][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of<InvalidInput>([&] { write_json(folder / "a.json", document); }), HasSubstr("x[1]"));
  EXPECT_EQ(read_json(folder / "a.json", kFormat, 1).numbers("x")[1], 0.1);
  EXPECT_EQ(folder.names().size(), 1U);
}

// Text that is not UTF-8, from a file name say, must not end the program.
TEST(JsonDocument, TextThatIsNoUtf8IsStillWritten) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(write_json(folder / "a.json", {{"format", kFormat}, {"version", 1}, {"s", "f\xe9mur"}}));
  EXPECT_NO_THROW((void)read_json(folder / "a.json", kFormat, 1));
}

// Broken documents: values, or InvalidInput, and nothing else.
TEST(JsonDocument, BrokenTextGivesValuesOrInvalidInput) {
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int i = 0; i < 5000; ++i) {
    std::string broken = kWhole;
    for (std::size_t n = 1 + below(3); n > 0; --n) {
      const std::size_t at = below(broken.size());
      switch (below(4)) {
        case 0:
          broken[at] = static_cast<char>(below(256));
          break;
        case 1:
          broken.erase(at, 1 + below(6));
          break;
        case 2:
          broken.insert(at, below(2) ? "1e999" : "{[,");
          break;
        default:
          broken.resize(at + 1);
      }
      if (broken.empty()) broken = "{";
    }
    try {
      const JsonObject root = parse(broken);
      EXPECT_TRUE(std::isfinite(root.number("n")));
      (void)root.integer("i");
      (void)root.vector3("v");
      (void)root.object("o").objects("k");
      (void)root.texts("t");
      (void)root.rigid_transform("pose");
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("a.json: ")) << error.what();
    }
  }
}

// Ten thousand brackets deep: refused or read, but the stack holds.
TEST(JsonDocument, DeepNestingIsSurvived) {
  const std::string deep(100000, '[');
  EXPECT_THROW((void)parse(deep), InvalidInput);
  EXPECT_THROW((void)parse(R"({"format": "arthronaut.test", "version": 1, "x": )" + deep +
                           std::string(100000, ']') + "}")
                   .number("x"),
               InvalidInput);
}

}  // namespace
}  // namespace arthronaut::files
