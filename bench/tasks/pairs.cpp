/// Every unordered overlapping pair of a scene's boxes.

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/pair_truth.h"
#include "trees/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace boxwood::bench {
namespace {

class SelfPairs final : public TreeContender {
  public:
    using TreeContender::TreeContender;
    void query(Answers& answers) override { layout_->self_pairs(*executor_, pairs_.to(answers)); }
    std::optional<Work> counted_query(Answers& answers) override {
        return layout_->self_pairs_counted(pairs_.to(answers));
    }

  private:
    PairsInto pairs_;
};

class SelfPairsByFrontDoor final : public Contender {
  public:
    SelfPairsByFrontDoor(const Job& job, BuildFunction build, const LayoutEntry& layout)
        : boxes_(job.scene->boxes),
          options_(front_door_options<BvhOptions>(job, std::move(build), layout)) {}

    void build() override {
        bvh_.reset();
        bvh_.emplace(boxes_, options_);
    }
    void query(Answers& answers) override { bvh_->self_pairs(pairs_.to(answers)); }
    std::optional<Work> counted_query(Answers& answers) override {
        return bvh_->layout().self_pairs_counted(pairs_.to(answers));
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{.bytes = bvh_->bytes()};
    }

  private:
    Boxes boxes_;
    BvhOptions options_;
    std::optional<Bvh> bvh_;
    PairsInto pairs_;
};

class SelfPairsOnDevice final : public DeviceBoxes {
  public:
    using DeviceBoxes::DeviceBoxes;

    /// Each box is read and each pair written once.
    std::vector<NamedCount> more_counts() const override {
        std::vector<NamedCount> counts = DeviceBoxes::more_counts();
        counts.push_back(
            {"query_bytes", scene_.boxes.size() * sizeof(Box) + found_.size() * sizeof(Pair)});
        return counts;
    }

  protected:
    void query_there() override {
        found_ = is_resident() ? bvh_->unordered_self_pairs() : bvh_->self_pairs_on_device();
    }
    std::uint64_t download(Answers& answers) override {
        found_.read(list_of<Pair>(answers));
        return found_.size_bytes();
    }

  private:
    DeviceArray<Pair> found_;
};

/// Build and query are a graph each, recorded in the first build, and do what cuda_resident does:
/// the boxes are checked, and the host knows how many pairs there are.
class SelfPairsByGraph final : public DeviceBoxes {
  public:
    using DeviceBoxes::DeviceBoxes;

    std::vector<NamedCount> more_counts() const override {
        std::vector<NamedCount> counts = DeviceBoxes::more_counts();
        counts.push_back(
            {"query_bytes", scene_.boxes.size() * sizeof(Box) + n_found_ * sizeof(Pair)});
        return counts;
    }

  protected:
    void build_there() override {
        if (build_) {
            build_->launch();
            bvh_->check();
            return;
        }
        DeviceBoxes::build_there();
        const std::uint64_t n = bvh_->self_pair_count();
        found_ = DeviceArray<Pair>(n + n / 8, place());
        count_ = DeviceArray<std::uint64_t>(1, place());
        build_.emplace(place(), [this] { bvh_->enqueue_rebuild(std::as_const(boxes_).span()); });
        query_.emplace(place(),
                       [this] { bvh_->enqueue_self_pairs(found_.span(), count_.span().data); });
    }
    void query_there() override {
        query_->launch();
        n_found_ = count_.to_host().at(0);
        if (n_found_ > found_.size())
            throw std::logic_error("a graph found more pairs than the plain build");
    }
    std::uint64_t download(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        found_.read(pairs);
        pairs.resize(n_found_);
        return found_.size_bytes();
    }

  private:
    DeviceArray<Pair> found_;
    DeviceArray<std::uint64_t> count_;
    std::uint64_t n_found_ = 0;
    std::optional<DeviceGraph> build_, query_;
};

/// A family of boxes comes with its number of pairs, and each contender is judged as a kernel.
class KnownPairsTruth final : public Truth {
  public:
    KnownPairsTruth(const Scene& scene, unsigned threads)
        : truth_(make_pair_truth(scene, PairsOf::all_boxes, threads)),
          known_(std::get<BoxCases>(scene.cases).n_pairs),
          calls_(std::max<std::uint64_t>(known_, scene.boxes.size())) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        Judgement judgement = truth_->judge(answers, contender);
        if (judgement.check.n_expected != known_)
            throw std::logic_error(fmt::format("brute force finds {} pairs, {} are known",
                                               judgement.check.n_expected, known_));
        judgement.calls = calls_;
        results::KernelRow& row = judgement.kernel.emplace();
        row.n = row.tier_0 = calls_;
        row.false_pos = judgement.check.extra;
        row.false_neg = judgement.check.missing;
        return judgement;
    }

  private:
    std::unique_ptr<Truth> truth_;
    std::uint64_t known_, calls_; ///< calls: pairs and boxes, for a time to be divided by
};

class Pairs final : public PairAnswers<TreeTask> {
  public:
    std::string_view name() const override { return "pairs"; }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = TreeTask::keys();
        all.push_back("front_door");
        return all;
    }
    std::string title() const override { return "overlapping pairs"; }
    std::string_view summary() const override {
        return "every unordered overlapping pair of the scene's boxes";
    }
    bool fits(const Cases& cases) const override { return std::holds_alternative<BoxCases>(cases); }
    std::vector<ContenderEntry> contenders_on_cases() const override {
        std::vector<ContenderEntry> all;
        for (const BuilderEntry& builder : builders())
            for (const LayoutEntry& layout : layouts()) {
                all.push_back(contender({.builder = std::string(builder.name),
                                         .settings = {},
                                         .layout = std::string(layout.name)}));
                all.back().promise = Promise::exact;
            }
        return all;
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        if (fits(scene.cases))
            return std::make_unique<KnownPairsTruth>(scene, threads);
        return make_pair_truth(scene, PairsOf::all_boxes, threads);
    }

  protected:
    Way way(const Choice& choice) const override {
        return {.traversal = "self_pairs",
                .make = maker<SelfPairs>(),
                .query = Query::self_pairs,
                .make_on_device = on_device<SelfPairsOnDevice>(choice),
                .make_by_graph = on_device<SelfPairsByGraph>(choice),
                .make_by_front_door = maker<SelfPairsByFrontDoor>()};
    }
};

} // namespace

const Task& pairs_task() {
    static const Pairs task;
    return task;
}

} // namespace boxwood::bench
