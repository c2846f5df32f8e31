#include "bench/running/play.h"

#include <chrono>
#include <ctime>
#include <optional>

namespace boxwood::bench {
namespace {

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
    time.answers = answers.size();
}

} // namespace

FrameCount count_frame(Contender& contender, Answers& answers) {
    FrameCount count;
    if (const std::optional<Work> work = contender.counted_query(answers))
        count.box_tests = work->box_tests;
    if (const std::optional<StructureInfo> structure = contender.structure())
        count.sah = structure->sah;
    return count;
}

void play(Contender& contender, Frames* frames, Answers& answers, std::span<FrameTime> times,
          FunctionRef<void(std::size_t index, const Frame& frame)> after_frame) {
    const Frame none;
    if (frames)
        frames->rewind();
    for (std::size_t index = 0; index < times.size(); ++index) {
        const Frame& frame = frames ? *frames->next() : none;
        play_frame(contender, frame, answers, times[index]);
        after_frame(index, frame);
    }
}

} // namespace boxwood::bench
