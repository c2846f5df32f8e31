#include "scenes/meshes/testing/mesh_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace boxwood {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string ply(const std::string& body, int n_vertices = 4) {
    return "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex " +
           std::to_string(n_vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n" // line 8
           "property list uchar int vertex_indices\nend_header\n" +                   // line 10
           body;
}
const std::string ply_vertices = "0 0 0\n1 0 0\n0 1 0\n.25 0 1\n"; // lines 11 to 14

TEST_F(MeshFile, ReadsPly) {
    EXPECT_EQ(soup(load("a.ply", ply(ply_vertices + "3 0 1 2\n3 0 2 3\n"))),
              (std::vector{first, second}));
}

TEST_F(MeshFile, PlyErrorsNameTheLine) {
    EXPECT_THAT(error("a.ply", ply(ply_vertices + "3 0 1 2\n3 0 1 4\n")),
                AllOf(HasSubstr("line 16"), HasSubstr("index 4")));
    EXPECT_THAT(error("b.ply", ply(ply_vertices + "3 0 1 2\n3 0 1 -1\n")),
                AllOf(HasSubstr("line 16"), HasSubstr("-1")));
    EXPECT_THAT(error("c.ply", ply("0 0 0\n1 nan 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n")),
                HasSubstr("line 12"));
    EXPECT_THAT(error("d.ply", ply("0 0 0\n1 0 0\n0 x 0\n0 0 1\n3 0 1 2\n3 0 1 3\n")),
                HasSubstr("line 13"));
    EXPECT_THAT(error("e.ply", ply(ply_vertices + "3 0 1 2\n")),
                HasSubstr("1 of 2 elements 'face'"));
    EXPECT_THAT(error("f.ply", ply("0 0 0\n")), HasSubstr("1 of 4 elements 'vertex'"));
    EXPECT_THAT(error("g.ply", ply(ply_vertices + "3 0 1 2\n3 0 1\n")), HasSubstr("line 16"));
    EXPECT_THAT(error("h.ply", ply("0 0 0\n1 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 3\n")),
                HasSubstr("line 12"));
    EXPECT_THAT(error("i.ply", "ply\nformat ascii 1.0\nelement vertex 4\n"),
                HasSubstr("end_header"));
    EXPECT_THAT(error("j.ply", "ply\nformat ascii 1.0\nelement vertex many\nend_header\n"),
                HasSubstr("line 3"));
}

std::string binary_ply(float last_z, std::int32_t last_index) {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
                        "property float y\nproperty float z\nelement face 2\n"
                        "property list uchar int vertex_indices\nend_header\n";
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, .25f, 0.f, last_z})
        append(bytes, x);
    for (const std::array<std::int32_t, 3>& t :
         {std::array{0, 1, 2}, std::array{0, 2, last_index}}) {
        bytes += '\3';
        for (const std::int32_t index : t)
            append(bytes, index);
    }
    return bytes;
}

TEST_F(MeshFile, ReadsBinaryPlyAndSaysWhatIsWrong) {
    const std::string good = binary_ply(1, 3);
    EXPECT_EQ(soup(load("a.ply", good)), (std::vector{first, second}));
    EXPECT_THAT(error("b.ply", binary_ply(std::nanf(""), 3)), HasSubstr("vertex 3"));
    EXPECT_THAT(error("c.ply", binary_ply(1, 4)), AllOf(HasSubstr("face 1"), HasSubstr("index 4")));
    EXPECT_THAT(error("d.ply", binary_ply(1, -1)),
                AllOf(HasSubstr("face 1"), HasSubstr("index -1")));
    for (std::size_t size = good.find("end_header"); size < good.size(); ++size)
        EXPECT_THAT(error("e.ply", good.substr(0, size)), HasSubstr("truncated")) << size;
    EXPECT_THAT(error("g.ply", std::string(good).replace(good.find("property"), 4, "pope")),
                HasSubstr("'popeerty' is no word of a PLY header"));
    EXPECT_THAT(error("h.ply", std::string(good).replace(good.find("_endian"), 7, "_indian")),
                HasSubstr("is not a PLY format"));
}

TEST_F(MeshFile, PlyHeadersThatCannotBeMeant) {
    const std::string good = ply(ply_vertices + "3 0 1 2\n3 0 1 3\n");
    const auto changed = [&](std::string_view from, std::string_view to) {
        return error("a.ply", std::string(good).replace(good.find(from), from.size(), to));
    };
    EXPECT_EQ(changed("", ""), "no error");
    EXPECT_THAT(changed("float x", "float px"), HasSubstr("no property 'x'"));
    EXPECT_THAT(changed("float z", "float Z"), HasSubstr("no property 'z'"));
    EXPECT_THAT(changed("float y", "list uchar float y"), HasSubstr("no property 'y'"));
    EXPECT_THAT(changed("float y", "float x"), HasSubstr("a second property 'x'"));
    EXPECT_THAT(changed("element face", "element vertex"), HasSubstr("a second element 'vertex'"));
    EXPECT_THAT(changed("ascii 1.0", "ascii 1.1"), HasSubstr("version '1.1'"));
    EXPECT_EQ(error("b.ply", good + " \r\n\n"), "no error");
    EXPECT_THAT(error("b.ply", good + "3 0 1 2\n"), HasSubstr("8 bytes follow"));
    EXPECT_THAT(error("b.ply", binary_ply(1, 3) + "m"), HasSubstr("1 bytes follow"));
}

/// The values of a PLY file's body in one of its formats.
class PlyBody {
  public:
    explicit PlyBody(std::string format) : format_(std::move(format)) {}

