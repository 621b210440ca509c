#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "app/review/postop_page.h"
#include "navigation/operation/achieved_tunnel.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "planning/postop/achieved_file.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::review {
namespace {

using ::testing::HasSubstr;

Comparisons some() {
  postop::Comparison femur;
  femur.bone.is_found = femur.bone.reliable = true;
  femur.bone.reasons.clear();
  femur.bone.plan_from_postop = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized())), {10, -20, 30}};
  femur.bone.rms_mm = 0.12;
  femur.bone.in_view_share = 0.9;
  femur.bone.on_edge_share = 0.8;
  postop::AchievedTunnel& tunnel = femur.tunnel;
  tunnel.is_found = tunnel.reliable = tunnel.comes_out = true;
  tunnel.reasons.clear();
  tunnel.tunnel.entry_mm = {1, 2, 3};
  tunnel.tunnel.direction = Eigen::Vector3d(0, 0.6, 0.8);
  tunnel.tunnel.diameter_mm = 9.04;
  tunnel.length_mm = 36.5;
  tunnel.offset_mm = 1.23;
  tunnel.angle_rad = geometry::rad_from_deg(2.5);
  tunnel.entry_sigma_mm = 0.21;
  tunnel.direction_sigma_rad = geometry::rad_from_deg(0.3);
  tunnel.diameter_sigma_mm = 0.04;
  tunnel.length_sigma_mm = 0.17;
  tunnel.metal_share = 0.25;
  tunnel.beyond_mm = 4.5;
  tunnel.widths = {{2, 9.0, 0.05}, {10, 9.9, 0.06}, {20, 9.2, 0.05}};
  postop::Comparison tibia;
  tibia.bone.reasons = {"the bone was not found in the images"};
  tibia.tunnel.reasons = {"the bone was not found in the images", "nothing to look in"};
  return {{bones::BoneKind::Femur, femur}, {bones::BoneKind::Tibia, tibia}};
}

// The numbers with how sure they are, each beside what was planned; what was not found has no number and says
// why, once.
TEST(PostopWords, SayWhatWasFoundAndHowSure) {
  tunnels::Tunnel plan;
  plan.diameter_mm = 9;
  plan.entry_mm = Eigen::Vector3d(1, 2, 3) + 1.23 * Eigen::Vector3d::UnitX();
  plan.direction =
      Eigen::AngleAxisd(geometry::rad_from_deg(2.5), Eigen::Vector3d::UnitX()) * Eigen::Vector3d(0, 0.6, 0.8);
  const Places places{{bones::BoneKind::Femur,
                       {.off_mm = {-1.2, 0.3, 0},
                        .grid = {{"High to low", 35, 38.2}},
                        .planned_wall_mm = 2,
                        .wall_mm = 1.6}}};
  auto rows = achieved_rows(some(), {{bones::BoneKind::Femur, plan}}, {{bones::BoneKind::Femur, 35}}, places);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].tunnel, "femur");
  EXPECT_EQ(rows[0].verdict, "reliable");
  EXPECT_EQ(rows[0].severity, widgets::Severity::Good);
  EXPECT_THAT(rows[0].offset, HasSubstr("1.2 mm \u00B1 0.2"));
  EXPECT_THAT(rows[0].offset, HasSubstr("1.2 mm posterior, 0.3 mm proximal"));
  EXPECT_EQ(rows[0].grid, "high to low 38.2 %, planned 35.0 %");
  EXPECT_EQ(rows[0].wall, "1.6 mm; planned 2.0 mm");
  EXPECT_THAT(rows[0].angle, HasSubstr("2.5\u00B0 \u00B1 0.3"));
  EXPECT_THAT(rows[0].diameter, HasSubstr("9.0 to 9.9 mm, widest 10 mm from the entry; planned 9.0 mm"));
  EXPECT_THAT(rows[0].length, HasSubstr("36.5 mm; planned 35.0 mm"));
  EXPECT_EQ(rows[1].verdict, "bone not found in the images");
  EXPECT_EQ(rows[1].severity, widgets::Severity::Bad);
  EXPECT_EQ(rows[1].offset, "\u2013");
  EXPECT_EQ(rows[1].reasons.size(), 2U);

  // The numbers are of the plan that was compared. Another one, half a millimetre away, has none yet.
  plan.entry_mm.x() += 0.5;
  rows = achieved_rows(some(), {{bones::BoneKind::Femur, plan}}, {{bones::BoneKind::Femur, 35}}, places);
  EXPECT_EQ(rows[0].verdict, "of an earlier plan");
  EXPECT_EQ(rows[0].severity, widgets::Severity::Caution);
  EXPECT_EQ(rows[0].grid + rows[0].wall, "");
}

