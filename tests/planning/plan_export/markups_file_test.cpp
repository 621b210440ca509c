#include "planning/plan_export/markups_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/planning/plan_export/exported_case.h"
#include "tests/temporary_folder.h"

namespace arthronaut::plan_export {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;

// 3D Slicer may hand back RAS; anything else is refused with the place.
TEST(Markups, ReadRasAndRefuseTheRest) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "plan.mrk.json";
  const auto with = [&](const std::string& system, const std::string& unit, const std::string& second) {
    files::write_atomically(file, R"({"markups":[{"type":"Line","name":"femur tunnel","coordinateSystem":")" +
                                      system + R"(","coordinateUnits":")" + unit +
                                      R"(","controlPoints":[{"position":[1,2,3]},{"position":)" + second +
                                      "}]}]}");
  };
  with("RAS", "mm", "[1,2,33]");
  const auto plan = read_markups(file);
  EXPECT_EQ(plan.tunnels.at(BoneKind::Femur).entry_mm, Vector3d(-1, -2, 3));
  EXPECT_EQ(plan.tunnels.at(BoneKind::Femur).direction, Vector3d(0, 0, 1));
  for (const auto& [system, unit, second] : {std::array<const char*, 3>{"XYZ", "mm", "[1,2,33]"},
                                             {"LPS", "cm", "[1,2,33]"},
                                             {"LPS", "mm", "[1,2]"},
                                             {"LPS", "mm", "[1,2,\"3\"]"},
                                             {"LPS", "mm", "[1,2,3]"}}) {
    with(system, unit, second);
    try {
      (void)read_markups(file);
      ADD_FAILURE() << system << unit << second;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("plan.mrk.json: markups[0]"), std::string::npos)
          << error.what();
    }
  }
  files::write_atomically(file, "{\"markups\": 3}");
  EXPECT_THROW((void)read_markups(file), InvalidInput);
  EXPECT_THROW((void)read_markups(folder.path() / "none.mrk.json"), IoError);
}

// 3D Slicer keeps the last place of a point that was taken away or is still being placed: no tunnel runs
// there. Landmarks are not read back, so that one without a place stands in no tunnel's way.
TEST(Markups, APointThatIsNotPlacedIsNoEndOfATunnel) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "plan.mrk.json";
  const auto with = [&](const std::string& status) {
    files::write_atomically(
        file,
        R"({"markups":[{"type":"Fiducial","name":"femur landmarks","controlPoints":[{"label":"notch_apex"}]},)"
        R"({"type":"Line","name":"femur tunnel","controlPoints":[{"position":[1,2,3]},)"
        R"({"position":[1,2,33],"positionStatus":")" +
            status + R"("}]}]})");
  };
  with("defined");
  EXPECT_EQ(read_markups(file).tunnels.size(), 1U);
  for (const std::string status : {"undefined", "preview"}) {
    with(status);
    EXPECT_THAT(
        test::message_of<InvalidInput>([&] { (void)read_markups(file); }),
        testing::HasSubstr("markups[1].controlPoints[1]: is not placed: its positionStatus is \"" + status));
  }
}

// Of a case with one bone alone the other's tunnel is passed over; one that lies beside its bone is of
// another knee.
TEST(Markups, GiveTheTunnelsOfTheBonesThatAreThere) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  const geometry::Surface femur(knee.bones.at(BoneKind::Femur).mesh);
  const auto of_femur = [&](BoneKind kind) { return kind == BoneKind::Femur ? &femur : nullptr; };
  const auto file = folder / "plan.mrk.json";
  files::write_atomically(file, markups_of(knee));
  const auto tunnels = read_tunnels(file, {}, of_femur).tunnels;
  ASSERT_EQ(tunnels.size(), 1U);
  EXPECT_LT((tunnels.at(BoneKind::Femur).entry_mm - knee.plan.tunnels.at(BoneKind::Femur).entry_mm).norm(),
            1e-6);
  EXPECT_THAT(
      test::message_of<InvalidInput>([&] { (void)read_tunnels(file, {}, [](BoneKind) { return nullptr; }); }),
      testing::HasSubstr("hold no line"));
  const geometry::Surface elsewhere(test::box({1, 1, 1}));
  EXPECT_THAT(test::message_of<InvalidInput>(
                  [&] { (void)read_tunnels(file, {}, [&](BoneKind) { return &elsewhere; }); }),
              testing::HasSubstr("another knee"));
}

// Another program may empty the description: a tunnel is then as wide as it was planned, one that is new as
// is usual of its bundle, and either is said. A width that no plan may have is refused before it is in one.
TEST(Markups, ADiameterThatIsNotSaidIsThePlansOwn) {
  const test::TemporaryFolder folder;
  auto knee = test::knee_case();
  const geometry::Surface femur(knee.bones.at(BoneKind::Femur).mesh);
  const auto of_femur = [&](BoneKind kind) { return kind == BoneKind::Femur ? &femur : nullptr; };
  tunnels::Tunnel am = knee.plan.tunnels.at(BoneKind::Femur);
  am.bundle = norms::Bundle::Anteromedial;
  am.diameter_mm = 6.5;
  knee.plan.put(am, knee.plan.mesh_sha256.at(BoneKind::Femur));
  const std::string said = markups_of(knee);
  const auto with_description = [&](const std::string& description) {
    std::string text = said;
    constexpr std::string_view kSaid = "diameter_mm=6.500";
    text.replace(text.find(kSaid), kSaid.size(), description);
    files::write_atomically(folder / "plan.mrk.json", text);
  };
  with_description("seen by a colleague");
  const auto kept = read_tunnels(folder / "plan.mrk.json", knee.plan, of_femur);
  EXPECT_EQ(kept.tunnels.at(am.key()).diameter_mm, 6.5);
  EXPECT_EQ(kept.note, "femur AM tunnel has no diameter_mm there: 6.5 mm, as it was planned");
  const auto usual = read_tunnels(folder / "plan.mrk.json", {}, of_femur);
  EXPECT_EQ(usual.tunnels.at(am.key()).diameter_mm, 7.0);
  EXPECT_THAT(usual.note, testing::HasSubstr("7.0 mm, as is usual"));
  for (const char* width : {"diameter_mm=20", "diameter_mm=2.9", "diameter_mm=nan", "diameter_mm="}) {
    with_description(width);
    EXPECT_THAT(test::message_of<InvalidInput>(
                    [&] { (void)read_tunnels(folder / "plan.mrk.json", knee.plan, of_femur); }),
                testing::HasSubstr("must be 3 to 15"))
        << width;
  }
}

}  // namespace
}  // namespace arthronaut::plan_export
