#include "trees/stages/reinsertion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

namespace boxwood {
namespace {

/// x, y, z and a lane that holds something else (GCC and Clang vector types).
using Float4 = float __attribute__((vector_size(16), may_alias));
using Int4 = std::int32_t __attribute__((vector_size(16)));

/// A node on its way to a better place: 32 bytes, siblings side by side in one cache line. The
/// children of node i are nodes `below` and `below` + 1; a node of odd index stands right.
/// Node 0 is the root and node 1 is unused.
struct alignas(32) Link {
    float min[3];
    std::uint32_t below; ///< first child, or leaf_bit and the node of the tree that it came from
    float max[3];
    std::uint32_t above; ///< parent

    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    bool is_leaf() const { return (below & leaf_bit) != 0; }
};
static_assert(sizeof(Link) == 32);

Float4 load(const float* p) { return *reinterpret_cast<const Float4*>(p); }
Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }

/// Bounds; the fourth lanes hold no coordinates.
struct Bounds4 {
    Float4 min, max;

    explicit Bounds4(const Link& link) : min(load(link.min)), max(load(link.max)) {}
    Bounds4(Float4 low, Float4 high) : min(low), max(high) {}
    Bounds4 with(const Bounds4& b) const { return {min4(min, b.min), max4(max, b.max)}; }
    /// Half area: x y + y z + z x. The fourth lane is not touched: it may be slow (denormal).
    float area() const {
        const Float4 d = max - min;
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
    double exact_area() const {
        const Float4 d = max - min;
        const double x = static_cast<double>(d[0]), y = static_cast<double>(d[1]),
                     z = static_cast<double>(d[2]);
        return x * y + y * z + z * x;
    }
    bool same(const Bounds4& b) const {
        const Int4 equal = (min == b.min) & (max == b.max);
        return (equal[0] & equal[1] & equal[2]) != 0;
    }
};

struct Move {
    float gain;
    std::uint32_t node, target; ///< `node` becomes the sibling of what is at `target`
};

struct Waiting {
    float most; ///< no place below gains more
    float left; ///< gain before the place itself is paid for
    std::uint32_t below;
};

/// Levels that a search climbs, and pairs of siblings that it opens: what bounds the time on trees
/// that are chains.
constexpr int climb_limit = 64;
constexpr int visit_limit = 256;

class Reinsertion {
  public:
    Reinsertion(const Tree& tree, const Executor& executor);
    /// Whether any node was moved.
    bool pass(double share);
    Tree finish() const;

  private:
    Move search(std::uint32_t node, std::vector<Waiting>& stack) const;
    bool apply(std::uint32_t node, std::uint32_t target);
    double gain_of(std::uint32_t node, std::uint32_t target, std::uint32_t& common);
    void put(std::uint32_t to, const Link& content);
    void refit(std::uint32_t from, std::uint32_t end);

    Bounds4 bounds(std::uint32_t i) const { return Bounds4(links_[i]); }
    void set_bounds(std::uint32_t i, const Bounds4& b) {
        for (int k = 0; k < 3; ++k) {
            links_[i].min[k] = b.min[k];
            links_[i].max[k] = b.max[k];
        }
    }

