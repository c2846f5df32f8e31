#pragma once

#include "bench/replay/replay.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What the queries of a recorded program find by its shapes: of all objects whose boxes overlap,
/// or are no farther apart than the nearest ones, and rational arithmetic on their triangles. No
/// tree of ours and no library's kernel is in it. What is round lies between two polyhedra
/// (truth/link_solid.h): what may be either way is right either way.
class ShapeTruth {
  public:
    /// Queries are checked in their order, until so many pairs of triangles were to be looked at;
    /// not those with another manager, of objects that moved and were not reported, and where an
    /// object has a shape that link_solid does not know. `goes_on` is called before each query.
    ShapeTruth(const RecordedProgram& program, double max_tests,
               const std::function<bool()>& goes_on);

    std::size_t n_checked() const { return n_checked_; }
    bool is_checked(std::size_t call) const { return queries_[call].is_checked; }
    /// What is wrong with an answer, in words; empty: nothing, or it is not checked. Distances may
    /// be off by 1e-6 of them, and by 1e-9 of the coordinates' size, 1e-6 where not all shapes are
    /// meshes (where libccd ends), 2^-20 in floats.
    std::string fault(std::size_t call, const ReplayedCall& found, bool in_floats) const;

  private:
    struct Query {
        bool is_checked = false;
        std::vector<Pair> touching, maybe; ///< of objects, ascending; maybe: those as well
        double lo = 0, hi = 0;             ///< of a distance
    };
    class Builder;

    const RecordedProgram& program_;
    std::vector<Query> queries_; ///< by call
    std::size_t n_checked_ = 0;
    double size_ = 0; ///< the greatest |coordinate|
    bool is_of_meshes_ = true;
};

} // namespace boxwood::bench
