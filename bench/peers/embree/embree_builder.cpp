#include "bench/peers/answering.h"
#include "bench/peers/embree/embree_handles.h"
#include "bench/peers/tree_peers.h"
#include "bench/tasks/tree_answers.h"

#include <tbb/task_arena.h>

#include <array>
#include <new>
#include <vector>

namespace boxwood::bench {
namespace {

/// As small as the library's tutorial has them: a leaf has null children.
struct Node {
    std::array<Node*, 2> children;
};
struct Inner : Node {
    std::array<RTCBounds, 2> bounds;
};
struct Leaf : Node {
    RTCBuildPrimitive primitive;
};

void* create_inner(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return ::new (rtcThreadLocalAlloc(allocator, sizeof(Inner), 16)) Inner;
}
void set_children(void* node, void** children, unsigned n, void*) {
    for (unsigned i = 0; i < n; ++i)
        static_cast<Inner*>(node)->children[i] = static_cast<Node*>(children[i]);
}
void set_bounds(void* node, const RTCBounds** bounds, unsigned n, void*) {
    for (unsigned i = 0; i < n; ++i)
        static_cast<Inner*>(node)->bounds[i] = *bounds[i];
}
void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives,
                  std::size_t, void*) {
    Leaf* const leaf = ::new (rtcThreadLocalAlloc(allocator, sizeof(Leaf), 32)) Leaf;
    leaf->children = {};
    leaf->primitive = primitives[0];
    return static_cast<Node*>(leaf);
}
/// Of a box both sides of a plane.
void split_box(const RTCBuildPrimitive* p, unsigned axis, float at, RTCBounds* left,
               RTCBounds* right, void*) {
    *left = *right = {p->lower_x, p->lower_y, p->lower_z, 0, p->upper_x, p->upper_y, p->upper_z, 0};
    (&left->upper_x)[axis] = at;
    (&right->lower_x)[axis] = at;
}

Box box_of(const RTCBuildPrimitive& p) {
    return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
}

class BuildBvh final : public Contender {
  public:
    BuildBvh(const Job& job, RTCBuildQuality quality)
        : n_(job.scene->boxes.size()), quality_(quality), device_(make_device(job)),
          arena_(static_cast<int>(job.threads)), bvh_(rtcNewBVH(device_.get())) {
        const auto item = [&](std::size_t i) { return static_cast<unsigned>(i); };
        for (std::size_t i = 0; i < n_; ++i) {
            const Box& box = job.scene->boxes[i];
            boxes_.push_back(
                {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, item(i)});
        }
        spoilt_.resize(quality == RTC_BUILD_QUALITY_HIGH ? 2 * n_ : n_);
    }

    void build() override {
        if (n_ == 0)
            return;
        std::copy(boxes_.begin(), boxes_.end(), spoilt_.begin());
        RTCBuildArguments args = rtcDefaultBuildArguments();
        args.buildQuality = quality_;
        args.maxBranchingFactor = 2;
        args.maxDepth = 1024;
        args.maxLeafSize = 1;
        args.bvh = bvh_.get();
        args.primitives = spoilt_.data();
        args.primitiveCount = n_;
        args.primitiveArrayCapacity = spoilt_.size();
        args.createNode = create_inner;
        args.setNodeChildren = set_children;
        args.setNodeBounds = set_bounds;
        args.createLeaf = create_leaf;
        args.splitPrimitive = quality_ == RTC_BUILD_QUALITY_HIGH ? split_box : nullptr;
        arena_.execute([&] { root_ = static_cast<Node*>(rtcBuildBVH(&args)); });
        throw_if_failed(device_.get(), "rtcBuildBVH");
    }
    /// Its tree as ours, node by node.
    void query(Answers& answers) override {
        tree_ = n_ == 0 ? Tree() : converted();
        dynamic_cast<TreeAnswers&>(answers).tree = &tree_;
    }
    /// After a query.
    std::optional<StructureInfo> structure() const override {
        const std::size_t inner = n_ == 0 ? 0 : tree_.size() - 1;
        return StructureInfo{inner * sizeof(Inner) + tree_.size() * sizeof(Leaf), &tree_};
    }

  private:
    Tree converted() const {
        std::vector<const Node*> nodes, waiting{root_};
        while (!waiting.empty()) {
            const Node* const node = waiting.back();
            waiting.pop_back();
            nodes.push_back(node);
            if (node->children[0]) {
                waiting.push_back(node->children[1]);
                waiting.push_back(node->children[0]);
            }
        }
        Tree tree((nodes.size() + 1) / 2);
        tree.is_split = tree.size() > n_;
        // From the last node: children come before their parents.
        auto slot = static_cast<std::uint32_t>(tree.size());
        for (std::size_t i = nodes.size(); i-- > 0;) {
            if (!nodes[i]->children[0]) {
                const RTCBuildPrimitive& p = static_cast<const Leaf*>(nodes[i])->primitive;
                tree.order[--slot] = p.primID;
                tree.nodes[i] = {box_of(p), slot, 1};
                continue;
            }
            const TreeNode& left = tree.nodes[i + 1];
            const TreeNode& right = tree.nodes[i + 2 * std::size_t{left.count}];
            tree.nodes[i] = {merge(left.box, right.box), left.first, left.count + right.count};
        }
        return tree;
    }

    std::size_t n_;
    RTCBuildQuality quality_;
    Device device_;
    tbb::task_arena arena_;
    Owned<RTCBVH, rtcReleaseBVH> bvh_;
    std::vector<RTCBuildPrimitive> boxes_, spoilt_; ///< a build changes its primitives
    Node* root_ = nullptr;
    Tree tree_;
};

ContenderEntry build_bvh(RTCBuildQuality quality) {
    ContenderEntry e;
    e.name = fmt::format("embree.rtc_build_bvh.{}", word_of(quality));
    e.library = "embree";
    e.summary = fmt::format("Embree's rtcBuildBVH, build quality {}", word_of(quality));
    e.notes = "two children a node, one box a leaf; nodes from the thread's own allocator as in "
              "the tutorial; a build overwrites its primitives, so each begins with a copy";
    if (quality == RTC_BUILD_QUALITY_HIGH)
        e.notes += "; splits boxes, with room for as many parts again";
    e.precision = "f32";
    e.runs_on = RunsOn::tbb;
    e.answers = {answering<BuildBvh>("build", quality)};
    return e;
}

} // namespace

std::vector<ContenderEntry> embree_trees() {
    std::vector<ContenderEntry> all;
    for (const RTCBuildQuality quality : build_qualities)
        all.push_back(build_bvh(quality));
    return all;
}

} // namespace boxwood::bench