    template <class T> PlyBody& put(std::initializer_list<T> values) {
        for (const T value : values)
            if (format_ == "ascii") {
                bytes_ += std::to_string(value) + "\t ";
            } else {
                append(bytes_, value);
                if (format_ == "binary_big_endian")
                    std::reverse(bytes_.end() - sizeof value, bytes_.end());
            }
        return *this;
    }
    PlyBody& end() {
        bytes_ += format_ == "ascii" ? "\r\n" : "";
        return *this;
    }
    std::string after(const std::string& header) const {
        return "ply\r\nformat " + format_ + " 1.0\r\n" + header + "end_header\r\n" + bytes_;
    }

  private:
    std::string format_, bytes_;
};
const std::array<std::string, 3> ply_formats{"ascii", "binary_little_endian", "binary_big_endian"};

TEST_F(MeshFile, PlyMayHoldMuchElse) {
    const std::string header =
        "comment element vertex 9\r\nobj_info \x01 any thing\r\nelement camera 2\r\n"
        "property list int8 short lenses\r\nproperty\tuint  x\r\nelement nothing 7\r\n"
        "element face 3\r\nproperty char flag\r\nproperty list int8 uint32 vertex_index\r\n"
        "property list uint float texcoord\r\nelement vertex 5\r\nproperty uchar red\r\n"
        "property double z\r\nproperty list uint8 double weights\r\nproperty int16 x\r\n"
        "property float64 y\r\nproperty int32 index\r\nelement edge 1\r\nproperty int a\r\n"
        "property int b\r\n";
    for (const std::string& format : ply_formats) {
        PlyBody body(format);
        body.put<std::int8_t>({2}).put<std::int16_t>({7, -8}).put<std::uint32_t>({9}).end();
        body.put<std::int8_t>({0}).put<std::uint32_t>({4000000000u}).end();
        const auto face = [&](std::initializer_list<std::uint32_t> corners) {
            body.put<std::int8_t>({-1, static_cast<std::int8_t>(corners.size())}).put(corners);
            body.put<std::uint32_t>({2}).put({.5f, .25f}).end();
        };
        face({4, 1, 2});
        face({1, 2}); // a line
        face({0, 1, 3, 2});
        for (const std::array<std::int16_t, 3>& p :
             {std::array<std::int16_t, 3>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {-5, 2, 3}}) {
            body.put<std::uint8_t>({200}).put<double>({double(p[2])}).put<std::uint8_t>({1});
            body.put<double>({1e9}).put<std::int16_t>({p[0]}).put<double>({double(p[1])});
            body.put<std::int32_t>({-1}).end();
        }
        body.put<std::int32_t>({0, 4}).end();
        const TriangleMesh mesh = load("a.ply", body.after(header));
        ASSERT_EQ(mesh.triangles.size(), 3u) << format;
        double area = 0;
        for (const Triangle<float>& t : {mesh.triangle(1), mesh.triangle(2)})
            area += static_cast<double>(cross(t.b - t.a, t.c - t.a).z) / 2;
        EXPECT_EQ(area, 1) << format;
        const Triangle<float> t = mesh.triangle(0);
        EXPECT_EQ(t.a + t.b + t.c, (Vec3<float>{-4, 3, 3})) << format;
        for (std::size_t size = header.size(); size + 6 < body.after(header).size(); ++size)
            EXPECT_NE(error("b.ply", body.after(header).substr(0, size)), "no error") << format;
    }
}

TEST_F(MeshFile, PlyStripsAreCut) {
    const std::string header =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\n";
    for (const std::string& format : ply_formats) {
        PlyBody body(format);
        for (const Vec3<float> p : {first.a, first.b, first.c, {1, 1, 0}})
            body.put({p.x, p.y, p.z}).end();
        body.put<std::int32_t>({9, 0, 1, 2, 3, -1, 0, 1, -1, 1}).end();
        EXPECT_EQ(soup(load("a.ply", body.after(header))),
                  (std::vector{first, Triangle<float>{{0, 1, 0}, {1, 0, 0}, {1, 1, 0}}}))
            << format;
    }
}

TEST_F(MeshFile, PlyNumbersAreRoundedToNearest) {
    for (const float x : {0.1f, 0.3f, 1.1f, 123456.79f, 7.0064923e-45f, 3.4028235e38f}) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(x));
        const auto mesh = load("a.ply", ply("0 0 0\n1 0 0\n0 1 0\n0 0 " + std::string(digits) +
                                            "\n3 0 1 2\n3 0 1 3\n"));
        EXPECT_EQ(mesh.triangle(1).c.z, x) << digits;
    }
    const std::string header =
        "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
        "element face 1\nproperty list uchar uchar vertex_indices\n";
    for (const double x : {0.1, 1e300, double(NAN)}) {
        PlyBody body("binary_big_endian");
        body.put({0., 0., 0., x, 0., 0., 0., 1., 0.}).put<std::uint8_t>({3, 0, 1, 2});
        if (x == 0.1)
            EXPECT_EQ(load("b.ply", body.after(header)).triangle(0).b.x, 0.1f);
        else
            EXPECT_THAT(error("b.ply", body.after(header)),
                        AllOf(HasSubstr("vertex 1"), HasSubstr("not a finite float")));
    }
    EXPECT_THAT(error("c.ply", "ply\nformat binary_little_endian 1.0\nelement nothing 9999999999\n"
                               "element face 1\nproperty list char char vertex_indices\n"
                               "end_header\n\xff"),
                HasSubstr("face 0: a list of -1 values"));
}

} // namespace
} // namespace boxwood
