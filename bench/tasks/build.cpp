/// A binary tree of the boxes and nothing else: builders alone.

#include "bench/tasks/detail/tree_task.h"
#include "bench/tasks/tree_answers.h"
#include "bench/truth/truth.h"
#include "trees/inspect/validate.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace boxwood::bench {
namespace {

class TreeBuild final : public Contender {
  public:
    TreeBuild(const Job& job, BuildFunction build)
        : scene_(*job.scene), executor_(make_executor(job.executor, job.threads)),
          build_(std::move(build)) {}

    void build() override {
        tree_ = {};
        tree_ = build_(scene_.boxes, *executor_);
    }
    void query(Answers& answers) override { dynamic_cast<TreeAnswers&>(answers).tree = &tree_; }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{tree_.nodes.bytes() + tree_.order.bytes(), &tree_};
    }

  private:
    const Scene& scene_;
    std::unique_ptr<Executor> executor_;
    BuildFunction build_;
    Tree tree_;
};

/// What is wrong with a tree whose leaves may hold parts of items.
std::optional<std::string> split_fault(const Tree& tree, Boxes boxes) {
    std::vector<Box> parts(boxes.size());
    std::vector<Box> leaves(tree.size());
    std::vector<std::uint32_t> item_of(tree.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (!tree.is_leaf(i))
            continue;
        const std::uint32_t item = tree.item(i), slot = tree.nodes[i].first;
        if (item >= boxes.size())
            return fmt::format("leaf {} holds the item {} of {}", i, item, boxes.size());
        parts[item].extend(tree.nodes[i].box);
        leaves[slot] = tree.nodes[i].box;
        item_of[slot] = slot;
    }
    for (std::size_t item = 0; item < boxes.size(); ++item)
        if (parts[item] != boxes[item])
            return fmt::format("the parts of item {} do not make up its box", item);
    // Shape and inner boxes: the same tree over its leaves as items.
    Tree whole(tree.size());
    std::ranges::copy(tree.nodes, whole.nodes.begin());
    std::ranges::copy(item_of, whole.order.begin());
    return validate(whole, leaves);
}

/// Whether a tree holds each item in a leaf, and boxes that are exact; in a split tree the parts of
/// each item together as large as its box.
class TreeTruth final : public Truth {
  public:
    explicit TreeTruth(const Scene& scene) : scene_(scene) {}

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        const Tree& tree = *dynamic_cast<const TreeAnswers&>(answers).tree;
        const auto fault =
            tree.is_split ? split_fault(tree, scene_.boxes) : validate(tree, scene_.boxes);
        Judgement judgement;
        judgement.status = fault ? Status::wrong : Status::exact;
        judgement.has_faulty_tree = fault.has_value();
        results::Check& check = judgement.check;
        check.oracle = "validate";
        check.n_checked = tree.nodes.size();
        check.n_expected = scene_.boxes.size();
        check.n_got = tree.size();
        check.witness = fault.value_or("");
        return judgement;
    }

  private:
    const Scene& scene_;
};

/// Contenders "<builder>[_<setting><value>...].tree", whatever the layout.
class Build final : public TreeTask {
  public:
    std::string_view name() const override { return "build"; }
    std::string title() const override { return "tree build"; }
    std::string_view summary() const override {
        return "a binary tree of the boxes and nothing else: builders alone";
    }
    Phases phases() const override { return Phases::build; }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<TreeAnswers>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        const Tree& tree = *dynamic_cast<const TreeAnswers&>(answers).tree;
        return XXH3_64bits(tree.order.data(), tree.order.bytes());
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned) const override {
        return std::make_unique<TreeTruth>(scene);
    }

    ContenderEntry contender(const Choice& choice) const override {
        ContenderEntry entry = TreeTask::contender(choice);
        entry.name = entry.builder + ".tree";
        entry.layout.clear();
        entry.traversal.clear();
        entry.precision = "f32";
        entry.summary = builder_of(choice).summary;
        entry.notes = "build: boxes to the canonical tree, after the one before it is freed; the "
                      "same tree for any number of threads";
        return entry;
    }

  protected:
    Way way(const Choice&) const override {
        return {.traversal = "tree",
                .make = [](const Job& job, BuildFunction build,
                           const LayoutEntry&) -> std::unique_ptr<Contender> {
                    return std::make_unique<TreeBuild>(job, std::move(build));
                },
                .why_not_on_device = "trees are not handed out there to be looked at; pairs times "
                                     "their builds"};
    }
};

} // namespace

const Task& build_task() {
    static const Build task;
    return task;
}

} // namespace boxwood::bench
