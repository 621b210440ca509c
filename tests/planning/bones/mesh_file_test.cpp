#include "planning/bones/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/planning/bones/mesh_text_forms.h"
#include "tests/planning/geometry/shapes.h"
#include "tests/temporary_folder.h"

namespace arthronaut::bones {
namespace {

using test::message_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

// Not symmetric in any axis, so that a wrong space shows.
geometry::TriangleMesh bone_like() { return test::ellipsoid({40, 30, 25}, 1, {12, -34, 56}); }

void expect_same_surface(const geometry::TriangleMesh& found, const geometry::TriangleMesh& expected) {
  ASSERT_EQ(found.triangles.size(), expected.triangles.size());
  EXPECT_EQ(found.vertices_mm.size(), expected.vertices_mm.size());
  for (std::size_t t = 0; t < found.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto &a = found.vertices_mm[found.triangles[t][i]],
                 &b = expected.vertices_mm[expected.triangles[t][i]];
      // Float coordinates of up to 100 mm carry 4e-6 mm.
      EXPECT_NEAR((a - b).norm(), 0, 1e-5);
    }
  }
}

// One mesh, eleven files, one result.
TEST(MeshFile, EveryFormatGivesTheSameSurface) {
  const TemporaryFolder folder;
  for (const auto& [name, contents] : test::all_forms(bone_like())) {
    SCOPED_TRACE(name);
    test::write_bytes(folder / name, contents);
    ASSERT_TRUE(is_mesh_file(folder / name));
    const MeshFile file = read_mesh_file(folder / name);
    expect_same_surface(file.mesh, bone_like());
    EXPECT_EQ(file.space_in_file, Space::LPS);
    EXPECT_FALSE(file.space_was_declared);
  }
}

// A mirrored knee is the worst of all import errors: RAS is turned by half a turn about z, and not mirrored.
TEST(MeshFile, DeclaredRasIsTurnedIntoLps) {
  const TemporaryFolder folder;
  geometry::TriangleMesh turned = bone_like();
  for (auto& v : turned.vertices_mm) v = Eigen::Vector3d(-v.x(), -v.y(), v.z());
  for (const auto& [name, contents] : test::all_forms(bone_like(), "SPACE=RAS")) {
    SCOPED_TRACE(name);
    test::write_bytes(folder / name, contents);
    const MeshFile file = read_mesh_file(folder / name);
    expect_same_surface(file.mesh, turned);
    EXPECT_TRUE(file.space_was_declared);
    EXPECT_GT(geometry::signed_volume_mm3(file.mesh), 0);
    // The caller's word is above the file's.
    MeshFileOptions options;
    options.space = Space::LPS;
    expect_same_surface(read_mesh(folder / name, options), bone_like());
  }
  for (const auto& [name, contents] : test::all_forms(bone_like(), "SPACE=LPS")) {
    SCOPED_TRACE(name);
    test::write_bytes(folder / name, contents);
    EXPECT_TRUE(read_mesh_file(folder / name).space_was_declared);
    expect_same_surface(read_mesh(folder / name), bone_like());
    MeshFileOptions options;
    options.space = Space::RAS;
    expect_same_surface(read_mesh(folder / name, options), turned);
  }
}

TEST(MeshFile, MetresAreRefusedUntilTheUnitIsSaid) {
  const TemporaryFolder folder;
  geometry::TriangleMesh metres = bone_like();
  for (auto& v : metres.vertices_mm) v /= 1000;
  test::write_bytes(folder / "femur.stl", test::binary_stl(metres));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "femur.stl"); }),
              AllOf(HasSubstr("femur.stl"), HasSubstr("0.08 mm"), HasSubstr("--unit m ")));
  MeshFileOptions options;
  options.unit = LengthUnit::Metre;
  expect_same_surface(read_mesh(folder / "femur.stl", options), bone_like());
  // Inches and centimetres are both possible for a bone of 3 units.
  for (auto& v : metres.vertices_mm) v *= 1000.0 / 25.4;
  test::write_bytes(folder / "femur.stl", test::binary_stl(metres));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "femur.stl"); }),
              AllOf(HasSubstr("--unit cm"), HasSubstr("--unit in")));
  // An explicit mm is not questioned.
  options.unit = LengthUnit::Millimetre;
  EXPECT_NO_THROW((void)read_mesh(folder / "femur.stl", options));
}

