#include "scenes/hard_cases/hard_cases.h"

#include "scenes/sampling/random.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

// To add a family: its file, which defines `HardCaseFamily NAME_family()`, and its name here.
#define BOXWOOD_FAMILIES(X)                                                                        \
    X(generic_triangles)                                                                           \
    X(separated_triangles)                                                                         \
    X(coplanar_overlapping)                                                                        \
    X(coplanar_touching)                                                                           \
    X(coplanar_disjoint)                                                                           \
    X(parallel_planes)                                                                             \
    X(translated_copies)                                                                           \
    X(shared_vertex)                                                                               \
    X(shared_edge)                                                                                 \
    X(identical_triangles)                                                                         \
    X(near_coplanar)                                                                               \
    X(near_parallel_edges)                                                                         \
    X(vertex_on_face)                                                                              \
    X(edge_on_edge)                                                                                \
    X(within_one_ulp)                                                                              \
    X(slivers)                                                                                     \
    X(needle_triangles)                                                                            \
    X(cap_triangles)                                                                               \
    X(near_coplanar_needles)                                                                       \
    X(tiny_gaps)                                                                                   \
    X(zero_area_triangles)                                                                         \
    X(points_and_duplicates)                                                                       \
    X(tiny_triangles)                                                                              \
    X(mixed_scale)                                                                                 \
    X(mixed_octaves)                                                                               \
    X(coplanar_mixed_octaves)                                                                      \
    X(decimal_scale)                                                                               \
    X(far_from_origin)                                                                             \
    X(generic_rays)                                                                                \
    X(ray_through_edge)                                                                            \
    X(ray_through_vertex)                                                                          \
    X(ray_in_mesh)                                                                                 \
    X(ray_in_stretched_mesh)                                                                       \
    X(ray_in_far_mesh)                                                                             \
    X(ray_through_mesh)                                                                            \
    X(ray_in_plane)                                                                                \
    X(ray_grazing)                                                                                 \
    X(ray_at_small_triangle)                                                                       \
    X(ray_limits)                                                                                  \
    X(ray_at_exact_limits)                                                                         \
    X(generic_ray_boxes)                                                                           \
    X(signed_zero_directions)                                                                      \
    X(slab_corner_ties)                                                                            \
    X(ray_box_limits)                                                                              \
    X(flat_boxes)                                                                                  \
    X(identical_boxes)                                                                             \
    X(nested_boxes)                                                                                \
    X(touching_grid)                                                                               \
    X(generic_obbs)                                                                                \
    X(kissing_obbs)                                                                                \
    X(touching_obbs)                                                                               \
    X(thin_obbs)                                                                                   \
    X(rotated_boxes)                                                                               \
    X(sphere_and_sphere)                                                                           \
    X(sphere_and_box)                                                                              \
    X(sphere_and_capsule)                                                                          \
    X(sphere_and_cylinder)                                                                         \
    X(sphere_and_cone)                                                                             \
    X(sphere_and_ellipsoid)                                                                        \
    X(sphere_and_hull)                                                                             \
    X(box_and_box)                                                                                 \
    X(box_and_capsule)                                                                             \
    X(box_and_cylinder)                                                                            \
    X(box_and_cone)                                                                                \
    X(box_and_ellipsoid)                                                                           \
    X(box_and_hull)                                                                                \
    X(capsule_and_capsule)                                                                         \
    X(capsule_and_cylinder)                                                                        \
    X(capsule_and_cone)                                                                            \
    X(capsule_and_ellipsoid)                                                                       \
    X(capsule_and_hull)                                                                            \
    X(cylinder_and_cylinder)                                                                       \
    X(cylinder_and_cone)                                                                           \
    X(cylinder_and_ellipsoid)                                                                      \
    X(cylinder_and_hull)                                                                           \
    X(cone_and_cone)                                                                               \
    X(cone_and_ellipsoid)                                                                          \
    X(cone_and_hull)                                                                               \
    X(ellipsoid_and_ellipsoid)                                                                     \
    X(ellipsoid_and_hull)                                                                          \
    X(hull_and_hull)                                                                               \
    X(nearly_touching_shapes)                                                                      \
    X(thin_shapes)                                                                                 \
    X(deep_shapes)                                                                                 \
    X(ball_in_ellipsoid)                                                                           \
    X(generic_vertex_face)                                                                         \
    X(generic_edge_edge)                                                                           \
    X(just_missed_vertex_face)                                                                     \
    X(just_missed_edge_edge)                                                                       \
    X(small_integers_vertex_face)                                                                  \
    X(small_integers_edge_edge)                                                                    \
    X(touch_at_ends_vertex_face)                                                                   \
    X(touch_at_ends_edge_edge)                                                                     \
    X(tangential_vertex_face)                                                                      \
    X(tangential_edge_edge)                                                                        \
    X(still_vertex_face)                                                                           \
    X(still_edge_edge)                                                                             \
    X(coplanar_vertex_face)                                                                        \
    X(coplanar_edge_edge)                                                                          \
    X(ccd_queries_vertex_face)                                                                     \
    X(ccd_queries_edge_edge)

