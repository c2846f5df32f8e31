#include "trees/queries/sides.h"

#include "kernels/testing/closed_meshes.h"
#include "trees/builders/spatial_sah.h"
#include "trees/mesh_bvh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Some of n x n x n unit cubes, and the mesh of the faces between cubes and air. Its vertices,
/// edges and faces are all in line with one another: what no vote of rays gets through.
class Cubes {
  public:
    Cubes(int n, double share, unsigned seed) : n_(n) {
        std::mt19937 random(seed);
        for (int i = 0; i < n * n * n; ++i)
            filled_.push_back(std::bernoulli_distribution(share)(random));
    }

    TriangleMesh mesh(bool shares_vertices) const {
        TriangleMesh mesh;
        std::map<std::array<int, 3>, std::uint32_t> known;
        const auto vertex = [&](std::array<int, 3> at) {
            const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
            const auto [found, is_new] = known.try_emplace(at, next);
            if (!is_new && shares_vertices)
                return found->second;
            mesh.vertices.push_back(
                {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
            return next;
        };
        for_each_cube([&](std::array<int, 3> low) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const int side : {0, 1}) {
                    std::array<int, 3> beyond = low;
                    beyond[axis] += side ? 1 : -1;
                    if (is_filled(beyond))
                        continue;
                    std::array<std::uint32_t, 4> corners{};
                    for (std::size_t k = 0; k < 4; ++k) {
                        std::array<int, 3> at = low;
                        at[axis] += side;
                        at[(axis + 1) % 3] += k == 1 || k == 2;
                        at[(axis + 2) % 3] += k >= 2;
                        corners[k] = vertex(at);
                    }
                    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
                    mesh.triangles.push_back({corners[0], corners[2], corners[3]});
                }
        });
        return mesh;
    }

    /// By the cubes that the point touches, in halves of a cube.
    Side side(std::array<int, 3> doubled) const {
        int touched = 0, filled = 0;
        for (int k = 0; k < 8; ++k) {
            std::array<int, 3> cube{};
            bool is_another = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const bool between = doubled[axis] % 2 == 0;
                const bool second = k >> axis & 1;
                is_another = is_another && (between || !second);
                cube[axis] = (doubled[axis] >> 1) - (between && second);
            }
            if (is_another) {
                ++touched;
                filled += is_filled(cube);
            }
        }
        return filled == 0 ? Side::outside : filled == touched ? Side::inside : Side::on_surface;
    }

  private:
    bool is_filled(std::array<int, 3> cube) const {
        int index = 0;
        for (const int c : cube) {
            if (c < 0 || c >= n_)
                return false;
            index = index * n_ + c;
        }
        return filled_[static_cast<std::size_t>(index)];
    }
    template <class F> void for_each_cube(const F& f) const {
        for (int x = 0; x < n_; ++x)
            for (int y = 0; y < n_; ++y)
                for (int z = 0; z < n_; ++z)
                    if (is_filled({x, y, z}))
                        f(std::array<int, 3>{x, y, z});
    }

    int n_;
    std::vector<bool> filled_;
};

TEST(Sides, OfCubesInLineWithEverything) {
    constexpr int n = 6;
    for (unsigned seed = 0; seed < 8; ++seed) {
        const Cubes cubes(n, 0.2 + 0.1 * seed, seed);
        std::vector<Vec3<float>> points;
        std::vector<Side> expected;
        for (int x = -1; x <= 2 * n + 1; ++x)
            for (int y = -1; y <= 2 * n + 1; ++y)
                for (int z = -1; z <= 2 * n + 1; ++z) {
                    points.push_back({static_cast<float>(x) / 2, static_cast<float>(y) / 2,
                                      static_cast<float>(z) / 2});
                    expected.push_back(cubes.side({x, y, z}));
                }
        const MeshBvh bvh(cubes.mesh(seed % 2 == 0), {.threads = 1 + seed % 2});
        EXPECT_EQ(bvh.open_edges(), 0u);
        EXPECT_EQ(bvh.sides(points), expected) << "seed " << seed;
    }
}