// 80 m of bone would be told as strokes that fit nowhere.
TEST(MeshFile, AUnitThatMakesABoneFarTooLargeIsRefused) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "femur.stl", test::binary_stl(bone_like()));
  MeshFileOptions options;
  for (const LengthUnit unit : {LengthUnit::Metre, LengthUnit::Centimetre, LengthUnit::Inch}) {
    options.unit = unit;
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "femur.stl", options); }),
                AllOf(HasSubstr("femur.stl"), HasSubstr("mm large if it is in"), HasSubstr("would be mm")));
  }
  // A whole leg in millimetres is one in no other unit.
  geometry::TriangleMesh leg = bone_like();
  for (auto& v : leg.vertices_mm) v *= 15;
  test::write_bytes(folder / "leg.stl", test::binary_stl(leg));
  options.unit = LengthUnit::Millimetre;
  EXPECT_NO_THROW((void)read_mesh(folder / "leg.stl", options));
}

// Every format cut off at many places: never a shorter bone, always a message with the file's name.
TEST(MeshFile, TruncatedFilesAreRefused) {
  const TemporaryFolder folder;
  for (const auto& [name, contents] : test::all_forms(bone_like())) {
    SCOPED_TRACE(name);
    // An OBJ and an STL in text may be cut between two triangles without a trace in the format, the former at
    // the end of any line; what makes the end of the others certain is checked at every tenth.
    if (name.ends_with(".obj")) continue;
    const std::size_t end = name.ends_with(".vtk") ? contents.find("POINT_DATA") - 5 : contents.size() - 10;
    for (int tenth = 0; tenth <= 10; ++tenth) {
      test::write_bytes(folder / name, contents.substr(0, end * static_cast<std::size_t>(tenth) / 10));
      EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / name); }), HasSubstr(name))
          << tenth;
    }
  }
}

TEST(MeshFile, TruncatedStlNamesTriangleAndByte) {
  const TemporaryFolder folder;
  const std::string whole = test::binary_stl(bone_like());
  test::write_bytes(folder / "cut.stl", whole.substr(0, 84 + 50 * 12 + 7));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "cut.stl"); }),
              AllOf(HasSubstr("byte 691"), HasSubstr("triangle 13 of 80")));
}

TEST(MeshFile, NotFiniteCoordinatesAreRefusedWithTheirPlace) {
  const TemporaryFolder folder;
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    geometry::TriangleMesh mesh = bone_like();
    mesh.vertices_mm[17].y() = bad;
    for (const auto& [name, contents] : test::all_forms(mesh)) {
      SCOPED_TRACE(name);
      test::write_bytes(folder / name, contents);
      const std::string message = message_of<InvalidInput>([&] { (void)read_mesh(folder / name); });
      EXPECT_THAT(message, HasSubstr(name));
      EXPECT_TRUE(message.find("not finite") != std::string::npos || name == "bone.vtp") << message;
      // The place: a line in text, else the vertex, or the triangle of an STL.
      EXPECT_TRUE(name == "bone.vtp" || message.find("line ") != std::string::npos ||
                  message.find(name == "binary.stl" ? "triangle " : "vertex 18") != std::string::npos)
          << message;
      // Of a text in which it is the first of its kind, the line that it stands in.
      if (name.starts_with("text") && name.ends_with(".vtk")) {
        const std::string before = contents.substr(0, std::min(contents.find("nan"), contents.find("inf")));
        EXPECT_THAT(message, HasSubstr("line " + std::to_string(std::ranges::count(before, '\n') + 1) + ":"));
      }
    }
  }
}

TEST(MeshFile, IndicesOutOfRangeAreRefused) {
  const TemporaryFolder folder;
  for (const std::int32_t bad : {42, 1000000, -1}) {
    geometry::TriangleMesh mesh = bone_like();
    mesh.triangles[33][2] = bad;  // an OBJ counts from 1: -1 becomes 0 there, which is no vertex either
    const std::map<std::string, std::string> forms{{"a.ply", test::text_ply(mesh)},
                                                   {"b.ply", test::binary_ply(mesh, std::endian::big)},
                                                   {"c.obj", test::obj(mesh)},
                                                   {"d.vtk", test::legacy_vtk(mesh, false, 4)},
                                                   {"e.vtk", test::legacy_vtk(mesh, true, 5)},
                                                   {"f.vtp", test::vtp(mesh)}};
    for (const auto& [name, contents] : forms) {
      SCOPED_TRACE(name);
      test::write_bytes(folder / name, contents);
      EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / name); }), HasSubstr(name));
    }
  }
}

