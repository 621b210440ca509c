// What a session keeps of the tunnels that were drilled in it, and by which name each goes.
#include "navigation/operation/achieved_tunnel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "navigation/operation/command.h"
#include "navigation/operation/operation_state.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace arthronaut::operation {
namespace {

using norms::Bundle;

tunnels::Tunnel tunnel_of(Bundle bundle) {
  return {.entry_mm = {1, 2, 3}, .direction = {0, 0, 1}, .diameter_mm = 7, .bundle = bundle};
}
AchievedTunnel drilled(Bundle bundle, double depth_mm) {
  return {.planned = tunnel_of(bundle), .measured = tunnel_of(bundle), .depth_mm = depth_mm, .truth = {}};
}

// Both bundles drilled in one session: neither takes the other's place, and each says which it is.
TEST(AchievedTunnel, ASessionHoldsBothBundles) {
  const test::TemporaryFolder folder;
  for (const auto& [bundle, depth_mm] :
       {std::pair(Bundle::Posterolateral, 30.0), {Bundle::Anteromedial, 20.0}})
    write_achieved_file(folder.path() / achieved_file_name({bones::BoneKind::Femur, bundle}),
                        drilled(bundle, depth_mm));
  const auto files = achieved_files(folder.path());
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(read_achieved_file(files[0]).measured.bundle, Bundle::Anteromedial);
  EXPECT_EQ(read_achieved_file(files[0]).depth_mm, 20.0);
  EXPECT_EQ(read_achieved_file(files[1]).planned.bundle, Bundle::Posterolateral);
}

// A unit vector in doubles has a length of 1 but for the last bit; made unit once more it is another one.
TEST(AchievedTunnel, DirectionsComeBackToTheBit) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "achieved.json";
  AchievedTunnel written = drilled(Bundle::Whole, 30);
  for (int step = 0; step < 200; ++step) {
    const double along = 0.031 * step, across = 0.017 * step + 0.4;
    written.measured.direction =
        Eigen::Vector3d(std::cos(along) * std::cos(across), std::sin(along), std::sin(across)).normalized();
    write_achieved_file(file, written);
    EXPECT_EQ(read_achieved_file(file).measured.direction, written.measured.direction) << step;
  }
}

// Older files hold nought where nobody knew how deep it was.
TEST(AchievedTunnel, ADepthOfNoughtIsNotKnown) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "achieved.json";
  write_achieved_file(file, drilled(Bundle::Whole, 0));
  EXPECT_FALSE(read_achieved_file(file).depth_mm);
}

// Of a single tunnel the file is as it always was.
TEST(AchievedTunnel, OfASingleTunnelNothingIsNew) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(achieved_file_name(bones::BoneKind::Tibia), "achieved.json");
  const auto file = folder.path() / "achieved.json";
  write_achieved_file(file, drilled(Bundle::Whole, 20));
  EXPECT_EQ(files::read_text(file).find("bundle"), std::string::npos);
  EXPECT_EQ(achieved_files(folder.path()), std::vector<std::filesystem::path>{file});
}

// What `arthronaut compare` writes has the same name and format: it was told as lacking "bone".
TEST(AchievedTunnel, AComparisonsFileIsNamedAsThat) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "achieved.json";
  files::write_atomically(file,
                          R"({"format": "arthronaut.achieved", "version": 1, "tunnels": [], "bones": []})");
  const std::string message = test::message_of<InvalidInput>([&] { (void)read_achieved_file(file); });
  EXPECT_NE(message.find("arthronaut compare"), std::string::npos) << message;
  EXPECT_NE(message.find("(\"planned\" and \"measured\")"), std::string::npos) << message;
}

// Which of two tunnels guides is in the journal and in the digests; of a single one both are as before.
TEST(OperationCommands, NameTheBundleThatGuides) {
  const OfferPlan single{PlannedTunnel{tunnel_of(Bundle::Whole), 30}},
      am{PlannedTunnel{tunnel_of(Bundle::Anteromedial), 30}};
  EXPECT_EQ(to_text(single).find("bundle"), std::string::npos);
  const auto back = std::get<OfferPlan>(command_from_text(to_text(am), "journal"));
  EXPECT_EQ(back.plan->tunnel.bundle, Bundle::Anteromedial);
  EXPECT_TRUE(back.plan == am.plan);
  EXPECT_FALSE(single.plan == am.plan) << "the same place for another graft is another plan";
  const auto digest_with = [](const std::optional<PlannedTunnel>& plan) {
    OperationState state;
    state.plan = plan;
    return digest_of_decisions(state);
  };
  EXPECT_NE(digest_with(am.plan), digest_with(single.plan));
}

}  // namespace
}  // namespace arthronaut::operation
