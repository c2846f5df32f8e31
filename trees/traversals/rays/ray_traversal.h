#pragma once

#include "kernels/ray_triangle/triangle_block.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "trees/queries/rays.h"
#include "trees/queries/single_rays.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood::detail {

enum class RayMode : std::uint8_t { closest, any, all };

/// Rays are handed to threads so many at a time.
inline constexpr std::size_t ray_chunk = 512;

/// What all rays of one chunk share.
struct RayJob {
    std::span<const Ray<float>> rays;
    RayMode mode;
    std::string_view kernel;
    const TriangleBlocks& triangles;
    std::size_t depth;       ///< of the layout; 0 if it is empty
    std::span<RayHit> hits;  ///< of closest and any
    HitSink* sink = nullptr; ///< of all
    Work* work = nullptr;    ///< null in the timed pass
    std::size_t chunk = 0, first_ray = 0;
    std::atomic<bool>* stop = nullptr; ///< set when the sink has enough
};

/// One ray on its way through a tree: the nearest hit so far, or all of them.
template <RayKernel K, RayMode mode, bool Counted> class RayState {
  public:
    RayState(const Ray<float>& ray, Work* work, std::vector<RayHit>& found)
        : per_ray(K::prepare(ray)), ray_(ray), work_(work), found_(found) {
        best_.t = ray.t_max;
    }

    const typename K::PerRay per_ray;

    float t_min() const { return ray_.t_min; }
    /// Nothing beyond this t matters any more.
    float t_max() const { return best_.t; }
    bool done() const { return mode == RayMode::any && best_.hit(); }

    /// One triangle of a block.
    template <std::size_t lanes> void test(const TriangleBlock<lanes>& block, std::size_t lane) {
        RayHit hit;
        if constexpr (Counted)
            ++work_->triangle_tests;
        if (K::intersect(per_ray, ray_, block.triangle(lane), best_.t, hit))
            take(hit, block.id[lane]);
    }

    /// A whole block, whose test `bits` and `hits` are the answer of.
    template <std::size_t lanes>
    void tested(const TriangleBlock<lanes>& block, std::uint32_t bits,
                const BlockHits<lanes>& hits) {
        if constexpr (Counted)
            work_->triangle_tests += lanes;
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
            work_->answers += best_.hit();
        return best_.hit() ? best_ : RayHit{};
    }

  private:
    /// A hit with t <= t_max(): the nearer one, or the lower triangle.
    void take(RayHit hit, std::uint32_t triangle) {
        hit.triangle = triangle;
        if constexpr (mode == RayMode::all)
            found_.push_back(hit);
        else if (hit.t < best_.t || hit.triangle < best_.triangle)
            best_ = hit;
    }

    const Ray<float>& ray_;
    Work* work_;
    std::vector<RayHit>& found_;
    RayHit best_;
};

/// All hits of a ray by t and then by triangle, once each: a triangle that stands in several leaves
/// was found the same each time.
inline void sort_distinct(std::vector<RayHit>& found) {
    std::ranges::sort(found, [](const RayHit& a, const RayHit& b) {
        return a.t != b.t ? a.t < b.t : a.triangle < b.triangle;
    });
    found.erase(std::unique(found.begin(), found.end()), found.end());
}

/// Answers every ray of a job by `trace(ray, found)`, which gives a RayState's result. Kernels miss
/// whatever is not finite, so such rays are not traced.
template <RayMode mode, class Trace> void for_each_ray(const RayJob& job, const Trace& trace) {
    std::vector<RayHit> found;
    for (std::size_t i = 0; i < job.rays.size(); ++i) {
        const Ray<float>& ray = job.rays[i];
        RayHit hit;
        if (job.depth != 0 && is_finite(ray.origin) && is_finite(ray.direction))
            hit = trace(ray, found);
        if constexpr (mode == RayMode::all) {
            sort_distinct(found);
            if (!found.empty() &&
                !job.sink->take(job.chunk, static_cast<std::uint32_t>(job.first_ray + i), found)) {
                *job.stop = true;
                return;
            }
            found.clear();
        } else {
            job.hits[i] = hit;
        }
    }
}

/// Calls f(K, mode, Counted), each as a type, for what a job wants.
template <class F> void with_job_types(const RayJob& job, const F& f) {
    with_kernel<RayKernels>(job.kernel, [&]<class K>(std::type_identity<K> k) {
        using enum RayMode;
        const auto one = [&]<RayMode mode>(std::integral_constant<RayMode, mode> m) {
            if (mode != all && job.work)
                f(k, m, std::bool_constant<mode != all>{});
            else
                f(k, m, std::false_type{});
        };
        switch (job.mode) {
        case closest:
            return one(std::integral_constant<RayMode, closest>{});
        case any:
            return one(std::integral_constant<RayMode, any>{});
        case all:
            return one(std::integral_constant<RayMode, all>{});
        }
    });
}

/// Calls traverse(part) for chunks of the job's rays.
template <class F> void for_ray_chunks(RayJob job, const Executor& executor, const F& traverse) {
    if (job.mode != RayMode::all && job.hits.size() != job.rays.size())
        throw std::invalid_argument("rays: one hit per ray is wanted");
    if (!with_kernel<RayKernels>(job.kernel, [](auto) {}))
        throw std::invalid_argument(
            unknown_name("ray kernel", job.kernel, names_of(ray_kernels())));
    const std::size_t chunks = (job.rays.size() + ray_chunk - 1) / ray_chunk;
    std::atomic<bool> stop = false;
    job.stop = &stop;
    if (job.sink)
        job.sink->begin(chunks, executor.threads() == 1);
    executor.for_each(chunks, [&](std::size_t c) {
        if (stop)
            return;
        RayJob part = job;
        const std::size_t n = std::min(ray_chunk, job.rays.size() - c * ray_chunk);
        part.rays = job.rays.subspan(c * ray_chunk, n);
        if (!job.sink)
            part.hits = job.hits.subspan(c * ray_chunk, n);
        part.chunk = c;
        part.first_ray = c * ray_chunk;
        traverse(part);
    });
    if (job.sink)
        job.sink->end();
}

/// Answers the rays of one chunk.
#define X(name, L) void traverse_rays(const L& layout, const RayJob& job);
BOXWOOD_TRAVERSED_LAYOUTS(X)
#undef X

/// The same for the nodes that rays visit in a layout of lanes, and the functions for one ray at a
/// time; depth: of the layout.
template <class Node> void traverse_nodes(const RayJob& job);
template <class Node>
SingleRayFunctions single_ray_functions_of(std::size_t depth, std::string_view kernel);

} // namespace boxwood::detail
