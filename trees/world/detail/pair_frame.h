#pragma once

#include "kernels/boxes/sat.h"
#include "trees/world/detail/obb_block.h"
#include "trees/world/mesh_tree.h"
#include "trees/world/pose.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boxwood::detail {

/// A box as another tree's lanes meet it: floats, seen from a point of A's frame.
struct SeenBox {
    float centre[3], axis[3][3], half[3];
};

/// B as seen from A, and how far what is computed in floats may be off.
///
/// Boxes are seen from the centre of one of A's blocks. With u = 2^-24, S = |t|_1 + reach_a +
/// reach_b, t from that centre to the one of B's block: the rotation's entries, a moved centre and
/// a moved axis (3 products, 2 sums) are off by less than 8u of |t|_1 + reach, or of 1; a
/// difference of centres along an axis (1 + 3 roundings) by less than 14u S in all, and so is a
/// centre rounded to float; a reach sum |n . axis| half (9 products of an 8u-wrong cosine) by less
/// than 14u S, and what it lacks as axes are not orthonormal (PosedBox::slack: 2 * 3.5u half) by
/// 7u S. Together below 40u S; 128u = 2^-17 leaves room for squares, roots and sums of gaps, and
/// 2^-70 for squares that underflow.
/// `moved`: corners of B that are moved in doubles are off by 2^-50 of what they are made of.
/// `turned`: what boxes that are turned are off by besides; at least as much. Where no entry of |R
/// R^T - I| is beyond d, B's boxes reach beyond what orthonormal axes say by less than 3d of their
/// halves, and lengths along them are off by 1.5d: below 5d S in all. Up to d = 2^-49, which a
/// product of rotations keeps to, the bounds in doubles have room for it. `corners`: heights of
/// both sides' corners along a direction in floats, 8u of |corner|_1.
struct PairFrame {
    PairFrame(const MeshTree& a, const MeshTree& b, const Pose& b_in_a) : pose(b_in_a) {
        const auto& [r0, r1, r2] = pose.rotation;
        const auto is_usable = [](const Vec3<double>& v) {
            return std::abs(v.x) <= 0x1p62 && std::abs(v.y) <= 0x1p62 && std::abs(v.z) <= 0x1p62;
        };
        if (!is_usable(r0) || !is_usable(r1) || !is_usable(r2) || !is_usable(pose.translation))
            throw std::invalid_argument("a pose has a number that is not finite or beyond 2^62");
        const double skew = distance_from_orthonormal(pose.rotation);
        if (skew > 0x1p-12)
            throw std::invalid_argument(
                "a pose's matrix is off orthonormal by more than 2^-12 (see "
                "checked_pose)");
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3<double>& row = pose.rotation[i];
            rotation[i][0] = static_cast<float>(row.x);
            rotation[i][1] = static_cast<float>(row.y);
            rotation[i][2] = static_cast<float>(row.z);
        }
        const double reach = a.bounding_sphere().reach + b.bounding_sphere().reach;
        const Vec3<double>& t = pose.translation;
        const double size = reach + std::abs(t.x) + std::abs(t.y) + std::abs(t.z);
        moved = 0x1p-48 * size;
        turned = moved + (skew > 0x1p-49 ? 16 * skew * size : 0);
        corners = 0x1p-21 * reach + moved + 0x1p-60;
    }

    /// From the centre of a box of A to that of a box of B, in A's frame.
    Vec3<double> between(const double (&a)[3], const double (&b)[3]) const {
        return pose(Vec3<double>{b[0], b[1], b[2]}) - Vec3<double>{a[0], a[1], a[2]};
    }
    /// What any bound of lanes of the two boxes may be off by.
    float error(const Vec3<double>& t, const PosedBox& a, const PosedBox& b) const {
        const double size =
            std::abs(t.x) + std::abs(t.y) + std::abs(t.z) + double{a.reach} + double{b.reach};
        return static_cast<float>((0x1p-17 * size + turned) * (1 + 0x1p-20) + 0x1p-70);
    }
    /// A box of B as seen from where t starts.
    SeenBox seen_b(const PosedBox& b, const Vec3<double>& t) const {
        SeenBox seen;
        for (int i = 0; i < 3; ++i) {
            seen.centre[i] = static_cast<float>(t[i]);
            seen.half[i] = b.half[i];
            for (int k = 0; k < 3; ++k)
                seen.axis[k][i] = rotation[i][0] * b.axis[k][0] + rotation[i][1] * b.axis[k][1] +
                                  rotation[i][2] * b.axis[k][2];
        }
        return seen;
    }
    /// Whether a plane parts two boxes by more than `reach`, along one of their six axes or across
    /// one of each. In doubles: error() is then for axes that are not quite orthonormal, each by
    /// less than 2u, which takes less than 14u S from a gap, whatever the length of its direction,
    /// at most 1.
    bool parted(const PosedBox& a, const PosedBox& b, double reach = 0) const {
        const auto vec = [](const float(&v)[3]) {
            return Vec3<double>{double{v[0]}, double{v[1]}, double{v[2]}};
        };
        const Vec3<double> t = between(a.centre, b.centre);
        const ObbPair<double> pair(
            {{}, {vec(a.axis[0]), vec(a.axis[1]), vec(a.axis[2])}, vec(a.half)},
            {t,
             {pose.rotated(vec(b.axis[0])), pose.rotated(vec(b.axis[1])),
              pose.rotated(vec(b.axis[2]))},
             vec(b.half)});
        const double most = (double{error(t, a, b)} + reach) * (1 + 0x1p-50);
        for (int i = 0; i < 3; ++i)
            if (pair.face_of_a(i) > most || pair.face_of_b(i) > most)
                return true;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (pair.edges(i, j) > most)
                    return true;
        return false;
    }
    /// A box of A as seen from its own centre.
    static SeenBox seen_a(const PosedBox& a) {
        SeenBox seen{};
        for (int i = 0; i < 3; ++i) {
            seen.half[i] = a.half[i];
            for (int k = 0; k < 3; ++k)
                seen.axis[k][i] = a.axis[k][i];
        }
        return seen;
    }

    Pose pose;
    float rotation[3][3];
    double moved, turned, corners;
};

} // namespace boxwood::detail
