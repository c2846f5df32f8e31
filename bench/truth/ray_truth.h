#pragma once

#include "kernels/primitives/ray.h"
#include "kernels/primitives/triangle.h"

#include <span>
#include <vector>

namespace boxwood::bench {

/// What a ray may rightly be answered, found by testing it in double against every triangle.
/// A kernel that rounds to float cannot tell the sides of a line within its rounding error, so a
/// triangle is hit for certain, missed for certain, or ambiguous; an ambiguous one may be answered
/// but need not be.
struct RayTruth {
    struct Candidate {
        std::uint32_t triangle;
        bool certain;
        double t_low, t_high; ///< where a hit of this triangle may be reported
        double t;             ///< the hit in double; NaN if ambiguous
    };
    /// All that may be answered: nothing behind `t_limit`.
    std::vector<Candidate> candidates;
    /// A nearest hit must not be reported behind this; infinite when a miss is allowed.
    double t_limit = std::numeric_limits<double>::infinity();

    bool must_hit() const { return t_limit < std::numeric_limits<double>::infinity(); }
};

/// The oracle of rays. The mesh must outlive it.
class RayOracle {
  public:
    explicit RayOracle(const TriangleMesh& mesh);

    /// A ray that only ambiguous triangles meet, through an edge or corner that several share, must
    /// hit too if every ray around it, a few rounding errors away, hits one of them:
    /// watertightness.
    RayTruth truth(const Ray<float>& ray) const;

    /// All that the ray meets, for certain or perhaps, by triangle: an answer to rays_all has every
    /// certain triangle and may have the others.
    std::vector<RayTruth::Candidate> all(const Ray<float>& ray) const;

  private:
    /// Calls f(Test, triangle) for all triangles that the ray's line may come near.
    template <class F> void for_nearby(const Ray<float>& ray, const F& f) const;

    struct Ball {
        Vec3<double> corner;
        double size; ///< longest edge
    };
    const TriangleMesh& mesh_;
    std::vector<Ball> balls_; ///< one per triangle, holding it
};

} // namespace boxwood::bench
