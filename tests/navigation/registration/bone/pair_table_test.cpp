#include "navigation/registration/bone/pair_table.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::registration {

namespace {

const PairTable& table() {
  static const PairTable kTable(phantom_bone().mesh);
  return kTable;
}

Eigen::Vector3f across(const Eigen::Vector3f& normal, std::mt19937& random) {
  std::normal_distribution<float> uniform;
  return normal.cross(Eigen::Vector3f(uniform(random), uniform(random), uniform(random))).normalized();
}

}  // namespace

// No two samples of the same side nearer than the spacing, and none off the surface.
TEST(PairTable, SamplesAreSpreadOverTheSurface) {
  const auto samples = sample_surface(phantom_bone().mesh, 2.4);
  ASSERT_GT(samples.size(), 500u);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_LT(std::abs(phantom_bone().surface->signed_distance_mm(samples[i].point_mm.cast<double>())), 1e-3);
    for (std::size_t j = 0; j < i; ++j) {
      if (samples[i].normal.dot(samples[j].normal) < 0) continue;
      EXPECT_GE((samples[i].point_mm - samples[j].point_mm).norm(), 2.39f);
    }
  }
}

// A curve pair made from two samples, with any tangents across their normals, moved anyhow, finds those
// samples again, one way round or the other; and the turn that comes with the match lays both tangents across
// both normals.
TEST(PairTable, FindsThePairThatACurvePairWasMadeFrom) {
  std::mt19937 random(5);
  const auto& samples = table().samples();
  int tried = 0, found = 0;
  while (tried < 200) {
    const auto a = static_cast<std::uint16_t>(random() % samples.size()),
               b = static_cast<std::uint16_t>(random() % samples.size());
    const Eigen::Vector3f p = across(samples[a].normal, random), q = across(samples[b].normal, random);
    const Eigen::Vector3f between = samples[b].point_mm - samples[a].point_mm;
    const float distance = between.norm();
    if (distance < 10 || distance > 32) continue;
    const Eigen::Vector3f e = between / distance;
    // As the search draws them: tangents well across the baseline. Normals along it are not in the table.
    if (std::abs(p.dot(e)) > 0.85f || std::abs(q.dot(e)) > 0.85f) continue;
    if (std::abs(samples[a].normal.dot(e)) > 0.9f || std::abs(samples[b].normal.dot(e)) > 0.9f) continue;
    ++tried;
    const Eigen::Quaternionf turn = Eigen::Quaternionf::UnitRandom();
    std::vector<PairTable::Match> matches, reversed;
    table().find_matches(shape_of(turn * samples[a].point_mm, turn * p, turn * samples[b].point_mm, turn * q),
                         {}, matches);
    table().find_matches(shape_of(turn * samples[b].point_mm, turn * q, turn * samples[a].point_mm, turn * p),
                         {}, reversed);
    const auto is_ab = [&](const PairTable::Match& m) { return m.first == a && m.second == b; };
    const auto is_ba = [&](const PairTable::Match& m) { return m.first == b && m.second == a; };
    found += std::any_of(matches.begin(), matches.end(), is_ab) ||
             std::any_of(reversed.begin(), reversed.end(), is_ba);
  }
  EXPECT_EQ(found, tried);
}

// The sign of a tangent carries no meaning: turning one round finds as many matches.
TEST(PairTable, TangentsHaveNoSign) {
  std::mt19937 random(6);
  const Eigen::Vector3f p(0.3f, 0.9f, 0.3f), q(-0.2f, 0.5f, 0.8f), second(20, 3, 1);
  for (const float sign : {-1.0f, 1.0f}) {
    std::vector<PairTable::Match> matches, turned;
    table().find_matches(shape_of({0, 0, 0}, p.normalized(), second, q.normalized()), {}, matches);
    table().find_matches(shape_of({0, 0, 0}, sign * p.normalized(), second, -q.normalized()), {}, turned);
    EXPECT_GT(matches.size(), 100u);
    // Rounding may move a few over the tolerance's edge.
    EXPECT_NEAR(static_cast<double>(matches.size()), static_cast<double>(turned.size()),
                0.01 * static_cast<double>(matches.size()));
  }
}

}  // namespace arthronaut::registration
