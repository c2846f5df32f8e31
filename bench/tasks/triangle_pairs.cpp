/// Every unordered pair of a scene's triangles that share a point: a tree over their boxes, its
/// self-pairs, and a kernel for each candidate.

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/pairs_on_device.h"
#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/pair_truth.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "trees/queries/touching_pairs.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood::bench {
namespace {

template <TriangleKernel K> class TouchingTriangles final : public TreeContender {
  public:
    using TreeContender::TreeContender;

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        AppendPairs append(pairs);
        TouchingPairs<K> touching(scene_.mesh, append);
        layout_->self_pairs(*executor_, touching);
    }

    std::optional<Work> counted_query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        tiers_ = {};
        AppendPairs append(pairs);
        TouchingPairs<K> touching(scene_.mesh, append, &tiers_);
        Work work = layout_->self_pairs_counted(touching);
        work.triangle_tests = work.answers; // every candidate
        work.answers = pairs.size();
        return work;
    }

    std::vector<NamedCount> more_counts() const override {
        return {{"tier_0", tiers_.decided[0]},
                {"tier_1", tiers_.decided[1]},
                {"tier_2", tiers_.decided[2]},
                {"tier_3", tiers_.decided[3]},
                {"undecided", tiers_.undecided}};
    }

  private:
    TierCounts tiers_;
};

std::unique_ptr<Contender> make_touching(const Job& job, BuildFunction build,
                                         const LayoutEntry& layout, std::string_view kernel) {
    std::unique_ptr<Contender> made;
    with_kernel<TriangleKernels>(kernel, [&]<class K>(std::type_identity<K>) {
        made = std::make_unique<TouchingTriangles<K>>(job, std::move(build), layout);
    });
    return made;
}

class TouchingTrianglesOnDevice final : public DeviceBoxes {
  public:
    TouchingTrianglesOnDevice(const Job& job, DeviceBuilder builder, DeviceAccuracy accuracy)
        : DeviceBoxes(job, builder), accuracy_(accuracy) {}

    /// Of each candidate its numbers and two triangles are read.
    std::vector<NamedCount> more_counts() const override {
        std::vector<NamedCount> counts = DeviceBoxes::more_counts();
        counts.push_back({"candidates", n_candidates_});
        counts.push_back(
            {"query_bytes", scene_.boxes.size() * sizeof(Box) +
                                n_candidates_ * (2 * sizeof(Pair) + 2 * sizeof(Triangle<float>)) +
                                found_.size() * sizeof(Pair)});
        return counts;
    }

  protected:
    std::uint64_t upload() override {
        const std::uint64_t bytes = DeviceBoxes::upload();
        vertices_ = DeviceArray<Vec3<float>>(scene_.mesh.vertices, options_.place);
        corners_ = DeviceArray<std::array<std::uint32_t, 3>>(scene_.mesh.triangles, options_.place);
        return bytes + vertices_.size_bytes() + corners_.size_bytes();
    }
    void query_there() override {
        const DeviceArray<Pair> candidates =
            is_resident() ? bvh_->unordered_self_pairs() : bvh_->self_pairs_on_device();
        n_candidates_ = candidates.size();
        const DeviceTriangles triangles{std::as_const(vertices_).span(),
                                        std::as_const(corners_).span()};
        found_ = touching_pairs(triangles, triangles, candidates.span(), accuracy_, options_.place);
    }
    std::uint64_t download(Answers& answers) override {
        found_.read(list_of<Pair>(answers));
        return found_.size_bytes();
    }

  private:
    DeviceAccuracy accuracy_;
    DeviceArray<Vec3<float>> vertices_;
    DeviceArray<std::array<std::uint32_t, 3>> corners_;
    DeviceArray<Pair> found_;
    std::size_t n_candidates_ = 0;
};

/// Meshes are of floats, so that doubles on a device see what those of the CPU do.
Answering::Make touching_there(const Choice& choice) {
    const std::optional<DeviceBuilder> builder = device_builder(choice, "binary");
    const std::optional<DeviceAccuracy> accuracy = choice.kernel == GuigueDevillersF64::name
                                                       ? DeviceAccuracy::plain_in_doubles
                                                       : device_accuracy(choice.kernel);
    if (!builder || !accuracy)
        return nullptr;
    return [builder = *builder, accuracy = *accuracy](const Job& job) {
        return std::make_unique<TouchingTrianglesOnDevice>(job, builder, accuracy);
    };
}

/// What the wrong answers of the whole query come to, as a row of its kernel, too.
class TouchingTruth final : public Truth {
  public:
    TouchingTruth(const Scene& scene, std::string_view task, unsigned threads)
        : truth_(make_pair_truth(scene, PairsOf::triangles, threads)), task_(task) {}

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        Judgement judgement = truth_->judge(answers, contender);
        const results::Check& check = judgement.check;
        results::KernelRow& row = judgement.kernel.emplace();
        row.family = "typical";
        row.panel = to_string(Panel::generic);
        row.task = task_;
        row.kernel = contender.kernel.empty() ? contender.name : contender.kernel;
        row.promise = to_string(contender.promise);
        row.n = row.tier_0 = check.n_expected;
        row.false_pos = check.extra;
        row.false_neg = check.missing;
        row.witness = check.witness;
        return judgement;
    }

  private:
    std::unique_ptr<Truth> truth_;
    std::string task_;
};

class TrianglePairs final : public PairAnswers<TreeTask> {
  public:
    std::string_view name() const override { return "triangle_pairs"; }
    std::string title() const override { return "touching triangles"; }
    std::string_view summary() const override {
        return "every unordered pair of the scene's triangles that share a point";
    }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = PairAnswers::keys();
        all.push_back("kernels");
        return all;
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return std::make_unique<TouchingTruth>(scene, name(), threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"pairs", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    std::string_view mesh_is_for() const override { return "test"; }
    std::vector<Choice> variants(const BlockReader& block, const Choice& choice) const override {
        std::vector<Choice> all;
        for (const std::string& kernel : block.kernels(names_of(triangle_kernels()), {"all"})) {
            all.push_back(choice);
            all.back().kernel = kernel;
        }
        return all;
    }
    Way way(const Choice& choice) const override {
        const KernelInfo& kernel =
            entry_named(choice.kernel, triangle_kernels(), "triangle kernel");
        return {
            "self_pairs",
            choice.kernel,
            kernel.promise,
            [name = choice.kernel](const Job& job, BuildFunction build, const LayoutEntry& layout) {
                return make_touching(job, std::move(build), layout, name);
            },
            Query::self_pairs,
            {},
            touching_there(choice)};
    }
};

} // namespace

const Task& triangle_pairs_task() {
    static const TrianglePairs task;
    return task;
}

} // namespace boxwood::bench
