#include "bench/peers/warp/warp_tree.h"
#include "bench/tasks/detail/bench_place.h"
#include "trees/cuda/device/machine.h"

#define WP_ENABLE_CUDA 1
#include <warp/native/warp.h>

#include <warp/native/bvh.h>
#include <warp/native/mesh.h>
#include <warp/native/version.h>

#include <dlfcn.h>

namespace boxwood::bench {
namespace {

/// As many as Warp's stacks in shared memory are for.
constexpr unsigned n_threads = WP_TILE_BLOCK_DIM;

struct Queries {
    const wp::vec3 *lowers, *uppers;
    std::uint32_t n, first_item;
};
struct Room {
    unsigned long long* n; ///< pairs found, also those beyond the room
    Pair* pairs;
    unsigned long long room;
};

/// A thread per query traverses the tree by Warp's own functions. It holds its pairs back, so that
/// a warp takes the places of all of them at once; only of more than `most` some are written
/// before.
template <bool is_self>
__global__ void __launch_bounds__(n_threads)
    warp_pairs(std::uint64_t tree, Queries queries, WarpOrder order, Room to) {
    constexpr unsigned most = 8;
    std::uint32_t held[most];
    unsigned n = 0;
    std::uint32_t query = blockIdx.x * blockDim.x + threadIdx.x;
    const auto write = [&](unsigned long long first) {
        for (unsigned i = 0; i < n; ++i)
            if (first + i < to.room)
                to.pairs[first + i] = {query, held[i]};
    };
    if (query < queries.n) {
        if (is_self && order == WarpOrder::of_the_tree)
            query = static_cast<std::uint32_t>(
                reinterpret_cast<const wp::BVH*>(tree)->primitive_indices[query]);
        wp::bvh_query_t traversal =
            wp::bvh_query_aabb(tree, queries.lowers[query], queries.uppers[query], -1);
        for (int found; wp::bvh_query_next(traversal, found, FLT_MAX);) {
            const std::uint32_t item = static_cast<std::uint32_t>(found) + queries.first_item;
            if (is_self && item <= query)
                continue;
            if (n == most) {
                write(atomicAdd(to.n, static_cast<unsigned long long>(most)));
                n = 0;
            }
            held[n++] = item;
        }
    }
    const unsigned lane = threadIdx.x % 32;
    unsigned up_to_here = n;
    for (unsigned step = 1; step < 32; step *= 2) {
        const unsigned before = __shfl_up_sync(~0u, up_to_here, step);
        up_to_here += lane < step ? 0 : before;
    }
    unsigned long long first = 0;
    if (lane == 31)
        first = atomicAdd(to.n, static_cast<unsigned long long>(up_to_here));
    write(__shfl_sync(~0u, first, 31) + up_to_here - n);
}

__device__ inline wp::vec3 converted(const Vec3<float>& v) { return {v.x, v.y, v.z}; }

/// Warp's u and v are the weights of the first two corners.
template <bool any>
__global__ void __launch_bounds__(n_threads)
    warp_rays(std::uint64_t mesh, const Ray<float>* rays, std::uint32_t n, RayHit* hits) {
    const std::uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= n)
        return;
    const Ray<float> ray = rays[i];
    RayHit hit;
    if constexpr (any) {
        if (mesh != 0 && wp::mesh_query_ray_anyhit(mesh, converted(ray.origin),
                                                   converted(ray.direction), ray.t_max))
            hit.triangle = 0;
    } else {
        float t, u, v, sign;
        wp::vec3 normal;
        int face;
        if (mesh != 0 && wp::mesh_query_ray(mesh, converted(ray.origin), converted(ray.direction),
                                            ray.t_max, t, u, v, sign, normal, face))
            hit = {t, v, 1 - u - v, static_cast<std::uint32_t>(face)};
    }
    hits[i] = hit;
}

void* open_library() {
    void* const library = dlopen(BOXWOOD_WARP_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw std::runtime_error(std::string("Warp: ") + dlerror());
    return library;
}

void* symbol(const char* name) {
    static void* const library = open_library();
    void* const found = dlsym(library, name);
    if (!found)
        throw std::runtime_error(std::string("Warp: ") + dlerror());
    return found;
}

/// Warp's function of this name, with the type that its header gives it.
#define BOXWOOD_WARP(name) reinterpret_cast<decltype(&name)>(symbol(#name))

[[noreturn]] void fail(const char* what) {
    throw std::runtime_error(std::string("Warp: ") + what + ": " +
                             BOXWOOD_WARP(wp_get_error_string)());
}

// Tests traverse the trees that Warp makes in the host's memory; it makes no lbvh there.
#if defined(__CUDACC__)
#define BOXWOOD_WARP_HERE(name) BOXWOOD_WARP(name##_device)
constexpr int number_of(WarpBuilder builder) { return static_cast<int>(builder); }
template <class Create, class... Arguments>
std::uint64_t made_by(Create create, Arguments... arguments) {
    return create(nullptr, arguments...);
}
void rebuild(std::uint64_t tree, WarpBuilder) { BOXWOOD_WARP(wp_bvh_rebuild_device)(tree); }
#else
#define BOXWOOD_WARP_HERE(name) BOXWOOD_WARP(name##_host)
constexpr int number_of(WarpBuilder builder) {
    return builder == WarpBuilder::lbvh ? BVH_CONSTRUCTOR_MEDIAN : static_cast<int>(builder);
}
template <class Create, class... Arguments>
std::uint64_t made_by(Create create, Arguments... arguments) {
    return create(arguments...);
}
void rebuild(std::uint64_t tree, WarpBuilder builder) {
    BOXWOOD_WARP(wp_bvh_rebuild_host)(tree, number_of(builder));
}
#endif

/// For intersections Warp advises leaves of one; of cuBQL's meshes 0 is its own choice.
constexpr int leaf_size = 1;

wp::vec3* converted(DeviceSpan<const Vec3<float>> of) {
    static_assert(sizeof(wp::vec3) == sizeof(Vec3<float>));
    return const_cast<wp::vec3*>(reinterpret_cast<const wp::vec3*>(of.data));
}

Queries queries_of(const WarpBoxes& boxes, std::uint32_t first_item) {
    return {converted(boxes.lowers), converted(boxes.uppers),
            static_cast<std::uint32_t>(boxes.lowers.size), first_item};
}

/// Warp goes on without memory that it did not get: of what its builders were seen to ask for, the
/// most, with room to spare.
void require_room(std::size_t n) { cuda::require_memory("Warp's tree", 256 * n); }

} // namespace

WarpLibrary::WarpLibrary() {
    const cuda::Chosen chosen(bench_place().index);
    static const int status = BOXWOOD_WARP(wp_init)(WP_VERSION_STRING);
    if (status != 0)
        fail(BOXWOOD_WARP_LIBRARY);
#if defined(__CUDACC__)
    threshold_ = BOXWOOD_WARP(wp_cuda_device_get_mempool_release_threshold)(bench_place().index);
    BOXWOOD_WARP(wp_cuda_device_set_mempool_release_threshold)
    (bench_place().index, ~std::uint64_t{0});
#endif
}
WarpLibrary::~WarpLibrary() {
#if defined(__CUDACC__)
    BOXWOOD_WARP(wp_cuda_device_set_mempool_release_threshold)(bench_place().index, threshold_);
#endif
}

std::string warp_version() { return WP_VERSION_STRING; }

WarpTree::~WarpTree() {
    if (tree_)
        BOXWOOD_WARP_HERE(wp_bvh_destroy)(tree_);
}

void WarpTree::build(const WarpBoxes& boxes) {
    const cuda::Chosen chosen(bench_place().index);
    // By sah Warp can only make another tree: its rebuild makes an lbvh.
    const bool stays =
        tree_ && builder_ != WarpBuilder::sah && boxes_.lowers.data == boxes.lowers.data &&
        boxes_.uppers.data == boxes.uppers.data && boxes_.lowers.size == boxes.lowers.size;
    boxes_ = boxes;
    if (stays)
        return rebuild(tree_, builder_);
    if (tree_)
        BOXWOOD_WARP_HERE(wp_bvh_destroy)(tree_);
    tree_ = 0;
    if (boxes.lowers.size == 0)
        return;
    require_room(boxes.lowers.size);
    tree_ = made_by(BOXWOOD_WARP_HERE(wp_bvh_create), converted(boxes.lowers),
                    converted(boxes.uppers), static_cast<int>(boxes.lowers.size),
                    number_of(builder_), static_cast<int*>(nullptr), leaf_size);
    if (!tree_)
        fail("no tree was made");
}

void WarpTree::refit() {
    const cuda::Chosen chosen(bench_place().index);
    if (tree_)
        BOXWOOD_WARP_HERE(wp_bvh_refit)(tree_);
}

/// find(room), and again if there were more pairs than room.
template <class Find> void WarpTree::into_room(const Find& find) {
    const cuda::Chosen chosen(bench_place().index);
    const cuda::Stream stream = cuda::stream_of(bench_place());
    if (count_.size() == 0)
        count_ = DeviceArray<unsigned long long>(1, bench_place());
    for (;;) {
        unsigned long long* const count = count_.span().data;
        cuda::fill_bytes(count, 0, sizeof(*count), stream);
        find(Room{count, room_.span().data, room_.size()}, stream);
        unsigned long long n = 0;
        cuda::download(static_cast<const unsigned long long*>(count), std::span(&n, 1), stream);
        cuda::wait(stream);
        n_pairs_ = n;
        if (n <= room_.size())
            return;
        room_ = {};
        room_ = DeviceArray<Pair>(n + n / 8, bench_place());
    }
}

void WarpTree::find_self_pairs(WarpOrder order) {
    const Queries queries = queries_of(boxes_, 0);
    into_room([&](const Room& room, cuda::Stream stream) {
        cuda::launch(stream, cuda::blocks_for(queries.n, n_threads), n_threads, warp_pairs<true>,
                     tree_, queries, order, room);
    });
}

void WarpTree::find(const WarpBoxes& boxes, std::uint32_t first_item) {
    const Queries queries = queries_of(boxes, first_item);
    into_room([&](const Room& room, cuda::Stream stream) {
        if (tree_)
            cuda::launch(stream, cuda::blocks_for(queries.n, n_threads), n_threads,
                         warp_pairs<false>, tree_, queries, WarpOrder::as_given, room);
    });
}

void WarpTree::read_pairs(std::vector<Pair>& to) const {
    const cuda::Chosen chosen(bench_place().index);
    const cuda::Stream stream = cuda::stream_of(bench_place());
    to.resize(n_pairs_);
    if (to.empty())
        return;
    cuda::download(room_.span().data, std::span(to), stream);
    cuda::wait(stream);
}

WarpMesh::~WarpMesh() {
    if (mesh_)
        BOXWOOD_WARP_HERE(wp_mesh_destroy)(mesh_);
}

void WarpMesh::build(DeviceSpan<const Vec3<float>> vertices,
                     DeviceSpan<const std::array<std::uint32_t, 3>> triangles) {
    const cuda::Chosen chosen(bench_place().index);
    if (mesh_)
        BOXWOOD_WARP_HERE(wp_mesh_destroy)(mesh_);
    mesh_ = 0;
    if (triangles.size == 0)
        return;
    require_room(triangles.size);
    const auto n_vertices = static_cast<int>(vertices.size);
    const auto n_triangles = static_cast<int>(triangles.size);
    int* const corners = reinterpret_cast<int*>(
        const_cast<std::array<std::uint32_t, 3>*>(triangles.data)); // which Warp only reads
    const wp::array_t<wp::vec3> points(converted(vertices), n_vertices);
    mesh_ = made_by(BOXWOOD_WARP_HERE(wp_mesh_create), points, wp::array_t<wp::vec3>{},
                    wp::array_t<int>(corners, 3 * n_triangles), n_vertices, n_triangles, 0,
                    number_of(builder_), static_cast<int*>(nullptr),
                    builder_ == WarpBuilder::cubql ? 0 : leaf_size);
    if (!mesh_)
        fail("no mesh was made");
}

void WarpMesh::cast(DeviceSpan<const Ray<float>> rays, bool any, DeviceSpan<RayHit> hits) const {
    const cuda::Chosen chosen(bench_place().index);
    cuda::launch(cuda::stream_of(bench_place()), cuda::blocks_for(rays.size, n_threads), n_threads,
                 any ? warp_rays<true> : warp_rays<false>, mesh_, rays.data,
                 static_cast<std::uint32_t>(rays.size), hits.data);
}

} // namespace boxwood::bench
