#include "bench/tasks/moving_pairs.h"

#include "bench/truth/column_sweep.h"
#include "bench/tasks/ours.h"
#include "kernels/suggest.h"
#include "trees/dynamic/update.h"

#include <fmt/format.h>

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
    void update(const Frame& frame) override {
        updater_->update(frame.boxes, frame.moved, *executor_);
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
        return StructureInfo{updater_->bytes(), nullptr, updater_->sah()};
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

void play_frame(Contender& contender, const Frame& frame, Answers& answers, FrameTime& time) {
    const Moment start;
    contender.update(frame);
    const Moment updated;
    contender.query(answers);
    const Moment end;
    time.update_ns += updated.wall_since(start);
    time.query_ns += end.wall_since(updated);
    time.update_cpu_ns += updated.cpu_ns - start.cpu_ns;
    time.query_cpu_ns += end.cpu_ns - updated.cpu_ns;
    time.pairs = answers.pairs.size();
}

FrameCount count_frame(Contender& contender, Answers& answers) {
    FrameCount count;
    if (const std::optional<Work> work = contender.counted_query(answers))
        count.box_tests = work->box_tests;
    if (const std::optional<StructureInfo> structure = contender.structure())
        count.sah = structure->sah;
    return count;
}

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
        if (job.task != Ask::moving_pairs)
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

void play(Contender& contender, Frames& frames, Answers& answers, std::span<FrameTime> times,
          FunctionRef<void(std::size_t index, const Frame& frame)> after_frame) {
    frames.rewind();
    for (std::size_t index = 0; const Frame* const frame = frames.next(); ++index) {
        play_frame(contender, *frame, answers, times[index]);
        after_frame(index, *frame);
    }
}

MovingTruth::MovingTruth(Frames& frames, unsigned threads, std::function<bool(Pair)> is_left_out)
    : threads_(threads), is_left_out_(std::move(is_left_out)) {
    frames.rewind();
    while (const Frame* const frame = frames.next()) {
        const ColumnSweep sweep(frame->boxes, threads_);
        expected_.push_back(is_left_out_ ? sweep.digest(is_left_out_) : sweep.digest());
    }
    frames.rewind();
}

void MovingTruth::check(std::size_t index, const Frame& frame, const Answers& answers,
                        results::Check& check) const {
    const PairsDigest& expected = expected_[index];
    if (index == 0) {
        check.status = "exact";
        check.oracle = "sweep";
    }
    check.n_checked += answers.pairs.size();
    check.n_got += answers.pairs.size();
    check.n_expected += expected.count;
    if (digest_of(answers.pairs) == expected)
        return;
    std::vector<Pair> right = ColumnSweep(frame.boxes, threads_).pairs();
    if (is_left_out_)
        std::erase_if(right, is_left_out_);
    const PairsDifference wrong = difference(right, answers.pairs);
    check.missing += wrong.missing;
    check.extra += wrong.extra;
    check.status = "wrong";
    if (check.witness.empty())
        check.witness = fmt::format("frame {}: {}", index, wrong.witness);
}

} // namespace boxwood::bench
