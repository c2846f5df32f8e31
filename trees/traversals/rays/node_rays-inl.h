// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_NODE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_NODE_RAYS_INL_H
#undef BOXWOOD_NODE_RAYS_INL_H
#else
#define BOXWOOD_NODE_RAYS_INL_H
#endif

#include "trees/traversals/rays/ray_packet-inl.h"
#include "trees/traversals/rays/ray_wave-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

template <class Node> void traverse_job(const RayJob& job) {
    const SlabBounds bounds(job.triangles.bounds);
    with_job_types(job, [&]<class K, RayMode mode, bool Counted>(
                            std::type_identity<K>, std::integral_constant<RayMode, mode>,
                            std::bool_constant<Counted>) HWY_ATTR {
        PacketSet answered;
        if constexpr (mode != RayMode::all && !Counted && takes_packets<Node>)
            answered = trace_packets<Node, K, mode>(job, bounds);
        RayWave<Node, K, mode, Counted>(job, bounds, answered).run();
    });
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