/// The solid angle of a triangle seen from p, after van Oosterom and Strackee.
double solid_angle(Vec3<double> p, const Triangle<float>& t) {
    const Vec3<double> a = Vec3<double>(t.a) - p, b = Vec3<double>(t.b) - p,
                       c = Vec3<double>(t.c) - p;
    const double la = length(a), lb = length(b), lc = length(c);
    return 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

TEST(Sides, AgreeWithTheSolidAngleInEveryWayToBuild) {
    const TriangleMesh mesh = uv_sphere(24, 12);
    std::vector<Vec3<float>> points(mesh.vertices); // on the surface
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.2f, 1.2f);
    for (int i = 0; i < 2000; ++i)
        points.push_back({uniform(random), uniform(random), uniform(random)});
    for (const MeshBvhOptions& options :
         {MeshBvhOptions{}, MeshBvhOptions{.layout = LayoutName::packed, .threads = 2},
          MeshBvhOptions{.builder = SpatialSahBuilder{}}}) {
        const MeshBvh bvh(mesh, options);
        const std::vector<Side> found = bvh.sides(points);
        const std::vector<double> distances = bvh.signed_distances(points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (i < mesh.vertices.size()) {
                EXPECT_EQ(found[i], Side::on_surface);
                EXPECT_EQ(distances[i], 0);
                continue;
            }
            double angle = 0;
            for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
                angle += solid_angle(Vec3<double>(points[i]), mesh.triangle(t));
            const bool inside = std::abs(angle) > 2 * std::numbers::pi;
            EXPECT_EQ(found[i], inside ? Side::inside : Side::outside) << i;
            EXPECT_EQ(distances[i] < 0, inside);
            EXPECT_EQ(bvh.side(points[i]), found[i]);
            EXPECT_EQ(bvh.signed_distance(points[i]), distances[i]);
        }
    }
}

TEST(Sides, RefuseOpenMeshesAndSayHowOpenTheyAre) {
    TriangleMesh mesh = uv_sphere(8, 4);
    mesh.triangles.pop_back();
    const MeshBvh open(mesh);
    EXPECT_EQ(open.open_edges(), 3u);
    EXPECT_THAT(
        [&] {
            open.side({0, 0, 0});
        },
        ThrowsMessage<std::invalid_argument>(HasSubstr("3 of its edges")));
    EXPECT_THROW(open.signed_distance({0, 0, 0}), std::invalid_argument);
}

TEST(Sides, VerticesOfNoTriangleMayBeAnything) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    TriangleMesh mesh = uv_sphere(8, 4);
    mesh.triangles.pop_back();
    for (std::size_t at = 0; at <= mesh.vertices.size(); ++at) {
        TriangleMesh with = mesh;
        with.vertices.insert(with.vertices.begin() + static_cast<std::ptrdiff_t>(at),
                             {nan, 0, nan});
        for (auto& triangle : with.triangles)
            for (std::uint32_t& corner : triangle)
                corner += corner >= at;
        EXPECT_EQ(MeshBvh(with).open_edges(), 3u) << at;
    }
}

TEST(Sides, OfNoMeshAndOfNoPoint) {
    const MeshBvh none;
    EXPECT_EQ(none.side({0, 0, 0}), Side::outside);
    EXPECT_EQ(none.signed_distance({0, 0, 0}), std::numeric_limits<double>::infinity());
    const MeshBvh sphere(uv_sphere(8, 4));
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(sphere.side({0, nan, 0}), Side::outside);
    EXPECT_EQ(sphere.side({0, 0, -std::numeric_limits<float>::infinity()}), Side::outside);
}

TEST(Sides, TrianglesWithoutAreaAreSurfaceToo) {
    TriangleMesh mesh = uv_sphere(8, 4);
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back({0, 0, 0.5f});
    mesh.triangles.push_back({n, n, n});
    mesh.triangles.push_back({0, n, n});
    const MeshBvh bvh(mesh);
    EXPECT_EQ(bvh.side({0, 0, 0}), Side::inside);
    EXPECT_EQ(bvh.side({0, 0, 0.5f}), Side::on_surface);
    EXPECT_EQ(bvh.side({0, 0, 0.75f}), Side::on_surface);
    EXPECT_EQ(bvh.side({0, 0, 2}), Side::outside);
}

} // namespace
} // namespace boxwood
