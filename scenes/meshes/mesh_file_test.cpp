#include "scenes/meshes/testing/mesh_files.h"

#include <fmt/format.h>

#include <bit>
#include <cstdio>
#include <fstream>
#include <map>

namespace boxwood {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv .25 0 1e+0\n"; // lines 1 to 4

TEST_F(MeshFile, ReadsObj) {
    const TriangleMesh mesh = load("two.obj", "# two\n" + vertices + "f 1 2 3\nf -4//1 -2 -1\n");
    EXPECT_EQ(soup(mesh), (std::vector{first, second}));
    EXPECT_EQ(mesh.vertices.size(), 4u);
}

TEST_F(MeshFile, ObjToleratesJunkContinuationsAndForwardReferences) {
    const auto mesh = load(
        "junk.obj", "6540 2180\nhello\nf 1 2 \\\n 3\n" + vertices +
                        "l 1 2\np 1\nf 1 2 # no triangle\ng part\nusemtl none\nf 1/1 3/1 4/2\n");
    EXPECT_EQ(soup(mesh), (std::vector{first, second}));
}

TEST_F(MeshFile, CutsPolygonsAndKeepsTheOrderOfFaces) {
    const auto mesh =
        load("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 5\n"
                         "usemtl a\nf 1 2 3 4\nusemtl b\nf 1 2 5\nusemtl a\nf 2 3 5\n");
    ASSERT_EQ(mesh.triangles.size(), 4u);
    const auto area = [&](std::size_t i) {
        const Triangle<float> t = mesh.triangle(i);
        return length(cross(t.b - t.a, t.c - t.a)) / 2;
    };
    EXPECT_EQ(area(0) + area(1), 1); // the quad first, whichever diagonal
    const auto turned = [](Triangle<float> t) {
        return testing::AnyOf(t, Triangle<float>{t.b, t.c, t.a}, Triangle<float>{t.c, t.a, t.b});
    };
    EXPECT_THAT(mesh.triangle(2), turned({{0, 0, 0}, {1, 0, 0}, {0, 0, 5}}));
    EXPECT_THAT(mesh.triangle(3), turned({{1, 0, 0}, {1, 1, 0}, {0, 0, 5}}));
}

TEST_F(MeshFile, JoinsEqualVerticesAndNoOthers) {
    const auto mesh =
        load("near.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0.0 0 0\nv 1e-30 0 0\nv 1 1 0\n"
                         "f 1 2 3\nf 4 2 6\nf 5 2 6\n");
    EXPECT_EQ(mesh.vertices.size(), 5u); // -0 is 0; 1e-30 is not
    EXPECT_EQ(mesh.triangles[1][0], mesh.triangles[0][0]);
    EXPECT_NE(mesh.triangles[2][0], mesh.triangles[0][0]);
}

TEST_F(MeshFile, ObjMayBeginWithAByteOrderMark) {
    EXPECT_EQ(soup(load("a.obj", "\xef\xbb\xbf" + vertices + "f 1 2 3\n")), std::vector{first});
}

TEST_F(MeshFile, ObjErrorsNameTheLine) {
    const std::string faces = "f 1 2 3\n";
    EXPECT_THAT(error("a.obj", vertices + faces + "f 1 2 5\n"),
                AllOf(HasSubstr("line 6"), HasSubstr("index 5")));
    EXPECT_THAT(error("b.obj", vertices + "f -1 -2 -5\n" + faces),
                AllOf(HasSubstr("line 5"), HasSubstr("-5")));
    EXPECT_THAT(error("c.obj", vertices + "f 0 1 2\n"), HasSubstr("line 5"));
    EXPECT_THAT(error("d.obj", vertices + "f 1 2 x\n"),
                AllOf(HasSubstr("line 5"), HasSubstr("'x'")));
    EXPECT_THAT(error("e.obj", vertices + "f 1 2 1.5\n"), HasSubstr("line 5"));
    for (const char* bad : {"nan", "-inf", "1e39", "1e999", "INF", "-NaN(0)"})
        EXPECT_THAT(error("f.obj", "v 0 0 0\nv 1 0 0\nv 0 " + std::string(bad) + " 0\n" + faces),
                    AllOf(HasSubstr("line 3"), HasSubstr(bad)));
    for (const char* bad : {"abc", "1,5", "0x10", "1.5.2", "--1", "+", "1e"})
        EXPECT_THAT(error("g.obj", "v 0 0 0\nv " + std::string(bad) + " 0 0\nv 0 1 0\n" + faces),
                    AllOf(HasSubstr("line 2"), HasSubstr("not a number")));
    EXPECT_THAT(error("h.obj", "v 0 0 0\nv 1 0\nv 0 1 0\n" + faces), HasSubstr("line 2"));
}

TEST_F(MeshFile, ObjNumbersInAllTheirForms) {
    const auto mesh = load("n.obj", "v +1 -.5 1.\nv 1E2 1e-50 -1e-400\nv 0.0 1 0 1.0\nf 1 2 3\r\n");
    EXPECT_EQ(mesh.triangle(0), (Triangle<float>{{1, -.5f, 1}, {100, 0, 0}, {0, 1, 0}}));
}

// assimp's own OBJ reader is an ulp off for one float in four.
TEST_F(MeshFile, ObjNumbersAreRoundedToNearest) {
    std::string text;
    std::vector<float> values;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const auto bits = i * 2654435761u;
        const float x = std::bit_cast<float>(bits);
        values.push_back(std::isfinite(x) ? x : 0);
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(values.back()));
        text += (i % 3 == 0 ? "v " : " ") + std::string(digits) + (i % 3 == 2 ? "\n" : "");
    }
    for (std::uint32_t v = 1; v + 2 <= 1000; v += 3)
        text += "f " + std::to_string(v) + ' ' + std::to_string(v + 1) + ' ' +
                std::to_string(v + 2) + '\n';
    const TriangleMesh mesh = load("numbers.obj", text);
    ASSERT_EQ(mesh.triangles.size(), 333u);
    for (std::size_t i = 0; i < 999; ++i)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(mesh.vertices[mesh.triangles[i / 3][i % 3]][axis],
                      values[3 * i + static_cast<std::size_t>(axis)]);
}

