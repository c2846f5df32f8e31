#include "bench/tasks/triangle_pairs.h"

#include "bench/tasks/tree_contender.h"
#include "kernels/registry.h"
#include "trees/queries/touching_pairs.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood::bench {
namespace {

template <TriangleKernel K> class TrianglePairs final : public TreeContender {
  public:
    using TreeContender::TreeContender;

    void query(Answers& answers) override {
        answers.pairs.clear();
        AppendPairs append(answers.pairs);
        TouchingPairs<K> touching(scene_.mesh, append);
        layout_->self_pairs(*executor_, touching);
    }

    std::optional<Work> counted_query(Answers& answers) override {
        answers.pairs.clear();
        tiers_ = {};
        AppendPairs append(answers.pairs);
        TouchingPairs<K> touching(scene_.mesh, append, &tiers_);
        Work work = layout_->self_pairs_counted(touching);
        work.triangle_tests = work.answers; // every candidate
        work.answers = answers.pairs.size();
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

} // namespace

std::unique_ptr<Contender> make_triangle_pairs(const Job& job, BuildFunction build,
                                               const LayoutEntry& layout, std::string_view kernel) {
    std::unique_ptr<Contender> made;
    with_kernel<TriangleKernels>(kernel, [&]<class K>(std::type_identity<K>) {
        made = std::make_unique<TrianglePairs<K>>(job, std::move(build), layout);
    });
    if (!made)
        throw std::invalid_argument("no triangle kernel " + std::string(kernel));
    return made;
}

} // namespace boxwood::bench