// VTK makes room for what the last offset says: one wrong digit asked for gigabytes.
TEST(MeshFile, OffsetsThatTheFileCannotHoldAreRefused) {
  const TemporaryFolder folder;
  const std::string last = std::to_string(3 * bone_like().triangles.size()) + " </DataArray></Polys>";
  for (const char* bad : {"555555555", "-3"}) {
    std::string contents = test::vtp(bone_like());
    const auto at = contents.find(last);
    ASSERT_NE(at, std::string::npos);
    contents.replace(at, last.find(' '), bad);
    test::write_bytes(folder / "a.vtp", contents);
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "a.vtp"); }),
                AllOf(HasSubstr("a.vtp"), HasSubstr("an offset that the file cannot hold")));
  }
}

TEST(MeshFile, EmptyAndForeignFilesAreRefused) {
  const TemporaryFolder folder;
  for (const char* name : {"a.stl", "a.ply", "a.obj", "a.vtk", "a.vtp"}) {
    test::write_bytes(folder / name, "");
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / name); }), HasSubstr("empty"))
        << name;
    test::write_bytes(folder / name, "This is a letter to the surgeon.\n");
    EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / name); }), HasSubstr(name));
  }
  test::write_bytes(folder / "b.stl", "solid nothing\nendsolid nothing\n");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "b.stl"); }), HasSubstr("no triangle"));
  test::write_bytes(folder / "bone.docx", "x");
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)read_mesh(folder / "bone.docx"); }), HasSubstr("VTP"));
  EXPECT_THROW((void)read_mesh(folder / "absent.stl"), IoError);
  EXPECT_THROW((void)read_mesh(folder.path()), IoError);
}

// Programs differ: quads, corners counted from the end, two solids in a file, CRLF, a binary that begins with
// "solid".
TEST(MeshFile, VariantsOfOtherProgramsAreRead) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "quad.obj",
                    "v 0 0 0\r\nv 50 0 0\r\nv 50 50 0 1.0\r\nv 0 50 0\r\nf -4/1 -3/2 -2/3 -1/4\r\n");
  const auto quad = read_mesh(folder / "quad.obj");
  EXPECT_EQ(quad.triangles.size(), 2U);
  EXPECT_NEAR(geometry::surface_area_mm2(quad), 2500, 1e-9);

  std::string two = test::text_stl(bone_like()) + test::text_stl(test::ellipsoid({5, 5, 5}, 1));
  for (std::size_t at = 0; (at = two.find('\n', at)) != std::string::npos; at += 2)
    two.replace(at, 1, "\r\n");
  test::write_bytes(folder / "two.stl", two);
  EXPECT_EQ(read_mesh(folder / "two.stl").triangles.size(), 160U);

  test::write_bytes(folder / "solid.stl", test::binary_stl(bone_like(), "solid facet"));
  expect_same_surface(read_mesh(folder / "solid.stl"), bone_like());
}

TEST(MeshFile, WrittenPlyIsReadBackBitForBit) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = bone_like();
  for (auto& v : mesh.vertices_mm) v *= 1.0 + 1e-15;
  write_mesh_ply(folder / "bone.ply", mesh);
  const MeshFile back = read_mesh_file(folder / "bone.ply");
  EXPECT_EQ(back.mesh.triangles, mesh.triangles);
  EXPECT_EQ(back.mesh.vertices_mm, mesh.vertices_mm);
  EXPECT_TRUE(back.space_was_declared);
  write_mesh_stl(folder / "bone.stl", mesh);
  expect_same_surface(read_mesh(folder / "bone.stl"), mesh);
}

TEST(MeshFile, WhatCannotBeReadBackIsNotWritten) {
  const TemporaryFolder folder;
  geometry::TriangleMesh mesh = bone_like();
  mesh.vertices_mm[3].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_mesh_ply(folder / "bone.ply", mesh), InvalidInput);
  mesh = bone_like();
  mesh.triangles[3][0] = 42;
  EXPECT_THROW(write_mesh_ply(folder / "bone.ply", mesh), InvalidInput);
  EXPECT_THROW(write_mesh_stl(folder / "bone.stl", mesh), InvalidInput);
  EXPECT_EQ(folder.names().size(), 0U);
}

TEST(MeshFile, WordsAreParsedStrictly) {
  EXPECT_EQ(space_from_text("RAS"), Space::RAS);
  EXPECT_EQ(space_from_text("lps"), Space::LPS);
  EXPECT_THROW((void)space_from_text("lpsx"), InvalidInput);
  EXPECT_THROW((void)space_from_text(""), InvalidInput);
  EXPECT_EQ(length_unit_from_text("cm"), LengthUnit::Centimetre);
  EXPECT_THROW((void)length_unit_from_text("feet"), InvalidInput);
  EXPECT_EQ(mm_per(LengthUnit::Inch), 25.4);
}

}  // namespace
}  // namespace arthronaut::bones
