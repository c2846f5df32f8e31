#pragma once

#include "kernels/primitives/ray.h"
#include "trees/device_memory.h"
#include "trees/queries/sinks.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Warp's trees on the first device, without its headers or CUDA's: warp_tree.cu.
namespace boxwood::bench {

/// As Warp numbers them.
enum class WarpBuilder : std::int8_t { cubql = -1, sah = 0, lbvh = 2 };

/// In which order threads take a tree's own boxes.
enum class WarpOrder : std::uint8_t { of_the_tree, as_given };

std::string warp_version(); ///< of the headers; a library of another version is refused

/// Boxes as Warp has them.
struct WarpBoxes {
    DeviceSpan<const Vec3<float>> lowers, uppers;
};

/// Warp's library, opened. While it lives the device's pool keeps memory that is freed, as Warp's
/// users have it where they build again and again.
class WarpLibrary {
  public:
    WarpLibrary();
    WarpLibrary(const WarpLibrary&) = delete;
    WarpLibrary& operator=(const WarpLibrary&) = delete;
    ~WarpLibrary();

  private:
    std::uint64_t threshold_ = 0; ///< from which on the pool gave memory back before
};

/// A tree of Warp's, and the pairs last found. Throws DeviceError and DeviceOutOfMemory, and
/// std::runtime_error for what Warp cannot do.
class WarpTree {
  public:
    explicit WarpTree(WarpBuilder builder) : builder_(builder) {}
    ~WarpTree();

    /// Of boxes that stay where they are until the next build, in place where Warp can.
    void build(const WarpBoxes& boxes);
    /// The boxes of the last build have other values now.
    void refit();
    /// Finds pairs of items, the lower one first, in any order.
    void find_self_pairs(WarpOrder order);
    /// Finds pairs of a box and an item, which is numbered from `first_item` on.
    void find(const WarpBoxes& queries, std::uint32_t first_item);

    std::size_t n_pairs() const { return n_pairs_; }
    void read_pairs(std::vector<Pair>& to) const;

  private:
    template <class Find> void into_room(const Find& find);

    WarpLibrary library_;
    WarpBuilder builder_;
    WarpBoxes boxes_;
    std::uint64_t tree_ = 0; ///< Warp's handle
    DeviceArray<Pair> room_;
    DeviceArray<unsigned long long> count_;
    std::size_t n_pairs_ = 0;
};

/// A mesh of Warp's, whose arrays stay where they are until the next build.
class WarpMesh {
  public:
    explicit WarpMesh(WarpBuilder builder) : builder_(builder) {}
    ~WarpMesh();

    void build(DeviceSpan<const Vec3<float>> vertices,
               DeviceSpan<const std::array<std::uint32_t, 3>> triangles);
    /// Rays begin at t = 0; `any`: of a hit only that there is one.
    void cast(DeviceSpan<const Ray<float>> rays, bool any, DeviceSpan<RayHit> hits) const;

  private:
    WarpLibrary library_;
    WarpBuilder builder_;
    std::uint64_t mesh_ = 0;
};

} // namespace boxwood::bench