// Where a part is relied on, that part is named and each number of the rest says that it is not.
TEST(PostopWords, SayWhichPartIsReliable) {
  using enum tunnels::Quantity;
  Comparisons comparisons = some();
  postop::AchievedTunnel& femur = comparisons.at(bones::BoneKind::Femur).tunnel;
  femur.reliable = false;
  femur.reasons = {"its diameter is known to 0.11 mm, 0.10 mm are needed"};
  femur.known = {Entry, Direction, Length};
  tunnels::Tunnel plan = femur.tunnel;
  plan.entry_mm += 1.23 * Eigen::Vector3d::UnitX();
  plan.direction = Eigen::AngleAxisd(geometry::rad_from_deg(2.5), Eigen::Vector3d::UnitX()) * plan.direction;
  const Places places{{bones::BoneKind::Femur, {.planned_wall_mm = 2, .wall_mm = 1.6}}};
  const AchievedRow row = achieved_rows(comparisons, {{bones::BoneKind::Femur, plan}}, {}, places).front();
  EXPECT_EQ(row.verdict, "reliable in part: entry, direction and length; not the diameter");
  EXPECT_EQ(row.severity, widgets::Severity::Caution);
  EXPECT_THAT(row.diameter, HasSubstr("; NOT RELIABLE"));
  EXPECT_THAT(row.wall, HasSubstr("; NOT RELIABLE")) << "it follows from the diameter, too";
  for (const std::string& sure : {row.offset, row.angle, row.length})
    EXPECT_THAT(sure, testing::Not(HasSubstr("NOT RELIABLE")));
  EXPECT_THAT(row.reasons, testing::Contains(HasSubstr("its diameter is known to 0.11 mm")));
}

// What is in the numbers, and what is in none of them.
TEST(PostopWords, SayWhatIsNotKnown) {
  const Comparisons comparisons = some();
  const postop::AchievedPlace place{.wall_mm = 1.6, .wall_sigma_mm = 0.08};
  const auto lines = error_budget(comparisons.at(bones::BoneKind::Femur), &place, {0.4, 0.4, 0.6});
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  for (const char* part :
       {"0.12 mm (rms)", "entry 0.21 mm", "0.30\u00B0, diameter 0.04 mm, length 0.17 mm, least wall 0.08 mm.",
        "25 %", "0.40 x 0.40 x 0.60", "Not known, and in none of these numbers"})
    EXPECT_THAT(all, HasSubstr(part));
  EXPECT_EQ(error_budget(comparisons.at(bones::BoneKind::Tibia), nullptr, {0, 0, 0}).size(), 1U);
}

// The tunnel runs down the middle of both slices, which stand at right angles.
TEST(PostopWords, LaySlicesAlongTheTunnel) {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = {5, -3, 12};
  tunnel.direction = Eigen::Vector3d(1, -2, 0.5).normalized();
  const Eigen::Vector2i size{401, 401};
  const auto first = plane_along(tunnel, 30, 0, 0.2), second = plane_along(tunnel, 30, 1, 0.2);
  for (const scene::SlicePlane& plane : {first, second}) {
    EXPECT_NEAR(plane.normal().dot(tunnel.direction), 0, 1e-12);
    EXPECT_NEAR((plane.pixel_of(tunnel.entry_mm, size) - Eigen::Vector2d(200, 200 - 75)).norm(), 0, 1e-9);
    const Eigen::Vector3d exit = tunnel.entry_mm + 30 * tunnel.direction;
    EXPECT_NEAR((plane.pixel_of(exit, size) - Eigen::Vector2d(200, 200 + 75)).norm(), 0, 1e-9);
  }
  EXPECT_NEAR(first.normal().dot(second.normal()), 0, 1e-12);
}

// A session's achieved.json has the same name and format: it was told as lacking "bones", or as newer than
// the program where the tunnel was taken back.
TEST(AchievedFile, OfASessionIsNamedAsThat) {
  const test::TemporaryFolder folder;
  for (const bool is_taken_back : {false, true}) {
    operation::AchievedTunnel of_session;
    of_session.is_taken_back = is_taken_back;
    operation::write_achieved_file(folder / "achieved.json", of_session);
    const std::string message =
        test::message_of<InvalidInput>([&] { (void)postop::read_achieved_file(folder / "achieved.json"); });
    EXPECT_THAT(message, HasSubstr("what navigation measured of one tunnel"));
    EXPECT_THAT(message, HasSubstr("arthronaut compare"));
  }
}

