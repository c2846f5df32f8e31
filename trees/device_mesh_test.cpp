/// Compiled twice, as device_test.cpp.

#include "trees/builder.h"
#include "trees/device.h"
#include "trees/layout.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::pair<DeviceRayKernel, const char*> kernels[] = {
    {DeviceRayKernel::watertight, "watertight"},
    {DeviceRayKernel::moller_trumbore_f32, "moller_trumbore_f32"},
    {DeviceRayKernel::moller_trumbore_f64, "moller_trumbore_f64"}};

std::vector<Ray<float>> rays() {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = RayHit::nowhere;
    std::vector<Ray<float>> some, all = test_rays();
    for (std::size_t i = 0; i < all.size(); i += 9)
        some.push_back(all[i]);
    some.insert(some.end(), {{{nan, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, inf, 0}}});
    return some;
}

struct Wanted {
    std::vector<RayHit> closest;
    AnswersOf<RayHit> all;

    Wanted(const TriangleMesh& mesh, const std::vector<Ray<float>>& of, const char* kernel)
        : closest(of.size()) {
        const auto layout = find_layout("binary").make(
            make_builder("median")(triangle_boxes(mesh), serial()), serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        layout->rays(of, RayQuery::closest, kernel, triangles, serial(), closest);
        AppendHits sink;
        layout->rays_all(of, kernel, triangles, serial(), sink);
        all.offsets.resize(of.size() + 1);
        for (const auto& [ray, hit] : sink.all) {
            ++all.offsets[ray + 1];
            all.of.push_back(hit);
        }
        std::partial_sum(all.offsets.begin(), all.offsets.end(), all.offsets.begin());
    }
};

void expect_same_bits(const std::vector<RayHit>& found, const std::vector<RayHit>& wanted) {
    ASSERT_EQ(found.size(), wanted.size());
    EXPECT_EQ(found, wanted);
    EXPECT_TRUE(found.empty() ||
                std::memcmp(found.data(), wanted.data(), found.size() * sizeof(RayHit)) == 0);
}

void expect_answers(const DeviceMeshBvh& bvh, const std::vector<Ray<float>>& of,
                    const Wanted& wanted) {
    expect_same_bits(bvh.closest_hits(of), wanted.closest);
    const std::vector<RayHit> any = bvh.any_hits(of);
    for (std::size_t i = 0; i < of.size(); ++i)
        EXPECT_EQ(any[i].hit(), wanted.closest[i].hit()) << i;
    const DeviceArray<Ray<float>> there(std::span<const Ray<float>>(of), DevicePlace{});
    expect_same_bits(bvh.closest_hits(there.span()).to_host(), wanted.closest);
    if (bvh.options().builder == DeviceBuilder::hilbert) {
        EXPECT_THAT([&] { bvh.all_hits(of); },
                    ThrowsMessage<std::invalid_argument>(HasSubstr("lbvh and hploc")));
        return;
    }
    const AnswersOf<RayHit> all = bvh.all_hits(of);
    EXPECT_EQ(all.offsets, wanted.all.offsets);
    expect_same_bits(all.of, wanted.all.of);
}

class MeshOnADevice : public ::testing::TestWithParam<std::tuple<DeviceBuilder, bool>> {
  protected:
    void SetUp() override {
        if (devices().empty())
            GTEST_SKIP() << why_no_device();
    }
    DeviceMeshBvhOptions options() const {
        return {.builder = std::get<0>(GetParam()), .sort_rays = std::get<1>(GetParam())};
    }
};
INSTANTIATE_TEST_SUITE_P(Device, MeshOnADevice,
                         ::testing::Combine(::testing::Values(DeviceBuilder::hilbert,
                                                              DeviceBuilder::lbvh,
                                                              DeviceBuilder::hploc),
                                            ::testing::Bool()));

TEST_P(MeshOnADevice, AnswersAsTheCpu) {
    const std::vector<Ray<float>> all_rays = rays(), few(all_rays.begin(), all_rays.begin() + 15);
    for (const std::uint32_t n : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u}) {
        if (options().sort_rays && n != 1 && n != 257)
            continue;
        SCOPED_TRACE(n);
        const TriangleMesh mesh = triangle_soup(n);
        const std::vector<Ray<float>>& of = n == 257 ? all_rays : few;
        for (const auto& [kernel, name] : kernels) {
            DeviceMeshBvhOptions by = options();
            by.kernel = kernel;
            if (n != 257 && kernel != DeviceRayKernel::watertight)
                continue;
            SCOPED_TRACE(name);
            const DeviceMeshBvh bvh(mesh, by);
            EXPECT_EQ(bvh.size(), n);
            expect_answers(bvh, of, Wanted(mesh, of, name));
        }
    }
}

