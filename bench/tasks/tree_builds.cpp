#include "bench/tasks/tree_builds.h"

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
    /// Nothing is asked of the tree.
    void query(Answers&) override {}
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

} // namespace

ContenderEntry tree_contender(const Choice& choice) {
    ContenderEntry entry;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.precision = "f32";
    entry.builder = word_with_settings(choice.builder, choice.settings);
    entry.name = entry.builder + ".tree";
    const BuilderEntry* builder =
        find_builder(std::string_view(choice.builder).substr(0, choice.builder.find('+')));
    BuildFunction build = make_builder(choice.builder, choice.settings);
    entry.summary = builder->summary;
    entry.notes = "build: boxes to the canonical tree, after the one before it is freed; the same "
                  "tree for any number of threads";
    entry.params_json = settings_json(choice.settings);
    entry.unsupported = [](const Job& job) -> std::optional<std::string> {
        if (job.executor == "serial" && job.threads != 1)
            return "the executor serial has one thread";
        return std::nullopt;
    };
    entry.make = [build = std::move(build)](const Job& job) -> std::unique_ptr<Contender> {
        return std::make_unique<TreeBuild>(job, build);
    };
    return entry;
}

results::Check check_tree(const Contender& contender, const Scene& scene) {
    const Tree& tree = *contender.structure().value().tree;
    const auto fault = tree.is_split ? split_fault(tree, scene.boxes) : validate(tree, scene.boxes);
    results::Check check;
    check.oracle = "validate";
    check.n_checked = tree.nodes.size();
    check.n_expected = scene.boxes.size();
    check.n_got = tree.size();
    check.status = fault ? "wrong" : "exact";
    check.witness = fault.value_or("");
    check.result_hash = XXH3_64bits(tree.order.data(), tree.order.bytes());
    return check;
}

} // namespace boxwood::bench
