#include "trees/builders/ploc.h"
#include "trees/builders/detail/ploc_tile.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

/// The merges of one tile, and of the leaves or clusters [begin, end) that it began with.
struct TileMerges {
    std::uint32_t first_node; ///< of its merges, which follow each other
    std::uint32_t count;
    std::size_t begin, end;
};

/// What a tile leaves over, but for the last one.
constexpr std::size_t left_over = PlocTile::capacity / 8;

class Clustering {
  public:
    Clustering(Boxes boxes, Buffer<std::uint32_t> along, std::size_t radius,
               const Executor& executor)
        : boxes_(boxes), along_(std::move(along)), radius_(radius), executor_(executor),
          merges_(2 * boxes.size() + PlocTile::capacity), places_(3 * boxes.size()) {}

    Tree build() {
        const std::size_t n = boxes_.size();
        Tree tree(n);
        if (n == 0)
            return tree;
        cluster();
        number(tree);
        return tree;
    }

  private:
    /// From all items to one cluster, a level of tiles at a time.
    void cluster() {
        const std::size_t n = boxes_.size();
        next_node_ = static_cast<std::uint32_t>(n);
        std::size_t left = run_level(n, [&](PlocTile& tile, std::size_t begin, std::size_t end) {
            constexpr std::size_t ahead = 16;
            for (std::size_t i = begin; i < end; ++i) {
                __builtin_prefetch(&boxes_[along_[std::min(i + ahead, end - 1)]]);
                tile.add({boxes_[along_[i]], static_cast<std::uint32_t>(i), 1});
            }
        });
        while (left > 1)
            left = run_level(left, [&](PlocTile& tile, std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i)
                    tile.add(clusters_[i]);
            });
    }

    template <class Fill> std::size_t run_level(std::size_t n, const Fill& fill) {
        const std::size_t n_tiles = (n + PlocTile::capacity - 1) / PlocTile::capacity;
        const std::size_t wanted = n_tiles == 1 ? 1 : left_over;
        std::vector<TileMerges> tiles(n_tiles);
        Buffer<PlocCluster> left(n_tiles * wanted);
        std::vector<std::size_t> n_left(n_tiles);
        executor_.for_each(n_tiles, [&](std::size_t t) {
            TileMerges& made = tiles[t];
            made.begin = n * t / n_tiles;
            made.end = n * (t + 1) / n_tiles;
            made.first_node = next_node_ + static_cast<std::uint32_t>(made.begin);
            PlocTile tile;
            fill(tile, made.begin, made.end);
            made.count = static_cast<std::uint32_t>(
                tile.reduce(wanted, radius_, made.first_node, merge_of(made.first_node)));
            n_left[t] = tile.size();
            for (std::size_t i = 0; i < tile.size(); ++i)
                left[t * wanted + i] = tile[i];
        });
        std::size_t out = 0;
        for (std::size_t t = 0; t < n_tiles; ++t)
            for (std::size_t i = 0; i < n_left[t]; ++i)
                left[out++] = left[t * wanted + i];
        clusters_ = std::move(left);
        next_node_ += static_cast<std::uint32_t>(n);
        levels_.push_back(std::move(tiles));
        return out;
    }

    PlocMerge* merge_of(std::uint32_t node) { return &merges_[node - boxes_.size()]; }

    /// Canonical numbers from the root down, then the boxes from the leaves up. The levels above
    /// the first are few nodes; below it a tile is a thing of its own.
    void number(Tree& tree) {
        places_[clusters_[0].node] = {0, 0};
        for (std::size_t level = levels_.size(); --level > 0;)
            for_tiles(level, [&](const TileMerges& tile) { place_children(tile); });
        for_tiles(0, [&](const TileMerges& tile) {
            place_children(tile);
            for (std::size_t i = tile.begin; i < tile.end; ++i) {
                const Place place = places_[i];
                const std::uint32_t item = along_[i];
                tree.order[place.slot] = item;
                tree.nodes[place.node] = {boxes_[item], place.slot, 1};
            }
            write_inner(tile, tree);
        });
        for (std::size_t level = 1; level < levels_.size(); ++level)
            for_tiles(level, [&](const TileMerges& tile) { write_inner(tile, tree); });
    }

    template <class Body> void for_tiles(std::size_t level, const Body& body) const {
        const std::vector<TileMerges>& tiles = levels_[level];
        executor_.for_each(tiles.size(), [&](std::size_t t) { body(tiles[t]); });
    }

    void place_children(const TileMerges& tile) {
        const PlocMerge* const merges = merge_of(tile.first_node);
        for (std::size_t k = tile.count; k-- > 0;) {
            const PlocMerge& merge = merges[k];
            const Place place = places_[tile.first_node + k];
            places_[merge.left] = {place.node + 1, place.slot};
            places_[merge.right] = {place.node + 2 * merge.left_count,
                                    place.slot + merge.left_count};
        }
    }

    void write_inner(const TileMerges& tile, Tree& tree) {
        const PlocMerge* const merges = merge_of(tile.first_node);
        for (std::size_t k = 0; k < tile.count; ++k) {
            const Place place = places_[tile.first_node + k];
            const TreeNode* const node = &tree.nodes[place.node];
            tree.nodes[place.node] = {
                merge(node[1].box, node[2 * std::size_t{merges[k].left_count}].box), place.slot,
                merges[k].count};
        }
    }

    struct Place {
        std::uint32_t node, slot;
    };

    Boxes boxes_;
    Buffer<std::uint32_t> along_; ///< place on the curve -> item
    std::size_t radius_;
    const Executor& executor_;
    Buffer<PlocMerge> merges_; ///< by node less the leaves
    Buffer<Place> places_;     ///< of nodes, as numbered by tiles, in the tree
    Buffer<PlocCluster> clusters_;
    std::vector<std::vector<TileMerges>> levels_;
    std::uint32_t next_node_ = 0;
};

} // namespace

Tree PlocBuilder::build(Boxes boxes, const Executor& executor) const {
    return Clustering(boxes, coarse_curve_order(boxes, curve, executor),
                      static_cast<std::size_t>(radius), executor)
        .build();
}

BuilderEntry ploc_builder() { return builder_entry<PlocBuilder>(); }

} // namespace boxwood
