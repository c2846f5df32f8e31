#pragma once

#include "kernels/arithmetic/float_mode.h"
#include "kernels/boxes/box_fit_kernel.h"

#include <cmath>
#include <limits>
#include <type_traits>

namespace boxwood {

/// A box as a centre c, rounded anyhow, and half sizes e measured from it, so that it lies in
/// c -+ e up to the rounding of e.
template <class Real> struct CentredBox {
    Vec3<Real> centre, half;

    BOXWOOD_BOTH explicit CentredBox(const Aabb<Real>& box) {
        for (int i = 0; i < 3; ++i) {
            const Real c = box.min[i] * Real(0.5) + box.max[i] * Real(0.5);
            centre[i] = c;
            const Real above = box.max[i] - c, below = c - box.min[i];
            half[i] = above < below ? below : above;
        }
    }
};

template <class Real> BOXWOOD_BOTH constexpr Vec3<Real> magnitudes(Vec3<Real> v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// In plain arithmetic: rounding may leave points of the image outside.
template <class Number> struct PlainFit {
    using Real = Number;
    static constexpr KernelInfo info{"box_fit",
                                     std::is_same_v<Real, float> ? "plain_f32" : "plain_f64",
                                     "centre Rc + t, half sizes |R|e, as they round",
                                     Promise::none,
                                     "none: short by up to 6u (|R|(|c|+e) + |t|)",
                                     "about 40 flops"};
    static constexpr std::string_view name = info.name;

    static Aabb<Real> fit(const RigidTransform<Real>& transform, const Aabb<Real>& box) {
        if (box.is_empty())
            return {};
        const CentredBox<Real> in(box);
        Aabb<Real> out;
        for (int i = 0; i < 3; ++i) {
            const Vec3<Real> row = transform.rotation[static_cast<std::size_t>(i)];
            const Real centre = dot(row, in.centre) + transform.translation[i];
            const Real half = dot(magnitudes(row), in.half);
            out.min[i] = centre - half;
            out.max[i] = centre + half;
        }
        return out;
    }
};

/// Contains the image of the box under the exact matrix, for any finite input: where numbers
/// overflow the side is infinite, and where denormals are flushed they are kept here all the same.
/// NaN or infinity in: infinite sides, or a larger box.
///
/// Bound, u the unit roundoff, per row with A = |r|.(|c|+e) + |t|: centre passes 4 roundings, half
/// 3 and the one of e, each at most u of its part of A; half + pad and the last sum round once
/// more: 6uA in all. The pad of 8uA, whose own factors round up to 6 times, leaves 2uA for terms in
/// u^2. Underflow: 6 products, half a denormal_min each, and that of the pad: 4 denormal_min.
/// Overflow: as rounding is monotone, A < inf means that centre and half are finite.
template <class Number> struct PaddedFit {
    using Real = Number;
    static constexpr KernelInfo info{"box_fit",
                                     std::is_same_v<Real, float> ? "padded_f32" : "padded_f64",
                                     "centre Rc + t, half sizes |R|e, padded by their rounding",
                                     Promise::never_miss,
                                     "8u (|R|(|c|+e) + |t|) a side; derived in boxes/fit.h",
                                     "about 70 flops"};
    static constexpr std::string_view name = info.name;

    static Aabb<Real> fit(const RigidTransform<Real>& transform, const Aabb<Real>& box) {
        return without_flushing([&] {
            return box.is_empty() ? Aabb<Real>{} : fit_kept(transform, CentredBox<Real>(box));
        });
    }

    /// The same of a box that is not empty, in a thread that keeps denormals.
    static Aabb<Real> fit_kept(const RigidTransform<Real>& transform, const CentredBox<Real>& in) {
        using Limits = std::numeric_limits<Real>;
        constexpr Real eight_u = 4 * Limits::epsilon();
        Aabb<Real> out;
        for (int i = 0; i < 3; ++i) {
            const Vec3<Real> row = transform.rotation[static_cast<std::size_t>(i)];
            const Vec3<Real> size = magnitudes(row);
            const Real centre = dot(row, in.centre) + transform.translation[i];
            const Real half = dot(size, in.half);
            const Real all =
                dot(size, magnitudes(in.centre)) + std::abs(transform.translation[i]) + half;
            const Real reach = half + (eight_u * all + 4 * Limits::denorm_min());
            const bool known = all <= Limits::max();
            out.min[i] = known ? centre - reach : -Limits::infinity();
            out.max[i] = known ? centre + reach : Limits::infinity();
        }
        return out;
    }
};

/// The padded fit: see PaddedFit.
template <class Real> Aabb<Real> fit(const RigidTransform<Real>& transform, const Aabb<Real>& box) {
    return PaddedFit<Real>::fit(transform, box);
}

} // namespace boxwood
