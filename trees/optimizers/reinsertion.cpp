#include "trees/optimizers/reinsertion.h"

#include "trees/executors/chunks.h"
#include "trees/optimizers/detail/linked_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace boxwood {
using namespace detail;
namespace {

struct Move {
    float gain;
    std::uint32_t node, target; ///< `node` becomes the sibling of what is at `target`
};

struct Waiting {
    float max_gain; ///< no place below gains more
    float left;     ///< gain before the place itself is paid for
    std::uint32_t below;
};

/// Levels that a search climbs, and pairs of siblings that it opens: what bounds the time on trees
/// that are chains.
constexpr int climb_limit = 64;
constexpr int visit_limit = 256;

class Reinsertion : public LinkedTree {
  public:
    Reinsertion(const Tree& tree, const Executor& executor)
        : LinkedTree(tree, executor), marks_(2 * tree.size(), 0) {}
    /// Whether any node was moved.
    bool pass(double share);

  private:
    Move search(std::uint32_t node, std::vector<Waiting>& stack) const;
    std::vector<std::uint32_t> by_area() const;
    bool apply(std::uint32_t node, std::uint32_t target);
    double gain_of(std::uint32_t node, std::uint32_t target, std::uint32_t& common);
    void put(std::uint32_t to, const Link& content);
    void refit(std::uint32_t from, std::uint32_t end);