// The CT of somebody else, by mistake: whose it is is told, and what the case has is shown as before.
TEST(PostopShown, AnotherPatientsImagesTakeNothingAway) {
  PostopShown shown;
  shown.comparisons = some();
  auto others = std::make_shared<open_case::PostopAnswer>();
  others->other_patient = "Muster^Anna";
  others->comparisons[bones::BoneKind::Tibia];
  EXPECT_FALSE(take_answer(others, shown));
  EXPECT_EQ(shown.other_patient, "Muster^Anna");
  EXPECT_EQ(shown.answer, nullptr);
  EXPECT_EQ(shown.comparisons.size(), 2U);
  EXPECT_TRUE(shown.comparisons.at(bones::BoneKind::Femur).tunnel.is_found);
  auto own = std::make_shared<open_case::PostopAnswer>();
  own->comparisons[bones::BoneKind::Tibia].bone.reliable = true;
  EXPECT_TRUE(take_answer(own, shown));
  EXPECT_EQ(shown.answer, own);
  EXPECT_EQ(shown.comparisons.size(), 1U);
  EXPECT_TRUE(shown.other_patient.empty());
}

// A file that does not say how well entry and direction are known was read as if they were known exactly.
// A failed or running comparison left the numbers of the one before in green, and nothing said so.
TEST(PostopShown, NumbersOfEarlierImagesSaySo) {
  const auto said = [](const PostopShown& of, bool is_running, bool asked_in_vain) {
    return in_words(standing_of(of, is_running, asked_in_vain));
  };
  PostopShown shown;
  EXPECT_EQ(said(shown, true, false), "") << "there are none";
  shown.comparisons[bones::BoneKind::Femur];
  EXPECT_THAT(said(shown, false, false), HasSubstr("As kept in the case"));
  EXPECT_THAT(said(shown, true, false), HasSubstr("EARLIER"));
  EXPECT_THAT(said(shown, false, true), HasSubstr("EARLIER"));
  shown.answer = std::make_shared<open_case::PostopAnswer>();
  EXPECT_EQ(said(shown, false, false), "");
  shown.not_its_bones = "the femur is not found";
  EXPECT_THAT(said(shown, false, false), HasSubstr("EARLIER"));
}

TEST(AchievedFile, ASigmaThatItDoesNotSayIsNotKnown) {
  const test::TemporaryFolder folder;
  const auto file = folder / "achieved.json";
  postop::write_achieved_file(file, some());
  for (const bool is_null : {false, true}) {
    auto json = nlohmann::json::parse(files::read_text(file));
    for (auto& tunnel : json.at("tunnels"))
      for (const char* key : {"entry_sigma_mm", "direction_sigma_deg"}) {
        tunnel.erase(key);
        if (is_null) tunnel[key] = nullptr;
      }
    files::write_atomically(file, json.dump());
    const Comparisons read = postop::read_achieved_file(file);
    const postop::Comparison& femur = read.at(bones::BoneKind::Femur);
    EXPECT_TRUE(std::isinf(femur.tunnel.entry_sigma_mm));
    EXPECT_TRUE(std::isinf(femur.tunnel.direction_sigma_rad));
    const std::map<tunnels::TunnelKey, tunnels::Tunnel> planned;
    const AchievedRow row = achieved_rows(read, planned, {}, {}).front();
    EXPECT_THAT(row.offset, HasSubstr("\u00B1 not known"));
    EXPECT_THAT(row.angle, HasSubstr("\u00B1 not known"));
    EXPECT_THAT(error_budget(femur, nullptr, Eigen::Vector3d::Zero()),
                testing::Contains(HasSubstr("entry not known, direction not known")));
    postop::write_achieved_file(file, read);
    const auto again = nlohmann::json::parse(files::read_text(file)).at("tunnels").at(0);
    EXPECT_TRUE(again.at("entry_sigma_mm").is_null());
    EXPECT_TRUE(again.at("direction_sigma_deg").is_null());
  }
}

