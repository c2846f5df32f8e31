#pragma once

#include "kernels/catalogue.h"
#include "kernels/ray_box/slabs.h"
#include "trees/layout.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

namespace boxwood {

/// One ray on its way through a tree: the nearest hit so far, and the tests of leaf triangles.
template <RayKernel K, bool Counted> class RayWalk {
  public:
    /// bounds: those of the whole tree.
    RayWalk(const Ray<float>& ray, const Aabb<float>& bounds, Work* work)
        : slabs(ray, ray_margin(ray, bounds)), per_ray(K::prepare(ray)), ray_(ray), work_(work) {
        best_.t = ray.t_max;
    }

    const RaySlabs slabs;
    const typename K::PerRay per_ray;

    float t_min() const { return ray_.t_min; }
    /// Nothing beyond this t matters any more.
    float t_max() const { return best_.t; }
    bool hit() const { return best_.hit(); }

    /// One triangle of a block.
    void test(const TriangleBlock<8>& block, std::uint32_t lane) {
        RayHit hit;
        if constexpr (Counted)
            ++work_->triangle_tests;
        if (K::intersect(per_ray, ray_, block.triangle(lane), best_.t, hit))
            take(hit, block.id[lane]);
    }

    /// A whole block, whose test `bits` and `hits` are the answer of.
    void tested(const TriangleBlock<8>& block, std::uint32_t bits, const BlockHits<8>& hits) {
        if constexpr (Counted)
            work_->triangle_tests += 8;
        for (; bits != 0; bits &= bits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(bits));
            if (hits.t[i] <= best_.t)
                take({hits.t[i], hits.u[i], hits.v[i]}, block.id[i]);
        }
    }

    /// One node opened with `box_tests` tests; compiled away unless Counted.
    void count(std::uint64_t box_tests, std::size_t stack) {
        if constexpr (Counted) {
            ++work_->node_visits;
            work_->box_tests += box_tests;
            work_->stack_max = std::max<std::uint64_t>(work_->stack_max, stack);
        }
    }

    RayHit result() const {
        if constexpr (Counted)
            work_->answers += hit();
        return hit() ? best_ : RayHit{};
    }

  private:
    /// A hit with t <= t_max(): the nearer one, or the lower triangle.
    void take(RayHit hit, std::uint32_t triangle) {
        hit.triangle = triangle;
        if (hit.t < best_.t || hit.triangle < best_.triangle)
            best_ = hit;
    }

    const Ray<float>& ray_;
    Work* work_;
    RayHit best_;
};

/// What all rays of one call share.
struct RayJob {
    std::span<const Ray<float>> rays;
    RayQuery query;
    std::string_view kernel;
    const TriangleBlocks& triangles;
    std::span<RayHit> hits;
    Work* work = nullptr; ///< null in the timed pass
};

/// Calls `f(std::span of rays, std::span of hits)` for chunks of rays.
template <class F> void for_ray_chunks(RayJob job, const Executor& executor, const F& walk) {
    if (job.hits.size() != job.rays.size())
        throw std::invalid_argument("rays: one hit per ray is wanted");
    if (!with_kernel<RayKernels>(job.kernel, [](auto) {}))
        throw std::invalid_argument("unknown ray kernel '" + std::string(job.kernel) +
                                    "'; `boxwood list kernels` names them");
    constexpr std::size_t chunk = 512;
    executor.for_each((job.rays.size() + chunk - 1) / chunk, [&](std::size_t c) {
        RayJob part = job;
        const std::size_t n = std::min(chunk, job.rays.size() - c * chunk);
        part.rays = job.rays.subspan(c * chunk, n);
        part.hits = job.hits.subspan(c * chunk, n);
        walk(part);
    });
}

} // namespace boxwood
