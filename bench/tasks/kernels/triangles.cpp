#include "bench/tasks/kernels/kernel.h"
#include "kernels/registry.h"
#include "kernels/oracle/registry.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

template <class K> Rung scalar_rung() {
    using Real = typename K::Real;
    struct Input {
        Triangle<Real> a, b;
    };
    return {K::info, precision_of<Real>(), called_one_by_one, [](const Cases& cases) {
                std::vector<Input> inputs;
                for (const auto& c : std::get<std::vector<TrianglePairCase>>(cases))
                    inputs.push_back({converted<Real>(c.a), converted<Real>(c.b)});
                return one_by_one<&Answers::verdicts>(
                    std::move(inputs), [](const Input& in) { return K::intersect(in.a, in.b); });
            }};
}

template <class K> Rung batch_rung() {
    using Real = typename K::Real;
    return {K::info, precision_of<Real>(), called_in_blocks, [](const Cases& cases) {
                const auto& pairs = std::get<std::vector<TrianglePairCase>>(cases);
                return in_blocks<&Answers::verdicts>(
                    pair_blocks<Real>(pairs), pairs.size(),
                    [](auto blocks, auto verdicts) { K::intersect(blocks, verdicts); });
            }};
}

} // namespace

std::vector<Rung> triangle_rungs() {
    std::vector<Rung> all;
    for_each_kernel<Concatenated<TriangleKernels, oracle::RationalTriangleKernels>>(
        [&]<class K>(std::type_identity<K>) {
            if constexpr (TriangleBatchKernel<K>)
                all.push_back(batch_rung<K>());
            else
                all.push_back(scalar_rung<K>());
        });
    return all;
}

} // namespace boxwood::bench
