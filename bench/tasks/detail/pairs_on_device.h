#pragma once

#include "bench/tasks/contender.h"
#include "kernels/triangle_distance/distance_kernel.h"
#include "kernels/triangle_triangle/float_pair.h"
#include "trees/device_triangles.h"

#include <optional>
#include <string_view>

namespace boxwood::bench {

/// The level of a device that answers as this kernel of two triangles of floats does; nothing if
/// none does.
std::optional<DeviceAccuracy> device_accuracy(std::string_view kernel);

/// Kernels on the cases of a job on a device: a case per thread. Null without a level.
Answering::Make touching_on_device(std::string_view kernel);
Answering::Make distances_on_device(std::string_view kernel);

/// What a thread of a device does for a pair before integers must decide.
struct CertifiedF32 {
    using Real = float;
    static constexpr std::string_view name = "certified_f32";
    static constexpr KernelInfo info{
        "triangle_triangle",
        name,
        "one pair in floats, then in doubles: interval overlap on the common line (2003), else "
        "maybe",
        Promise::certified,
        "270u * (product of the largest |differences| per axis), derived in "
        "triangle_triangle/guigue_devillers_batch.cpp",
        "about 230 flops, twice for one in some thousands"};
    static Decision intersect(const Triangle<float>& a, const Triangle<float>& b) {
        return {float_pair::certified(a, b), 0};
    }
};

/// Bounds in doubles, or, where they are wide, in integers.
struct CertifiedDistanceF32 {
    using Real = float;
    static constexpr std::string_view name = "certified_f32";
    static constexpr KernelInfo info{
        .family = "triangle_distance",
        .name = name,
        .summary = "floats, in doubles: features by nearest pair, bounded; where that is wide, "
                   "integers",
        .promise = Promise::certified,
        .bound = "kernels/triangle_distance/detail/gap_bounds.h; integers round once",
        .cost = "about 1,000 flops; integers where the two touch or nearly",
        .relative_width = 0x1p-32,
        .has_witnesses = false};
    static Distance distance(const Triangle<float>& a, const Triangle<float>& b);
};

} // namespace boxwood::bench
