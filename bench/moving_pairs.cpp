#include "bench/moving_pairs.h"

#include "bench/ours.h"
#include "bench/truth.h"
#include "scenes/suggest.h"
#include "trees/update.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <stdexcept>

namespace boxwood::bench {
namespace {

class MovingPairs final : public Contender {
  public:
    MovingPairs(const Job& job, std::unique_ptr<Updater> updater)
        : scene_(*job.scene), executor_(make_executor(job.executor, job.threads)),
          updater_(std::move(updater)) {}

    void build() override {
        updater_->start(scene_.boxes, *executor_);
        placed_ = rebuilds_ = 0;
    }
    void update(std::size_t frame) override {
        updater_->update(scene_.frames[frame].boxes, scene_.frames[frame].moved, *executor_);
        placed_ += updater_->last_step().placed;
        rebuilds_ += updater_->last_step().rebuilt;
    }
    void query(Answers& answers) override {
        updater_->self_pairs(*executor_, sink_.to(answers.pairs));
    }
    std::optional<Work> counted_query(Answers& answers) override {
        return updater_->self_pairs_counted(sink_.to(answers.pairs));
    }
    std::vector<NamedCount> more_counts() const override {
        return {{"items_placed", placed_}, {"rebuilds", rebuilds_}};
    }
    std::optional<StructureInfo> structure() const override {
        return StructureInfo{updater_->bytes(), nullptr};
    }

  private:
    const Scene& scene_;
    std::unique_ptr<Executor> executor_;
    std::unique_ptr<Updater> updater_;
    PairsInto sink_;
    std::uint64_t placed_ = 0, rebuilds_ = 0; ///< in all frames since the build
};

double ns_of(const timespec& t) {
    return static_cast<double>(t.tv_sec) * 1e9 + static_cast<double>(t.tv_nsec);
}

/// Both clocks of one moment.
struct Moment {
    std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
    double cpu_ns = [] {
        timespec t{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
        return ns_of(t);
    }();
    double wall_since(const Moment& before) const {
        return std::chrono::duration<double, std::nano>(wall - before.wall).count();
    }
};

} // namespace

ContenderEntry moving_contender(const BuilderChoice& policy) {
    const UpdateEntry* update = find_update(policy.name);
    if (!update) {
        std::vector<std::string_view> known;
        for (const UpdateEntry& entry : updates())
            known.push_back(entry.name);
        throw std::invalid_argument(unknown_word("update policy", policy.name, known));
    }
    update->make(policy.settings); // throws for a bad setting

    ContenderEntry entry;
    entry.library = "boxwood";
    entry.is_peer = false;
    entry.precision = "f32";
    entry.builder = word_with_settings(policy.name, policy.settings);
    entry.layout = "packed";
    entry.traversal = "self_pairs";
    entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
    entry.summary = update->summary;
    entry.notes = "update: the frame's boxes and the list of those that moved; answers in the same "
                  "order for any number of threads";
    entry.params_json = settings_json(policy.settings);
    entry.unsupported = [](const Job& job) -> std::optional<std::string> {
        if (job.ask != Ask::moving_pairs)
            return "answers moving_pairs only";
        if (job.executor == "serial" && job.threads != 1)
            return "the executor serial has one thread";
        return std::nullopt;
    };
    entry.make = [update, settings = policy.settings](const Job& job) {
        return std::make_unique<MovingPairs>(job, update->make(settings));
    };
    return entry;
}

void play(Contender& contender, const Scene& scene, Answers& answers, std::span<FrameTime> times,
          FunctionRef<void(std::size_t frame)> after_frame) {
    for (std::size_t frame = 0; frame < scene.frames.size(); ++frame) {
        const Moment start;
        contender.update(frame);
        const Moment updated;
        contender.query(answers);
        const Moment end;
        FrameTime& time = times[frame];
        time.update_ns += updated.wall_since(start);
        time.query_ns += end.wall_since(updated);
        time.update_cpu_ns += updated.cpu_ns - start.cpu_ns;
        time.query_cpu_ns += end.cpu_ns - updated.cpu_ns;
        time.pairs = answers.pairs.size();
        after_frame(frame);
    }
}

std::uint64_t unordered_hash(std::span<const Pair> pairs) {
    std::uint64_t sum = pairs.size();
    for (const Pair p : pairs) {
        std::uint64_t x = (std::uint64_t{p.a} << 32 | p.b) + 0x9e3779b97f4a7c15u;
        x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u; // splitmix64
        x = (x ^ x >> 27) * 0x94d049bb133111ebu;
        sum += x ^ x >> 31;
    }
    return sum;
}

MovingTruth::MovingTruth(const Scene& scene, unsigned threads) {
    for (const Frame& frame : scene.frames)
        expected_.push_back(true_pairs(frame.boxes, threads));
}

void MovingTruth::check(std::size_t frame, const Answers& answers, results::Check& check) const {
    const std::vector<Pair>& expected = expected_[frame];
    std::vector<Pair> got = answers.pairs;
    std::ranges::sort(got);
    std::vector<Pair> missing, extra; // a pair told twice is extra once
    std::ranges::set_difference(expected, got, std::back_inserter(missing));
    std::ranges::set_difference(got, expected, std::back_inserter(extra));
    if (frame == 0) {
        check.status = "exact";
        check.oracle = "sweep";
    }
    check.n_checked += got.size();
    check.n_got += got.size();
    check.n_expected += expected.size();
    check.missing += missing.size();
    check.extra += extra.size();
    if (missing.empty() && extra.empty())
        return;
    check.status = "wrong";
    if (check.witness.empty()) {
        const Pair p = missing.empty() ? extra[0] : missing[0];
        check.witness = fmt::format("frame {}: {} ({},{})", frame,
                                    missing.empty() ? "extra" : "missing", p.a, p.b);
    }
}

} // namespace boxwood::bench