TEST_P(MeshOnADevice, FollowsItsVertices) {
    TriangleMesh mesh = sphere(12);
    const std::vector<Ray<float>> of = rays();
    DeviceMeshBvh bvh(mesh, options());
    expect_answers(bvh, of, Wanted(mesh, of, "watertight"));
    const std::vector<Vec3<float>> before = mesh.vertices;
    for (Vec3<float>& v : mesh.vertices)
        v = {v.x * .5f + .2f * v.y, v.y, v.z * 1.5f};
    bvh.update(mesh.vertices);
    expect_answers(bvh, of, Wanted(mesh, of, "watertight"));

    std::vector<Vec3<float>> bad = mesh.vertices;
    for (const float odd : {std::numeric_limits<float>::quiet_NaN(), RayHit::nowhere, 0x1p126f}) {
        bad[20].y = odd;
        EXPECT_THROW(bvh.update(bad), std::invalid_argument); // of an InvalidBox, too
        EXPECT_EQ(bvh.size(), 0u);
        EXPECT_FALSE(bvh.closest_hits(of)[5].hit());
        bvh.update(mesh.vertices);
        EXPECT_EQ(bvh.size(), mesh.triangles.size());
        expect_same_bits(bvh.closest_hits(of), Wanted(mesh, of, "watertight").closest);
    }
    EXPECT_THAT([&] { bvh.update(std::span(before).first(9)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("updated by 9")));
}

TEST_P(MeshOnADevice, MayLieThereAlready) {
    const TriangleMesh mesh = sphere(12);
    const std::vector<Ray<float>> of = rays();
    const DeviceArray<DeviceMeshBvh::Corners> triangles(
        std::span<const DeviceMeshBvh::Corners>(mesh.triangles), DevicePlace{});
    DeviceArray<Vec3<float>> vertices(std::span<const Vec3<float>>(mesh.vertices), DevicePlace{});
    DeviceMeshBvh bvh(vertices.span(), triangles.span(), options());
    vertices.write(std::vector<Vec3<float>>(mesh.vertices.size())); // they were copied
    expect_answers(bvh, of, Wanted(mesh, of, "watertight"));
    vertices.write(mesh.vertices);
    bvh.update(vertices.span());
    const DeviceMeshBvh other = std::move(bvh);
    expect_answers(other, of, Wanted(mesh, of, "watertight"));
}

TEST_P(MeshOnADevice, BadInputIsNamed) {
    TriangleMesh mesh = triangle_soup(300);
    mesh.triangles[40][1] = 900;
    mesh.triangles[100][0] = 7000;
    EXPECT_THAT([&] { DeviceMeshBvh(mesh, options()); },
                ThrowsMessage<std::invalid_argument>("triangle 40 has the vertex 900, of 900"));
    mesh = triangle_soup(300);
    for (const int corner : {0, 1, 2}) {
        TriangleMesh bad = mesh;
        bad.vertices[mesh.triangles[200][static_cast<std::size_t>(corner)]].z =
            std::numeric_limits<float>::quiet_NaN();
        EXPECT_THAT([&] { DeviceMeshBvh(bad, options()); },
                    ThrowsMessage<InvalidBox>("box 200: NaN in z"));
    }
    mesh.vertices[3].x = 0x1p127f;
    EXPECT_THAT([&] { DeviceMeshBvh(mesh, options()); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("2^126")));
    mesh.vertices[3].x = RayHit::nowhere;
    EXPECT_THROW(DeviceMeshBvh(mesh, options()), InvalidBox);
}

TEST_P(MeshOnADevice, RaysMayBeNone) {
    const DeviceMeshBvh bvh(triangle_soup(20), options());
    EXPECT_TRUE(bvh.closest_hits(std::span<const Ray<float>>{}).empty());
    if (options().builder != DeviceBuilder::hilbert) {
        EXPECT_EQ(bvh.all_hits(std::span<const Ray<float>>{}).offsets.size(), 1u);
    }
}

} // namespace
} // namespace boxwood
