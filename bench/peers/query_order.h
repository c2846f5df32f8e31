#pragma once

#include "bench/peers/point_peers.h"
#include "bench/tasks/detail/point_classes.h"
#include "trees/ordering/curve_order.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {

/// In which order a peer that takes one query after another is asked many.
enum class Asked : std::uint8_t {
    as_given,
    along_a_curve ///< which is sorted within the query, as ours does with batches of points
};

/// The queries of a scene in such an order. One that follows its neighbour visits much the same
/// nodes, which is what a batch can gain over single queries.
class QueryOrder {
  public:
    QueryOrder(const Job& job, PointQuery query, Asked asked)
        : executor_(make_executor(job.executor, job.threads)), asked_(asked),
          boxes_(query_boxes(*job.scene, query)) {}

    /// Timed, at the beginning of each query of the contender.
    void find() {
        if (asked_ == Asked::along_a_curve)
            order_ = coarse_curve_order(boxes_, Curve::hilbert, *executor_);
    }
    std::size_t size() const { return boxes_.size(); }
    /// The number of the query in the i-th place.
    std::uint32_t operator[](std::size_t i) const {
        return asked_ == Asked::along_a_curve ? order_[i] : static_cast<std::uint32_t>(i);
    }

  private:
    std::unique_ptr<Executor> executor_;
    Asked asked_;
    std::vector<Aabb<float>> boxes_;
    Buffer<std::uint32_t> order_;
};

inline std::vector<std::string> classes_of(Asked asked) {
    return asked == Asked::as_given ? point_class::of_single_calls()
                                    : std::vector{point_class::batches};
}
/// What a contender's name ends in, and its notes say.
inline const char* name_of(Asked asked) { return asked == Asked::as_given ? "" : ".sorted"; }
inline const char* words_for(Asked asked) {
    return asked == Asked::as_given
               ? "one after another in the order that is given"
               : "one after another along a Hilbert curve, sorted by us within the query";
}

} // namespace boxwood::bench