// Other programs read "reliable" as before: of all of it. What may be relied on by itself stands beside it.
TEST(AchievedFile, KeepsWhatIsKnownByItself) {
  using enum tunnels::Quantity;
  const test::TemporaryFolder folder;
  const auto file = folder / "achieved.json";
  Comparisons written = some();
  postop::AchievedTunnel& femur = written.at(bones::BoneKind::Femur).tunnel;
  const Places places{{bones::BoneKind::Femur, {.wall_mm = 1.6, .wall_sigma_mm = 0.1}}};
  const auto names = [&] {
    postop::write_achieved_file(file, written, places);
    return nlohmann::json::parse(files::read_text(file)).at("tunnels").at(0).at("reliable_quantities");
  };
  EXPECT_EQ(names(), nlohmann::json({"entry", "direction", "diameter", "length", "wall"}));
  femur.reliable = false;
  femur.known = {Entry, Direction};
  EXPECT_EQ(names(), nlohmann::json({"entry", "direction"}));
  const Comparisons read = postop::read_achieved_file(file);
  EXPECT_FALSE(read.at(bones::BoneKind::Femur).tunnel.reliable);
  EXPECT_EQ(relied_on(read.at(bones::BoneKind::Femur)), femur.known);
  // By an older program nothing of what is not reliable as a whole is known.
  auto older = nlohmann::json::parse(files::read_text(file));
  older.at("tunnels").at(0).erase("reliable_quantities");
  files::write_atomically(file, older.dump());
  EXPECT_TRUE(relied_on(postop::read_achieved_file(file).at(bones::BoneKind::Femur)).empty());
}

// What a comparison kept in the case is shown again with every number and every reason.
TEST(AchievedFile, IsReadBack) {
  const test::TemporaryFolder folder;
  Comparisons written = some();
  written.at(bones::BoneKind::Femur).tunnel.end_is_seen = false;
  postop::write_achieved_file(folder / "achieved.json", written);
  const Comparisons read = postop::read_achieved_file(folder / "achieved.json");
  ASSERT_EQ(read.size(), 2U);
  const postop::Comparison& a = written.at(bones::BoneKind::Femur);
  const postop::Comparison& b = read.at(bones::BoneKind::Femur);
  EXPECT_TRUE(b.bone.is_found && b.bone.reliable && b.tunnel.is_found && b.tunnel.reliable);
  EXPECT_NEAR((b.tunnel.tunnel.entry_mm - a.tunnel.tunnel.entry_mm).norm(), 0, 1e-12);
  EXPECT_NEAR((b.tunnel.tunnel.direction - a.tunnel.tunnel.direction).norm(), 0, 1e-12);
  EXPECT_NEAR(b.tunnel.angle_rad, a.tunnel.angle_rad, 1e-12);
  EXPECT_NEAR(b.tunnel.entry_sigma_mm, a.tunnel.entry_sigma_mm, 1e-12);
  EXPECT_NEAR(b.tunnel.direction_sigma_rad, a.tunnel.direction_sigma_rad, 1e-12);
  EXPECT_NEAR(b.tunnel.diameter_sigma_mm, 0.04, 1e-12);
  EXPECT_NEAR(b.tunnel.length_sigma_mm, 0.17, 1e-12);
  EXPECT_EQ(b.tunnel.comes_out, a.tunnel.comes_out);
  EXPECT_EQ(b.tunnel.end_is_seen, a.tunnel.end_is_seen);
  EXPECT_EQ(b.tunnel.beyond_mm, a.tunnel.beyond_mm);
  ASSERT_EQ(b.tunnel.widths.size(), a.tunnel.widths.size());
  EXPECT_NEAR(b.tunnel.widths[1].diameter_mm, 9.9, 1e-12);
  EXPECT_NEAR(b.tunnel.widths[1].sigma_mm, 0.06, 1e-12);
  EXPECT_NEAR((b.bone.plan_from_postop.translation_mm - a.bone.plan_from_postop.translation_mm).norm(), 0,
              1e-9);
  const postop::Comparison& tibia = read.at(bones::BoneKind::Tibia);
  EXPECT_FALSE(tibia.bone.is_found || tibia.tunnel.is_found || tibia.tunnel.reliable);
  EXPECT_EQ(tibia.tunnel.reasons, written.at(bones::BoneKind::Tibia).tunnel.reasons);
  files::write_atomically(folder / "achieved.json", R"({"format": "arthronaut.achieved", "version": 2})");
  EXPECT_THROW((void)postop::read_achieved_file(folder / "achieved.json"), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::review
