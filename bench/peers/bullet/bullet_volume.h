#pragma once

#include "bench/tasks/contender.h"
#include "kernels/primitives/aabb.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <cstdint>
#include <vector>

namespace boxwood::bench {

/// Bullet's btDbvtBroadphase, for moving_pairs; made in peers/bullet/bullet_broadphase.cpp.
std::vector<ContenderEntry> bullet_broadphases();

inline btVector3 vector_of(Vec3<float> v) { return {v.x, v.y, v.z}; }

inline btDbvtVolume volume_of(const Aabb<float>& box) {
    return btDbvtVolume::FromMM(vector_of(box.min), vector_of(box.max));
}

/// What a leaf was inserted with.
inline std::uint32_t item_of(const btDbvtNode* leaf) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(leaf->data));
}

/// Of the boxes that are not empty; 0 without any.
inline float mean_side(const std::vector<Aabb<float>>& boxes) {
    double sides = 0, present = 0;
    for (const Aabb<float>& box : boxes) {
        if (box.is_empty())
            continue;
        const Vec3<float> side = box.max - box.min;
        sides += static_cast<double>(side.x + side.y + side.z);
        ++present;
    }
    return present > 0 ? static_cast<float>(sides / (3 * present)) : 0;
}

} // namespace boxwood::bench
