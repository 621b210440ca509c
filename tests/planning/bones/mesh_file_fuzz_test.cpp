#include <gtest/gtest.h>

#include <random>

#include "planning/bones/mesh_file.h"
#include "planning/bones/mesh_formats.h"
#include "planning/geometry/error.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::bones {
namespace {

// What transfers, editors and broken writers do to a file: bits, runs, cuts, repeats, and numbers made huge.
std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n ? n - 1 : 0)(random);
  };
  const std::size_t count = 1 + below(4);
  for (std::size_t i = 0; i < count && !bytes.empty(); ++i) {
    const std::size_t at = below(bytes.size());
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] ^= static_cast<char>(1U << below(8));
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.erase(at, below(20));
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(60)));
        break;
      case 5:
        bytes.insert(at, "999999999999");
        break;
      case 6:
        bytes.insert(at, below(2) ? " nan " : "-");
        break;
      default: {
        // In a header, where the counts are.
        const std::size_t early = below(std::min<std::size_t>(bytes.size(), 300));
        bytes[early] = "0123456789-\xff\n "[below(14)];
      }
    }
  }
  return bytes;
}

using Parser = RawMesh (*)(const std::filesystem::path&, std::string_view);

Parser parser_for(const std::string& name) {
  if (name.ends_with(".stl")) return parse_stl;
  if (name.ends_with(".ply")) return parse_ply;
  if (name.ends_with(".obj")) return parse_obj;
  return name.ends_with(".vtk") ? parse_legacy_vtk : parse_vtp;
}

// Every parser, on a thousand broken files each: a mesh that is valid, or InvalidInput, and nothing else.
TEST(MeshFileFuzz, BrokenFilesGiveAValidMeshOrInvalidInput) {
  const auto forms = test::all_forms(test::ellipsoid({40, 30, 25}, 1), "SPACE=LPS");
  for (const auto& [name, contents] : forms) {
    SCOPED_TRACE(name);
    std::mt19937 random(7);
    int refused = 0;
    for (int i = 0; i < 1000; ++i) {
      const std::string broken = mutated(contents, random);
      try {
        const RawMesh raw = parser_for(name)(name, broken);
        for (const auto& v : raw.mesh.vertices_mm) ASSERT_TRUE(v.allFinite()) << i;
        for (const auto& t : raw.mesh.triangles) {
          for (const auto v : t) {
            ASSERT_TRUE(v >= 0 && static_cast<std::size_t>(v) < raw.mesh.vertices_mm.size()) << i;
          }
        }
      } catch (const InvalidInput& error) {
        ++refused;
        const std::string message = error.what();
        ASSERT_TRUE(message.starts_with(name + ": ")) << i << ": " << message;
        ASSERT_EQ(message.find('\n'), std::string::npos) << i << ": " << message;
      } catch (const std::exception& error) {
        FAIL() << "mutation " << i << " threw something else: " << error.what();
      }
    }
    EXPECT_GT(refused, 100);
  }
}

}  // namespace
}  // namespace arthronaut::bones
