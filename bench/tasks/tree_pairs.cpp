/// Every overlapping pair between the first half of a scene's boxes and the rest.

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/halves.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/pair_truth.h"

namespace boxwood::bench {
namespace {

/// A tree over each half of the boxes; the items of the second are numbered from its start, so its
/// half of the pairs is moved by the split afterwards.
class TreePairsContender final : public TreeContender {
  public:
    using TreeContender::TreeContender;
    void build() override {
        layout_.reset();
        other_.reset();
        const Boxes boxes = scene_.boxes;
        layout_ = make_layout(layout_entry_, build_, boxes.first(split_), *executor_, tree_);
        other_ = make_layout(layout_entry_, build_, boxes.subspan(split_), *executor_, tree_);
    }
    void query(Answers& answers) override {
        layout_->tree_pairs(*other_, *executor_, pairs_.to(answers));
        move_second(list_of<Pair>(answers));
    }
    std::optional<Work> counted_query(Answers& answers) override {
        const Work work = layout_->tree_pairs_counted(*other_, pairs_.to(answers));
        move_second(list_of<Pair>(answers));
        return work;
    }
    /// No tree: there are two, and a row of the tree table is about one.
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{layout_->bytes() + other_->bytes(), nullptr};
    }

  private:
    void move_second(std::vector<Pair>& pairs) const {
        for (Pair& pair : pairs)
            pair.b += static_cast<std::uint32_t>(split_);
    }

    std::size_t split_ = tree_pairs_split(scene_.boxes.size());
    std::unique_ptr<AnyLayout> other_;
    PairsInto pairs_;
};

/// Both trees are on the device; the second items are moved on the host.
class TreePairsOnDevice final : public DeviceContender {
  public:
    TreePairsOnDevice(const Job& job, DeviceBuilder builder)
        : DeviceContender(job), boxes_(job.scene->boxes), options_{builder, place()} {}

  protected:
    std::uint64_t upload() override {
        first_ = DeviceArray<Box>(boxes_.first(split_), options_.place);
        second_ = DeviceArray<Box>(boxes_.subspan(split_), options_.place);
        return boxes_.size_bytes();
    }
    void build_there() override {
        bvh_.emplace(std::as_const(first_).span(), options_);
        other_.emplace(std::as_const(second_).span(), options_);
    }
    void query_there() override { found_ = bvh_->pairs_on_device(*other_); }
    std::uint64_t download(Answers& answers) override {
        found_.read(list_of<Pair>(answers));
        return found_.size_bytes();
    }
    void convert(Answers& answers) override {
        for (Pair& pair : list_of<Pair>(answers))
            pair.b += static_cast<std::uint32_t>(split_);
    }

  private:
    Boxes boxes_;
    DeviceBvhOptions options_;
    std::size_t split_ = tree_pairs_split(boxes_.size());
    DeviceArray<Box> first_, second_;
    std::optional<DeviceBvh> bvh_, other_;
    DeviceArray<Pair> found_;
};

class TreePairs final : public PairAnswers<TreeTask> {
  public:
    std::string_view name() const override { return "tree_pairs"; }
    std::string title() const override { return "pairs of two sets"; }
    std::string_view summary() const override {
        return "every overlapping pair between the first half of the boxes and the rest";
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_pair_truth(scene, PairsOf::two_halves, threads);
    }

  protected:
    Way way(const Choice& choice) const override {
        return {.traversal = "tree_pairs",
                .make = maker<TreePairsContender>(),
                .query = Query::tree_pairs,
                .make_on_device = on_device<TreePairsOnDevice>(choice)};
    }
};

} // namespace

const Task& tree_pairs_task() {
    static const TreePairs task;
    return task;
}

} // namespace boxwood::bench