    const Tree& tree_;
    const Executor& executor_;
    Buffer<Link> links_;
    std::vector<std::uint32_t> marks_; ///< of gain_of: which call saw the node last
    std::uint32_t mark_ = 0;
};

/// Coordinates scaled by a power of two so that the widest extent lies near 1: then no area over-
/// or underflows that matters. They serve to choose; the boxes of the result are the old ones.
Reinsertion::Reinsertion(const Tree& tree, const Executor& executor)
    : tree_(tree), executor_(executor), links_(2 * tree.size()), marks_(2 * tree.size(), 0) {
    double extent = 0;
    for (int k = 0; k < 3; ++k)
        extent = std::max(extent, static_cast<double>(tree.nodes[0].box.max[k]) -
                                      static_cast<double>(tree.nodes[0].box.min[k]));
    const double scale = extent > 0 ? std::exp2(-std::ilogb(extent)) : 1;

    // The k-th inner node in depth-first order has the pair k + 1 for its children: node i, with s
    // leaves before it, has i - s inner nodes before it.
    std::vector<std::uint32_t> place(tree.nodes.size());
    place[0] = 0;
    links_[1] = {{0, 0, 0}, Link::leaf_bit, {0, 0, 0}, 0};
    links_[0].above = 0;
    for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
        const TreeNode& node = tree.nodes[i];
        Link& link = links_[place[i]];
        for (int k = 0; k < 3; ++k) {
            link.min[k] = static_cast<float>(static_cast<double>(node.box.min[k]) * scale);
            link.max[k] = static_cast<float>(static_cast<double>(node.box.max[k]) * scale);
        }
        if (node.count == 1) {
            link.below = Link::leaf_bit | i;
            continue;
        }
        link.below = 2 * (i - node.first + 1);
        place[Tree::left(i)] = link.below;
        place[tree.right(i)] = link.below + 1;
        links_[link.below].above = links_[link.below + 1].above = place[i];
    }
}

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
            if (at.most <= best.gain)
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
            if (n == 2 && next[0].most > next[1].most)
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

bool Reinsertion::pass(double share) {
    // Sorted by powers of two of the area, the largest first, and else in the order in which they
    // lie: neighbours search the same part of the tree.
    const std::size_t n_nodes = links_.size() - 2;
    std::vector<std::uint8_t> keys(n_nodes);
    std::array<std::size_t, 257> starts{};
    for (std::size_t i = 0; i < n_nodes; ++i) {
        const float area = bounds(static_cast<std::uint32_t>(i + 2)).area();
        keys[i] = static_cast<std::uint8_t>(255 - (std::bit_cast<std::uint32_t>(area) >> 23));
        ++starts[keys[i] + std::size_t{1}];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::uint32_t> nodes(n_nodes);
    for (std::size_t i = 0; i < n_nodes; ++i)
        nodes[starts[keys[i]]++] = static_cast<std::uint32_t>(i + 2);
    const auto n = static_cast<std::size_t>(std::ceil(share * static_cast<double>(n_nodes)));

    constexpr std::size_t batch = 1024, chunk = 64;
    std::vector<Move> moves(batch);
    bool moved = false;
    for (std::size_t first = 0; first < n; first += batch) {
        const std::size_t size = std::min(batch, n - first);
        executor_.for_each((size + chunk - 1) / chunk, [&](std::size_t c) {
            std::vector<Waiting> stack;
            for (std::size_t i = c * chunk; i < std::min(size, (c + 1) * chunk); ++i)
                moves[i] = search(nodes[first + i], stack);
        });
        const auto end =
            std::remove_if(moves.begin(), moves.begin() + static_cast<std::ptrdiff_t>(size),
                           [](const Move& m) { return !(m.gain > 0); });
        std::sort(moves.begin(), end, [](const Move& a, const Move& b) {
            return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
        });
        for (auto it = moves.begin(); it != end; ++it)
            moved |= apply(it->node, it->target);
    }
    return moved;
}

/// The links in depth-first order, as the canonical tree wants them.
Tree Reinsertion::finish() const {
    Tree made(tree_.size());
    made.is_split = tree_.is_split;
    std::vector<std::uint32_t> open{0};
    std::uint32_t slot = 0;
    for (std::uint32_t i = 0; !open.empty(); ++i) {
        const Link& link = links_[open.back()];
        open.pop_back();
        TreeNode& node = made.nodes[i];
        node.first = slot;
        if (link.is_leaf()) {
            const TreeNode& old = tree_.nodes[link.below & ~Link::leaf_bit];
            node.box = old.box;
            node.count = 1;
            made.order[slot++] = tree_.order[old.first];
        } else {
            node.count = 0;
            open.push_back(link.below + 1);
            open.push_back(link.below);
        }
    }
    // Backwards, children first. The right child of an inner node is the root of the subtree that
    // follows the left one, whose count is known by then.
    for (std::size_t i = made.nodes.size(); i-- > 0;) {
        TreeNode& node = made.nodes[i];
        if (node.count != 0)
            continue;
        const TreeNode& left = made.nodes[Tree::left(i)];
        const TreeNode& right = made.nodes[made.right(i)];
        node.count = left.count + right.count;
        node.box = merge(left.box, right.box);
    }
    return made;
}

} // namespace

void ReinsertionStage::improve(Tree& tree, const Executor& executor) const {
    if (tree.size() < 3 || passes < 1)
        return;
    Reinsertion work(tree, executor);
    for (int i = 0; i < static_cast<int>(passes); ++i)
        if (!work.pass(share))
            break;
    tree = work.finish();
}

StageEntry reinsertion_stage() { return stage_entry<ReinsertionStage>(); }

} // namespace boxwood
