#include "bench/tasks/kernels/kernel.h"
#include "kernels/registry.h"
#include "kernels/oracle/registry.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

/// The two things of a case whose distance is asked for, in the kernel's numbers.
template <class Real> struct TrianglePair {
    Triangle<Real> a, b;
    explicit TrianglePair(const TrianglePairCase& c)
        : a(converted<Real>(c.a)), b(converted<Real>(c.b)) {}
};
template <class Real> struct SegmentPair {
    Segment<Real> a, b;
    explicit SegmentPair(const TrianglePairCase& c)
        : a{static_cast<Vec3<Real>>(c.a.a), static_cast<Vec3<Real>>(c.a.b)},
          b{static_cast<Vec3<Real>>(c.b.b), static_cast<Vec3<Real>>(c.b.a)} {}
};
template <class Real> struct PointAndTriangle {
    Vec3<Real> a;
    Triangle<Real> b;
    explicit PointAndTriangle(const TrianglePairCase& c)
        : a(static_cast<Vec3<Real>>(c.a.a)), b(converted<Real>(c.b)) {}
};
template <class Real> struct PointAndSegment {
    Vec3<Real> a;
    Segment<Real> b;
    explicit PointAndSegment(const TrianglePairCase& c)
        : a(static_cast<Vec3<Real>>(c.a.a)), b{static_cast<Vec3<Real>>(c.b.b),
                                               static_cast<Vec3<Real>>(c.b.a)} {}
};

template <class K, template <class> class Input> Rung scalar_rung() {
    using Read = Input<typename K::Real>;
    return {K::info, precision_of<typename K::Real>(), called_one_by_one, [](const Cases& cases) {
                std::vector<Read> inputs;
                for (const auto& c : std::get<std::vector<TrianglePairCase>>(cases))
                    inputs.emplace_back(c);
                return one_by_one<&Answers::distances>(
                    std::move(inputs), [](const Read& in) { return K::distance(in.a, in.b); });
            }};
}

template <class K> Rung batch_rung() {
    using Real = typename K::Real;
    return {K::info, precision_of<Real>(), called_in_blocks, [](const Cases& cases) {
                const auto& pairs = std::get<std::vector<TrianglePairCase>>(cases);
                return in_blocks<&Answers::distances>(
                    pair_blocks<Real>(pairs), pairs.size(),
                    [](auto blocks, auto distances) { K::distance(blocks, distances); });
            }};
}

template <template <class> class Input, class... Tuples> std::vector<Rung> rungs_of() {
    std::vector<Rung> all;
    for_each_kernel<Concatenated<Tuples...>>([&]<class K>(std::type_identity<K>) {
        if constexpr (TriangleDistanceBatchKernel<K>)
            all.push_back(batch_rung<K>());
        else
            all.push_back(scalar_rung<K, Input>());
    });
    return all;
}

} // namespace

std::vector<Rung> distance_rungs(Ask ask) {
    switch (ask) {
    case Ask::segment_segment:
        return rungs_of<SegmentPair, SegmentDistanceKernels,
                        oracle::RationalSegmentDistanceKernels>();
    case Ask::point_triangle:
        return rungs_of<PointAndTriangle, PointTriangleKernels,
                        oracle::RationalPointTriangleKernels>();
    case Ask::point_segment:
        return rungs_of<PointAndSegment, PointSegmentKernels,
                        oracle::RationalPointSegmentKernels>();
    default:
        return rungs_of<TrianglePair, DistanceKernels, oracle::RationalTriangleDistanceKernels>();
    }
}

} // namespace boxwood::bench