TEST_F(MeshFile, EmptyMeshesAreErrors) {
    EXPECT_THAT(error("empty.obj", ""), HasSubstr("is empty"));
    EXPECT_THAT(error("points.obj", vertices + vertices), HasSubstr("no triangles"));
    EXPECT_THAT(error("lines.obj", vertices + "l 1 2\nf 1 2\n"), HasSubstr("no triangles"));
    EXPECT_THAT(error("empty.stl", "solid t\nendsolid t\n"), HasSubstr("no triangles"));
    EXPECT_THAT(error("empty_binary.stl", std::string(84, '\0')),
                testing::Not(HasSubstr("no error")));
}

TEST_F(MeshFile, FilesThatCannotBeReadAreErrors) {
    EXPECT_THAT(error(folder_ / "missing.obj"), HasSubstr("no such file"));
    EXPECT_THAT(error(folder_ / "missing" / "a.obj"), HasSubstr("no such file"));
    EXPECT_THAT(error(folder_), HasSubstr("is a folder"));
    EXPECT_THAT(error("/dev/null"), HasSubstr("not a regular file"));
    EXPECT_THAT(error("what.xyz", "hello"), HasSubstr("No suitable reader"));
    const fs::path closed = write("closed.obj", vertices + "f 1 2 3\n");
    fs::permissions(closed, fs::perms::none);
    if (std::ifstream(closed).is_open()) // root reads everything
        EXPECT_EQ(load_mesh(closed).triangles.size(), 1u);
    else
        EXPECT_THAT(error(closed), HasSubstr("Permission denied"));
}

TEST_F(MeshFile, TheFirstVertexMayHaveAnyBytes) {
    for (std::uint32_t low_byte = 0; low_byte < 256; ++low_byte) {
        const auto x = std::bit_cast<float>(0x3f800100u | low_byte);
        const Triangle<float> expected{{x, 0, 0}, {0, 0, 0}, {0, 1, 0}};
        ASSERT_EQ(soup(load("a.obj", fmt::format("v {} 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n", x))),
                  std::vector{expected})
            << low_byte;
    }
}

std::string text_stl(const std::string& bad_vertex = "1 0 0") {
    return "solid two parts\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex " +
           bad_vertex +
           "\n   vertex 0 1 0\n  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n"
           "   vertex -0 0 0\n   vertex 0 1 0\n   vertex .25 0 1\n  endloop\n endfacet\nendsolid\n";
}

