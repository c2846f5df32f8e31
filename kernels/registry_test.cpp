#include "kernels/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace boxwood {
namespace {

bool is_name(std::string_view s) {
    return !s.empty() && std::all_of(s.begin(), s.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    });
}

TEST(Registry, RowsAreNamedOnceEachWithASummary) {
    std::set<std::string> names;
    for (const KernelInfo& info : kernels()) {
        EXPECT_TRUE(is_name(info.family)) << info.family;
        EXPECT_TRUE(is_name(info.name)) << info.name;
        EXPECT_FALSE(info.summary.empty()) << info.name;
        EXPECT_EQ(info.summary.find('\n'), std::string_view::npos);
        EXPECT_TRUE(names.insert(std::string(info.family) + '/' + std::string(info.name)).second);
    }
    EXPECT_EQ(kernels().size(), names.size());
}

TEST(Registry, EveryFamilyIsListed) {
    std::set<std::string_view> families;
    for (const KernelInfo& info : kernels())
        families.insert(info.family);
    EXPECT_EQ(families, (std::set<std::string_view>{
                            "box_box", "box_fit", "edge_edge", "obb_obb", "point_segment",
                            "point_triangle", "ray_box", "ray_triangle", "segment_segment",
                            "triangle_distance", "triangle_triangle", "vertex_face"}));
}

TEST(Registry, EveryNameFindsItsKernel) {
    for (const KernelInfo& info : ray_kernels()) {
        EXPECT_EQ(info.family, "ray_triangle");
        std::string_view found;
        EXPECT_TRUE(with_kernel<RayKernels>(
            info.name, [&]<RayKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : ray_box_kernels()) {
        EXPECT_EQ(info.family, "ray_box");
        std::string_view found;
        EXPECT_TRUE(with_kernel<RayBoxKernels>(
            info.name, [&]<RayBoxKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : triangle_kernels()) {
        EXPECT_EQ(info.family, "triangle_triangle");
        std::string_view found;
        EXPECT_TRUE(with_kernel<TriangleKernels>(
            info.name, [&]<TriangleKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : distance_kernels()) {
        EXPECT_EQ(info.family, "triangle_distance");
        std::string_view found;
        EXPECT_TRUE(with_kernel<DistanceKernels>(
            info.name, [&]<TriangleDistanceKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : segment_distance_kernels()) {
        EXPECT_EQ(info.family, "segment_segment");
        std::string_view found;
        EXPECT_TRUE(with_kernel<SegmentDistanceKernels>(
            info.name, [&]<SegmentDistanceKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : point_triangle_kernels()) {
        EXPECT_EQ(info.family, "point_triangle");
        std::string_view found;
        EXPECT_TRUE(with_kernel<PointTriangleKernels>(
            info.name, [&]<PointTriangleKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : point_segment_kernels()) {
        EXPECT_EQ(info.family, "point_segment");
        std::string_view found;
        EXPECT_TRUE(with_kernel<PointSegmentKernels>(
            info.name, [&]<PointSegmentKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : box_fit_kernels()) {
        EXPECT_EQ(info.family, "box_fit");
        std::string_view found;
        EXPECT_TRUE(with_kernel<BoxFitKernels>(
            info.name, [&]<BoxFitKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : obb_kernels()) {
        EXPECT_EQ(info.family, "obb_obb");
        std::string_view found;
        EXPECT_TRUE(with_kernel<ObbKernels>(
            info.name, [&]<ObbKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    EXPECT_EQ(vertex_face_kernels().size(), edge_edge_kernels().size());
    for (const KernelInfo& info : vertex_face_kernels()) {
        EXPECT_EQ(info.family, "vertex_face");
        std::string_view found;
        EXPECT_TRUE(with_kernel<ContinuousKernels>(
            info.name, [&]<ContinuousKernel K>(std::type_identity<K>) { found = K::name; }));
        EXPECT_EQ(found, info.name);
    }
    for (const KernelInfo& info : edge_edge_kernels())
        EXPECT_EQ(info.family, "edge_edge");
    EXPECT_FALSE(with_kernel<RayKernels>("watertigth", [](auto) { FAIL(); }));
}

} // namespace
} // namespace boxwood
