#include "planning/tunnels/tunnel_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "planning/files/json_document.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"

namespace arthronaut::tunnels {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

nlohmann::ordered_json document_of(const Tunnel& tunnel) {
  nlohmann::ordered_json json = {{"format", "test"}, {"version", 1}};
  put_key(tunnel.key(), json);
  json.update(to_json(tunnel));
  return json;
}

Tunnel read_from(const nlohmann::ordered_json& json) {
  const auto root = files::parse_json(json.dump(), "some.json", "test", 1);
  return read_tunnel(root, read_key(root));
}

// To the last bit: a plan's hash and a replay rest on it. A single tunnel names no bundle.
TEST(TunnelJson, ComesBackToTheBit) {
  for (const auto bundle : {norms::Bundle::Whole, norms::Bundle::Posterolateral}) {
    const Tunnel tunnel{bones::BoneKind::Tibia,
                        {1.0 / 3, -2e-7, 71.25},
                        Eigen::Vector3d(0.3, -0.2, 0.7).normalized(),
                        8.5,
                        bundle};
    const auto json = document_of(tunnel);
    EXPECT_EQ(json.contains("bundle"), bundle != norms::Bundle::Whole);
    const Tunnel back = read_from(json);
    EXPECT_EQ(back.key(), tunnel.key());
    EXPECT_EQ(back.entry_mm, tunnel.entry_mm);
    EXPECT_EQ(back.direction, tunnel.direction);
    EXPECT_EQ(back.diameter_mm, tunnel.diameter_mm);
  }
}

// Whoever has to mend the file is told where.
TEST(TunnelJson, NamesFileAndPlaceOfWhatIsWrong) {
  const auto refusal = [](const char* key, const nlohmann::json& value) {
    auto json = document_of({});
    json[key] = value;
    return test::message_of<InvalidInput>([&] { (void)read_from(json); });
  };
  EXPECT_THAT(refusal("bone", "patella"), AllOf(HasSubstr("some.json: bone"), HasSubstr("patella")));
  EXPECT_THAT(refusal("bundle", "both"),
              AllOf(HasSubstr("some.json: bundle"), HasSubstr("single, am or pl")));
  EXPECT_THAT(refusal("direction", {0, 0, 0}), HasSubstr("some.json: direction: must not be zero"));
  EXPECT_THAT(refusal("diameter_mm", -8), HasSubstr("some.json: diameter_mm"));
}

}  // namespace
}  // namespace arthronaut::tunnels
