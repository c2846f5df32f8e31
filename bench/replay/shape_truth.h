#pragma once

#include "bench/replay/replay.h"
#include "bench/truth/link_solid.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace boxwood::bench {

/// What the queries of a recorded program find by its shapes: of all objects whose boxes overlap,
/// or are no farther apart than the nearest ones, and rational arithmetic on their triangles, as
/// doubles place them. No tree of ours and no library's kernel is in it. What is round lies between
/// two polyhedra (truth/link_solid.h): what may be either way is right either way, and so is what
/// touches, or does not, by no more than rounding may move it.
class ShapeTruth {
  public:
    /// Queries are checked in their order, as long as there are tests left: one for each pair of
    /// triangles of two objects whose boxes overlap. Not known are those with another manager,
    /// where an object moved and was not reported, is nowhere, has no triangles or a shape that
    /// link_solid does not know. `goes_on` is called again and again.
    ShapeTruth(const RecordedProgram& program, double max_tests,
               const std::function<bool()>& goes_on);

    std::size_t n_checked() const { return n_checked_; }
    std::size_t n_too_dear() const { return n_too_dear_; } ///< for the tests that were left
    bool is_checked(std::size_t call) const { return queries_[call].is_checked; }
    /// What is wrong with an answer, in words; empty: nothing, or it is not checked. Distances may
    /// be off by 1e-6 of them and by what rounding may move.
    std::string fault(std::size_t call, const ReplayedCall& found, bool in_floats) const;

  private:
    struct Query {
        bool is_checked = false;
        std::vector<Pair> touching, maybe; ///< of objects, ascending; maybe: those as well
        double lo = 0, hi = 0;             ///< of a distance
        double off = 0, off_in_floats = 0; ///< what rounding may move two of its objects by
    };
    /// What a geometry is, for a judge.
    struct Known {
        LinkSolid solid;
        bool is_exact = false; ///< floats hold it: inner and outer are one
        double reach = 0;      ///< of its corners from its origin
    };
    /// What can be said of two: rounded meshes touch surely if they do both ways.
    struct Touch {
        bool surely = false, maybe = false;
    };
    class Builder;

    static Touch touch_of(const PlacedSolid& a, const PlacedSolid& b, bool are_exact);

    const Known& known(std::uint32_t object) const { return *known_[program_.geometry_of[object]]; }
    /// Of two objects so placed: 2^-40 of the coordinates, 2^-20 in floats; what a matrix lacks to
    /// be a rotation; of solids 1e-6, where libccd ends; of meshes that floats do not hold 2^-22.
    double rounding(Pair pair, const RigidTransform<double>& a, const RigidTransform<double>& b,
                    bool in_floats) const;
    bool may_be_either(std::size_t call, Pair pair, bool touches, bool in_floats) const;

    const RecordedProgram& program_;
    std::vector<std::optional<Known>> known_; ///< by geometry
    std::vector<Query> queries_;              ///< by call
    std::size_t n_checked_ = 0, n_too_dear_ = 0;
};

} // namespace boxwood::bench