TEST_F(MeshFile, ReadsTextStlWithSharedVertices) {
    const TriangleMesh mesh = load("a.stl", text_stl());
    EXPECT_EQ(soup(mesh), (std::vector{first, second}));
    EXPECT_EQ(mesh.vertices.size(), 4u);
}

TEST_F(MeshFile, TextStlErrorsNameTheLine) {
    EXPECT_THAT(error("a.stl", text_stl("1 nan 0")), AllOf(HasSubstr("line 5"), HasSubstr("nan")));
    EXPECT_THAT(error("b.stl", text_stl("1 foo 0")),
                AllOf(HasSubstr("line 5"), HasSubstr("'foo'")));
    EXPECT_THAT(error("c.stl", text_stl("1 0")), HasSubstr("line 5"));
    const std::string good = text_stl();
    for (std::size_t size = 1; size + 2 < good.size(); size += 7)
        EXPECT_NE(error("d.stl", good.substr(0, size)), "no error") << size;
}

std::string binary_stl(float last, std::uint32_t count = 2) {
    std::string bytes = "solid, although binary";
    bytes.resize(80, ' ');
    append(bytes, count);
    for (const Triangle<float>& t : {first, second}) {
        for (const Vec3<float>& v : {Vec3<float>{0, 0, 1}, t.a, t.b, t.c})
            for (int axis = 0; axis < 3; ++axis)
                append(bytes, v[axis] == 0.25f ? last : v[axis]);
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

TEST_F(MeshFile, ReadsBinaryStlAndSaysWhatIsWrong) {
    const std::string good = binary_stl(0.25f);
    const TriangleMesh mesh = load("a.STL", good);
    EXPECT_EQ(soup(mesh), (std::vector{first, second}));
    EXPECT_EQ(mesh.vertices.size(), 4u);
    EXPECT_THAT(error("b.stl", binary_stl(HUGE_VALF)), HasSubstr("vertex 5"));
    EXPECT_THAT(error("c.stl", binary_stl(0.25f, 3)), HasSubstr("234 bytes, but the file has 184"));
    EXPECT_THAT(error("d.stl", binary_stl(0.25f, 4000000000u)), HasSubstr("truncated"));
    EXPECT_THAT(error("e.stl", good + '\0'), HasSubstr("the file has 185"));
    for (std::size_t size = 1; size < good.size(); ++size)
        EXPECT_NE(error("f.stl", good.substr(0, size)), "no error") << size;
}

// COLLADA has a tree of nodes: one geometry placed twice, the second time moved by (10, 0, 0)
// within a parent that scales by 2.
TEST_F(MeshFile, AppliesNodeTransforms) {
    const auto mesh = load("nodes.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="one"><instance_geometry url="#g"/></node>
<node id="two"><scale>2 2 2</scale><node id="three"><translate>10 0 0</translate>
<instance_geometry url="#g"/></node></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
    EXPECT_EQ(soup(mesh),
              (std::vector{first, Triangle<float>{{20, 0, 0}, {22, 0, 0}, {20, 2, 0}}}));
}

TEST(SharedMeshes, LoadWithTheCountsTheirFilesTell) {
    const fs::path folder = "../shared/data";
    if (!fs::is_directory(folder))
        GTEST_SKIP() << folder << " is not here: the sample meshes are no part of the project";
    const std::map<std::string, std::size_t> counts{
        {"meshes/env.obj", 2180},    {"meshes/rob.obj", 216},
        {"meshes/spot.obj", 5856},   {"meshes/stanford-bunny.obj", 69451},
        {"meshes/teapot.obj", 6320}, {"robots/panda/meshes/collision/finger.stl", 32}};
    for (const auto& [file, count] : counts)
        EXPECT_EQ(load_mesh(folder / file).triangles.size(), count) << file;
    for (const auto& entry : fs::recursive_directory_iterator(folder / "robots"))
        if (entry.path().extension() == ".stl" || entry.path().extension() == ".STL") {
            EXPECT_EQ(load_mesh(entry.path()).triangles.size(), (entry.file_size() - 84) / 50)
                << entry.path();
        }
}

} // namespace
} // namespace boxwood
