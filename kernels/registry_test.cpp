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
    EXPECT_EQ(families,
              (std::set<std::string_view>{"box_box", "box_fit", "convex_convex", "edge_edge",
                                          "obb_obb", "point_segment", "point_triangle", "ray_box",
                                          "ray_triangle", "segment_segment", "triangle_distance",
                                          "triangle_triangle", "vertex_face"}));
}

/// Each kernel of the tuple has a row of the family, by whose name it is found.
template <class Kernels, class NameOf> void expect_found(std::string_view family, NameOf name_of) {
    std::size_t n = 0;
    for (const KernelInfo& info : kernels()) {
        if (info.family != family)
            continue;
        ++n;
        std::string_view found;
        EXPECT_TRUE(with_kernel<Kernels>(info.name, [&](auto k) { found = name_of(k); }));
        EXPECT_EQ(found, info.name);
    }
    EXPECT_EQ(n, std::tuple_size_v<Kernels>) << family;
}

TEST(Registry, EveryNameFindsItsKernel) {
    using std::type_identity;
    expect_found<RayKernels>("ray_triangle", []<RayKernel K>(type_identity<K>) { return K::name; });
    expect_found<RayBoxKernels>("ray_box",
                                []<RayBoxKernel K>(type_identity<K>) { return K::name; });
    expect_found<TriangleKernels>("triangle_triangle",
                                  []<TriangleKernel K>(type_identity<K>) { return K::name; });
    expect_found<DistanceKernels>(
        "triangle_distance", []<TriangleDistanceKernel K>(type_identity<K>) { return K::name; });
    expect_found<SegmentDistanceKernels>(
        "segment_segment", []<SegmentDistanceKernel K>(type_identity<K>) { return K::name; });
    expect_found<PointTriangleKernels>(
        "point_triangle", []<PointTriangleKernel K>(type_identity<K>) { return K::name; });
    expect_found<PointSegmentKernels>(
        "point_segment", []<PointSegmentKernel K>(type_identity<K>) { return K::name; });
    expect_found<BoxFitKernels>("box_fit",
                                []<BoxFitKernel K>(type_identity<K>) { return K::name; });
    expect_found<ObbKernels>("obb_obb", []<ObbKernel K>(type_identity<K>) { return K::name; });
    for (const char* family : {"vertex_face", "edge_edge"})
        expect_found<ContinuousKernels>(
            family, []<ContinuousKernel K>(type_identity<K>) { return K::name; });
    for (const KernelInfo& info : ray_kernels())
        EXPECT_EQ(info.family, "ray_triangle");
    for (const KernelInfo& info : triangle_kernels())
        EXPECT_EQ(info.family, "triangle_triangle");
    EXPECT_FALSE(with_kernel<RayKernels>("watertigth", [](auto) { FAIL(); }));
}

} // namespace
} // namespace boxwood
