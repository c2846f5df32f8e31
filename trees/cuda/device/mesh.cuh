#pragma once

// The part of tree.cu that is DeviceMeshBvh: kernels that are no templates, of which a program must
// have but one, are compiled in one source alone.

#include "kernels/ray_triangle/moller_trumbore.h"
#include "kernels/ray_triangle/watertight.h"
#include "trees/cuda/builds/built_tree.cuh"
#include "trees/cuda/device/counted.cuh"
#include "trees/cuda/queries/packed_queries.cuh"
#include "trees/cuda/queries/wide8_rays.cuh"
#include "trees/detail/device_tree.h"
#include "trees/traversals/rays/ray_range.h"

#include <concepts>

namespace boxwood::detail {
namespace {

using namespace cuda;

/// A thread per triangle: its box, with the NaNs of its corners. *first_bad, none_bad at first,
/// becomes the first triangle with a vertex that is not there.
__global__ void bound_checked(MeshView mesh, std::uint64_t n_vertices, Box* boxes,
                              std::uint32_t* first_bad) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= mesh.n)
        return;
    for (std::size_t k = 0; k < 3; ++k)
        if (mesh.corners[std::size_t{3} * i + k] >= n_vertices) {
            atomicMin(first_bad, i);
            boxes[i] = Box{};
            return;
        }
    const Triangle<float> triangle = mesh.triangle(i);
    Box box = triangle.bounds();
    for (int axis = 0; axis < 3; ++axis) {
        const float sum = triangle.a[axis] + triangle.b[axis] + triangle.c[axis];
        if (triangle.a[axis] != triangle.a[axis] || triangle.b[axis] != triangle.b[axis] ||
            triangle.c[axis] != triangle.c[axis])
            box.min[axis] = sum;
    }
    boxes[i] = box;
}

/// What of a tree rays go through.
const Wide8View& rays_go_through(const BuiltTree& tree, const Wide8View*) { return tree.wide8(); }
const cuda::PackedView& rays_go_through(const BuiltTree& tree, const cuda::PackedView*) {
    return tree.packed();
}