    std::vector<std::uint32_t> marks_; ///< of gain_of: which call saw the node last
    std::uint32_t mark_ = 0;
};

/// The best place for a node, by branch and bound: at each level on the way up, what the path has
/// gained so far without the node, less what the nodes around a new place would grow by.
Move Reinsertion::search(std::uint32_t node, std::vector<Waiting>& stack) const {
    Move best{0, node, node};
    const Bounds4 own = bounds(node);
    const float own_area = own.area();
    std::uint32_t pivot = links_[node].above;
    float gained = bounds(pivot).area();
    Bounds4 rest = bounds(node ^ 1);
    int visits = 0;

    const auto look_below = [&](std::uint32_t below, float left) {
        stack.push_back({left - own_area, left, below});
        while (!stack.empty()) {
            const Waiting at = stack.back();
            stack.pop_back();
            if (at.max_gain <= best.gain)
                continue;
            if (++visits > visit_limit) {
                stack.clear();
                break;
            }
            Waiting next[2];
            int n = 0;
            for (std::uint32_t child = at.below; child < at.below + 2; ++child) {
                const Bounds4 box = bounds(child);
                const float grown = box.with(own).area();
                const float gain = at.left - grown;
                if (gain > best.gain)
                    best = {gain, node, child};
                if (links_[child].is_leaf())
                    continue;
                const float left_below = gain + box.area();
                if (left_below - own_area > best.gain)
                    next[n++] = {left_below - own_area, left_below, links_[child].below};
            }
            if (n == 2 && next[0].max_gain > next[1].max_gain)
                std::swap(next[0], next[1]);
            for (int k = 0; k < n; ++k)
                stack.push_back(next[k]);
        }
    };

    // Within the sibling first, which takes the parent's place.
    if (!links_[node ^ 1].is_leaf()) {
        const float left = gained - rest.with(own).area() + rest.area();
        if (left - own_area > best.gain)
            look_below(links_[node ^ 1].below, left);
    }
    for (int climbed = 0; pivot != 0 && climbed < climb_limit; ++climbed) {
        if (gained - own_area <= best.gain && rest.same(bounds(pivot)))
            break;
        // Beside the pivot's sibling, or below it.
        const std::uint32_t beside = pivot ^ 1;
        const Bounds4 box = bounds(beside);
        const float gain = gained - box.with(own).area();
        if (gain > best.gain)
            best = {gain, node, beside};
        if (!links_[beside].is_leaf()) {
            const float left = gain + box.area();
            if (left - own_area > best.gain)
                look_below(links_[beside].below, left);
        }
        // Beside the parent itself, once it is rid of the node.
        pivot = links_[pivot].above;
        const Bounds4 whole = bounds(pivot);
        rest = rest.with(box);
        const float whole_area = whole.area();
        gained += whole_area - rest.area();
        if (gained - whole_area > best.gain)
            best = {gained - whole_area, node, pivot};
    }
    return best;
}

/// What the move gains now, and the lowest node that is above both ends or is the target itself;
/// negative if it cannot be made.
double Reinsertion::gain_of(std::uint32_t node, std::uint32_t target, std::uint32_t& common) {
    const std::uint32_t parent = links_[node].above, sibling = node ^ 1;
    if (target == sibling || target == parent)
        return -1;
    ++mark_;
    std::uint32_t up = target;
    for (int level = 0; level < climb_limit; ++level) {
        if (up == node)
            return -1;
        marks_[up] = mark_;
        if (up == 0)
            break;
        up = links_[up].above;
    }
    double gained = bounds(parent).exact_area();
    Bounds4 rest = bounds(sibling);
    common = parent;
    for (int level = 0; marks_[common] != mark_; ++level) {
        if (common == 0 || level == climb_limit)
            return -1;
        rest = rest.with(bounds(common ^ 1));
        common = links_[common].above;
        if (marks_[common] != mark_ || common == target)
            gained += bounds(common).exact_area() - rest.exact_area();
    }
    if (common == target)
        return gained - bounds(target).exact_area();
    const Bounds4 own = bounds(node);
    gained -= bounds(target).with(own).exact_area();
    for (up = links_[target].above; up != common; up = links_[up].above) {
        const Bounds4 box = bounds(up);
        gained -= box.with(own).exact_area() - box.exact_area();
    }
    return gained;
}

/// Puts a node's content in another place; its children follow.
void Reinsertion::put(std::uint32_t to, const Link& content) {
    const std::uint32_t above = links_[to].above;
    links_[to] = content;
    links_[to].above = above;
    if (!content.is_leaf())
        links_[content.below].above = links_[content.below + 1].above = to;
}

/// From `from` upwards each box the union of its children, until one stays as it was or `end`.
void Reinsertion::refit(std::uint32_t from, std::uint32_t end) {
    for (; from != end; from = links_[from].above) {
        const std::uint32_t below = links_[from].below;
        const Bounds4 box = bounds(below).with(bounds(below + 1));
        if (box.same(bounds(from)))
            return;
        set_bounds(from, box);
        if (from == 0)
            return;
    }
}

/// Makes the move if it still pays.
bool Reinsertion::apply(std::uint32_t node, std::uint32_t target) {
    std::uint32_t common = 0;
    if (!(gain_of(node, target, common) > 0x1p-40))
        return false;
    // The sibling takes the parent's place, and so frees its own beside the node.
    const std::uint32_t parent = links_[node].above, sibling = node ^ 1;
    const Bounds4 both = bounds(parent);
    put(parent, Link(links_[sibling]));
    if (common == parent) {
        set_bounds(parent, both);
    } else {
        refit(links_[parent].above, common);
        if (common == target) {
            const std::uint32_t below = links_[common].below;
            set_bounds(common, bounds(below).with(bounds(below + 1)));
        }
    }
    // The target's content moves there, and in its place stands their new parent.
    put(sibling, Link(links_[target]));
    Link above = links_[target];
    above.below = node & ~1u;
    put(target, above);
    set_bounds(target, bounds(node).with(bounds(sibling)));
    if (common != target)
        refit(links_[target].above, common);
    return true;
}

/// All but the root, sorted by powers of two of the area, the largest first, and else in the order
/// in which they lie: neighbours search the same part of the tree.
std::vector<std::uint32_t> Reinsertion::by_area() const {
    const std::size_t n = links_.size() - 2, chunks = chunks_for(n, executor_);
    std::vector<std::uint8_t> keys(n);
    std::vector<std::array<std::uint32_t, 256>> places(chunks);
    executor_.for_each(chunks, [&](std::size_t c) {
        places[c].fill(0);
        const ChunkRange range(n, chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i) {
            const float area = bounds(static_cast<std::uint32_t>(i + 2)).area();
            keys[i] = static_cast<std::uint8_t>(255 - (std::bit_cast<std::uint32_t>(area) >> 23));
            ++places[c][keys[i]];
        }
    });
    std::uint32_t at = 0;
    for (std::size_t key = 0; key < 256; ++key)
        for (auto& of_chunk : places)
            at += std::exchange(of_chunk[key], at);
    std::vector<std::uint32_t> nodes(n);
    executor_.for_each(chunks, [&](std::size_t c) {
        const ChunkRange range(n, chunks, c);
        for (std::size_t i = range.begin; i < range.end; ++i)
            nodes[places[c][keys[i]]++] = static_cast<std::uint32_t>(i + 2);
    });
    return nodes;
}

bool Reinsertion::pass(double share) {
    const std::vector<std::uint32_t> nodes = by_area();
    const auto n = static_cast<std::size_t>(std::ceil(share * static_cast<double>(nodes.size())));

    // Long enough that threads seldom wait for each other: with 1024 two took 10 % longer. The
    // staler the tree that is searched, the less a move gains: 0.1 % of the cost at 16384.
    constexpr std::size_t batch = 4096, chunk = 64;
    std::vector<Move> moves(batch);
    std::vector<std::uint64_t> paying; // the greatest gain first, then the first searched for
    bool moved = false;
    for (std::size_t first = 0; first < n; first += batch) {
        const std::size_t size = std::min(batch, n - first);
        executor_.for_each((size + chunk - 1) / chunk, [&](std::size_t c) {
            std::vector<Waiting> stack;
            for (std::size_t i = c * chunk; i < std::min(size, (c + 1) * chunk); ++i)
                moves[i] = search(nodes[first + i], stack);
        });
        paying.clear();
        for (std::size_t i = 0; i < size; ++i)
            if (moves[i].gain > 0)
                paying.push_back(std::uint64_t{~std::bit_cast<std::uint32_t>(moves[i].gain)} << 32 |
                                 i);
        std::ranges::sort(paying);
        for (std::size_t i = 0; i < paying.size(); ++i) {
            constexpr std::size_t ahead = 4;
            if (i + ahead < paying.size()) {
                const Move& next = moves[static_cast<std::uint32_t>(paying[i + ahead])];
                __builtin_prefetch(&links_[next.node]);
                __builtin_prefetch(&links_[next.target]);
                __builtin_prefetch(&marks_[next.target]);
            }
            const Move& move = moves[static_cast<std::uint32_t>(paying[i])];
            moved |= apply(move.node, move.target);
        }
    }
    return moved;
}

} // namespace

void ReinsertionOptimizer::improve(Tree& tree, const Executor& executor) const {
    if (tree.size() < 3 || passes < 1)
        return;
    Reinsertion work(tree, executor);
    for (int i = 0; i < passes; ++i)
        if (!work.pass(share))
            break;
    tree = work.canonical();
}

OptimizerEntry reinsertion_optimizer() { return optimizer_entry<ReinsertionOptimizer>(); }

} // namespace boxwood
