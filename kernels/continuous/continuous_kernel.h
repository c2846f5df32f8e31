#pragma once

#include "kernels/decision.h"
#include "kernels/primitives/vec3.h"

#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>

namespace boxwood {

/// Four points, each moving along a straight line at constant speed from `start` (t = 0) to `end`
/// (t = 1). vertex-face: the vertex, then the corners of the face. edge-edge: the ends of the first
/// edge, then those of the second.
struct LinearMotion {
    std::array<Vec3<double>, 4> start, end;

    constexpr bool operator==(const LinearMotion&) const = default;
};

/// Whether and when two moving features first touch, 0 <= t <= 1, the ends included.
/// t_free: no touch at any t < t_free (1 if they never touch).
/// t_hit:  a touch at some t <= t_hit (+inf if they never touch; a never-miss kernel's upper end).
/// The first touch of a `yes` lies in [t_free, t_hit].
struct Impact {
    Answer answer = Answer::no;
    double t_free = 1, t_hit = std::numeric_limits<double>::infinity();
    std::uint8_t tier = 0;
};

/// Settings are K's own documented data members; a default-made K has the defaults.
template <class K>
concept ContinuousKernel = std::default_initializable<K> &&
    requires(const K kernel, const LinearMotion& motion) {
    { K::name } -> std::convertible_to<std::string_view>;
    { K::vertex_face_info } -> std::convertible_to<KernelInfo>;
    { K::edge_edge_info } -> std::convertible_to<KernelInfo>;
    typename std::integral_constant<Promise, K::vertex_face_info.promise>;
    typename std::integral_constant<Promise, K::edge_edge_info.promise>;
    { kernel.vertex_face(motion) } -> std::same_as<Impact>;
    { kernel.edge_edge(motion) } -> std::same_as<Impact>;
};

} // namespace boxwood