template <class Tree> class MeshOf final : public DeviceMesh {
  public:
    MeshOf(Form form, const DeviceMeshBvhOptions& options)
        : options_(options), in_(options.place), form_(form), tree_({.form = form}) {}

    std::size_t size() const override { return tree_.size(); }

    void build(DeviceSpan<const Vec3<float>> vertices,
               DeviceSpan<const Corners> triangles) override {
        const Chosen chosen(in_.place.index);
        require_at_most_max_items(triangles.size);
        corners_ = triangles;
        n_vertices_ = vertices.size;
        if (triangles.size == 0)
            return;
        boxes_ = DeviceArray<Box>(triangles.size, in_.place);
        triangles_ = DeviceArray<Triangle<float>>(triangles.size, in_.place);
        first_bad_ = DeviceArray<std::uint32_t>(1, in_.place);
        require_memory("a tree", BuiltTree::bytes({.form = form_}, triangles.size) +
                                     triangles.size * 2 * sizeof(std::uint64_t));
        fit(vertices);
    }

    void update(DeviceSpan<const Vec3<float>> vertices) override {
        if (vertices.size != n_vertices_)
            throw std::invalid_argument("a mesh of " + std::to_string(n_vertices_) +
                                        " vertices, updated by " + std::to_string(vertices.size));
        const Chosen chosen(in_.place.index);
        if (corners_.size > 0)
            fit(vertices);
    }

    DeviceArray<RayHit> closest(DeviceSpan<const Ray<float>> rays) override {
        return one_each<RayQuery::closest>(rays);
    }
    DeviceArray<RayHit> any(DeviceSpan<const Ray<float>> rays) override {
        return one_each<RayQuery::any>(rays);
    }

    DeviceAnswersOf<RayHit> all(DeviceSpan<const Ray<float>> rays) override {
        if constexpr (std::same_as<Tree, cuda::PackedView>) {
            throw std::invalid_argument(
                "all hits, on a device: the builder is hilbert; lbvh and hploc answer it");
        } else {
            const Chosen chosen(in_.place.index);
            const Ordered by = ordered(rays);
            return with_kernel([&]<RayKernel K>() {
                auto found = count_and_fill<RayHit>(
                    by.view.n, in_, [&]<Pass pass>(const AnswersTo<RayHit>& to) {
                        find_all_hits<K, pass>(by.view, to, in_.stream);
                    });
                sort_answers(found.offsets.span().data, by.view.n, found.of.span().data,
                             in_.stream);
                return found;
            });
        }
    }

  private:
    /// Rays, and the order in which they share warps.
    struct Ordered {
        DeviceArray<std::uint32_t> order;
        RaysView<Tree> view;
    };

    MeshView mesh(DeviceSpan<const Vec3<float>> vertices) const {
        return {vertices.data, reinterpret_cast<const std::uint32_t*>(corners_.data),
                static_cast<std::uint32_t>(corners_.size)};
    }

    /// Builds the tree, or fits it.
    void fit(DeviceSpan<const Vec3<float>> vertices) {
        try {
            bound(vertices);
            Box* const boxes = boxes_.span().data;
            if (size() == 0) {
                tree_.build(boxes, corners_.size, in_.stream);
            } else {
                tree_.look(boxes, in_.stream);
                tree_.check(boxes, in_.stream);
                tree_.refit(boxes, in_.stream);
            }
            launch(in_.stream, blocks_for(corners_.size, radix_threads), radix_threads,
                   gather_triangles, mesh(vertices),
                   rays_go_through(tree_, static_cast<const Tree*>(nullptr)).items,
                   triangles_.span().data);
            bounds_ = number_at(tree_.bounds(), in_.stream);
            require_ray_range(bounds_);
        } catch (...) {
            if (size() > 0)
                tree_.build(nullptr, 0, in_.stream);
            throw;
        }
    }
    void bound(DeviceSpan<const Vec3<float>> vertices) {
        std::uint32_t* const first_bad = first_bad_.span().data;
        fill_bytes(first_bad, 0xff, sizeof(*first_bad), in_.stream);
        launch(in_.stream, blocks_for(corners_.size, radix_threads), radix_threads, bound_checked,
               mesh(vertices), std::uint64_t{n_vertices_}, boxes_.span().data, first_bad);
        const std::uint32_t bad =
            number_at(static_cast<const std::uint32_t*>(first_bad), in_.stream);
        if (bad == none_bad)
            return;
        const Corners corners = number_at(corners_.data + bad, in_.stream);
        throw std::invalid_argument("triangle " + std::to_string(bad) + " has the vertex " +
                                    std::to_string(*std::ranges::max_element(corners)) + ", of " +
                                    std::to_string(n_vertices_));
    }

    Ordered ordered(DeviceSpan<const Ray<float>> rays) {
        const std::uint32_t n = number_of_queries(rays.size);
        Ordered by{{},
                   {rays_go_through(tree_, static_cast<const Tree*>(nullptr)),
                    triangles_.span().data, rays.data, n, nullptr}};
        if (!options_.sort_rays || size() == 0 || n < 2)
            return by;
        // Four numbers each, and what CUB sorts in.
        require_memory("sorting rays", n * std::uint64_t{24} + (1 << 16));
        by.order = DeviceArray<std::uint32_t>(n, in_.place);
        DeviceArray<std::uint32_t> codes(n, in_.place), sorted(n, in_.place), numbers(n, in_.place);
        launch(in_.stream, blocks_for(n, ray_threads), ray_threads, ray_codes, rays.data, n,
               EntryGrid(bounds_), codes.span().data, numbers.span().data);
        sort_by_bits(codes.span().data, sorted.span().data, numbers.span().data,
                     by.order.span().data, n, 0, 3 * EntryGrid::bits + 3, in_.spare, in_.stream);
        by.view.order = by.order.span().data;
        return by;
    }

    template <RayQuery query> DeviceArray<RayHit> one_each(DeviceSpan<const Ray<float>> rays) {
        const Chosen chosen(in_.place.index);
        const Ordered by = ordered(rays);
        DeviceArray<RayHit> hits(rays.size, in_.place);
        with_kernel([&]<RayKernel K>() {
            if constexpr (std::same_as<Tree, cuda::PackedView>)
                find_closest_hits<K>(by.view, hits.span().data, in_.stream);
            else
                find_hits<K, query>(by.view, hits.span().data, in_.stream);
        });
        return hits;
    }

    template <class F> auto with_kernel(const F& f) {
        switch (options_.kernel) {
        case DeviceRayKernel::moller_trumbore_f32:
            return f.template operator()<MollerTrumbore<float>>();
        case DeviceRayKernel::moller_trumbore_f64:
            return f.template operator()<MollerTrumbore<double>>();
        case DeviceRayKernel::watertight:
            break;
        }
        return f.template operator()<Watertight>();
    }

    DeviceMeshBvhOptions options_;
    Workplace in_;
    Form form_;
    BuiltTree tree_;
    DeviceSpan<const Corners> corners_;
    std::size_t n_vertices_ = 0;
    DeviceArray<Box> boxes_;                 ///< of the triangles
    DeviceArray<Triangle<float>> triangles_; ///< by slot
    DeviceArray<std::uint32_t> first_bad_;
    Box bounds_;
};

} // namespace

std::unique_ptr<DeviceMesh> make_device_mesh(const DeviceMeshBvhOptions& options) {
    const Chosen chosen(options.place.index); // says if there is none
    switch (options.builder) {
    case DeviceBuilder::hilbert:
        return std::make_unique<MeshOf<cuda::PackedView>>(Form::packed, options);
    case DeviceBuilder::lbvh:
        return std::make_unique<MeshOf<Wide8View>>(Form::radix_wide8, options);
    case DeviceBuilder::hploc:
        return std::make_unique<MeshOf<Wide8View>>(Form::hploc_wide8, options);
    }
    throw std::invalid_argument("no such DeviceBuilder");
}

} // namespace boxwood::detail
