#include "bench/tasks/kernels/kernel.h"
#include "kernels/oracle/rational.h"
#include "kernels/registry.h"

namespace boxwood::bench {
namespace {

/// Settings have their defaults.
template <class K> Rung rung(bool is_vertex_face) {
    return {is_vertex_face ? K::vertex_face_info : K::edge_edge_info,
            precision_of<typename RealOf<K, double>::type>(), called_one_by_one,
            [is_vertex_face](const Cases& cases) -> std::unique_ptr<Contender> {
                std::vector<LinearMotion> motions;
                for (const MotionCase& c : std::get<MotionCases>(cases).motions)
                    motions.push_back(c.motion);
                if (is_vertex_face)
                    return one_by_one<&Answers::impacts>(
                        std::move(motions),
                        [kernel = K{}](const LinearMotion& m) { return kernel.vertex_face(m); });
                return one_by_one<&Answers::impacts>(
                    std::move(motions),
                    [kernel = K{}](const LinearMotion& m) { return kernel.edge_edge(m); });
            }};
}

} // namespace

std::vector<Rung> continuous_rungs(Ask ask) {
    using All = Concatenated<ContinuousKernels, std::tuple<oracle::ExactContinuous>>;
    std::vector<Rung> all;
    for_each_kernel<All>(
        [&]<class K>(std::type_identity<K>) { all.push_back(rung<K>(ask == Ask::vertex_face)); });
    return all;
}

} // namespace boxwood::bench