namespace boxwood {

#define BOXWOOD_DECLARE(name) HardCaseFamily name##_family();
BOXWOOD_FAMILIES(BOXWOOD_DECLARE)
#undef BOXWOOD_DECLARE

std::string_view to_string(Panel panel) {
    return panel == Panel::generic    ? "generic"
           : panel == Panel::touching ? "touching"
                                      : "degenerate";
}

std::size_t n_cases(const Cases& cases) {
    return std::visit(
        []<class C>(const C& c) -> std::size_t {
            if constexpr (std::is_same_v<C, std::monostate>)
                return 0;
            else if constexpr (std::is_same_v<C, RayCases>)
                return c.rays.size();
            else if constexpr (std::is_same_v<C, MotionCases>)
                return c.motions.size();
            else if constexpr (std::is_same_v<C, BoxCases>)
                return c.boxes.size();
            else
                return c.size();
        },
        cases);
}

std::span<const HardCaseFamily> hard_case_families() {
#define BOXWOOD_ROW(name) name##_family(),
    static const std::vector<HardCaseFamily> families{BOXWOOD_FAMILIES(BOXWOOD_ROW)};
#undef BOXWOOD_ROW
    return families;
}

const HardCaseFamily* find_hard_case_family(std::string_view name) {
    const auto found = std::ranges::find(hard_case_families(), name, &HardCaseFamily::name);
    return found == hard_case_families().end() ? nullptr : &*found;
}

void check_hard_case_spec(const HardCaseFamily& family, const HardCaseSpec& spec) {
    const auto refuse = [&]<class... Part>(fmt::format_string<Part...> text, Part&&... parts) {
        throw std::invalid_argument(fmt::format("family {}: {}", family.name,
                                                fmt::format(text, std::forward<Part>(parts)...)));
    };
    if (spec.k && family.k_meaning.empty())
        refuse("it has no parameter k, but k = {} is given", *spec.k);
    const int k = spec.k.value_or(family.k_default);
    if (k < family.k_min || k > family.k_max)
        refuse("k = {} is not within {} .. {} (k: {})", k, family.k_min, family.k_max,
               family.k_meaning);
    if (spec.scale < family.scale_min || spec.scale > family.scale_max)
        refuse("scale = {} is not within {} .. {}, where multiplying every coordinate by 2^scale "
               "is exact",
               spec.scale, family.scale_min, family.scale_max);
    if (family.reads_file) {
        if (spec.file.empty())
            refuse("no file is given; name a query file, or a folder of them");
    } else {
        if (!spec.file.empty())
            refuse("it reads no file, but {} is given", spec.file.string());
        if (spec.n == 0)
            refuse("n is 0, but there must be at least one case");
    }
}

Cases make_cases(const HardCaseFamily& family, const HardCaseSpec& spec) {
    check_hard_case_spec(family, spec);
    HardCaseSpec full = spec;
    full.k = spec.k.value_or(family.k_default);
    return family.generate(full, Random(spec.seed, family.name));
}

} // namespace boxwood
