#include "bench/running/instructions/count.h"

#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/io/output_of.h"
#include "bench/machine/environment.h"
#include "bench/running/calibration.h"
#include "bench/running/play.h"
#include "bench/running/prepare.h"
#include "bench/running/record.h"
#include "bench/tasks/instruction_sets.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

// Requests to callgrind are a few instructions that do nothing where there is none.
#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION
#define CALLGRIND_TOGGLE_COLLECT
#define CALLGRIND_STOP_INSTRUMENTATION
#define CALLGRIND_DUMP_STATS
#define RUNNING_ON_VALGRIND 0
#define BOXWOOD_HAS_NO_VALGRIND
#endif

namespace boxwood::bench {
namespace {

namespace fs = std::filesystem;

#ifdef BOXWOOD_HAS_NO_VALGRIND
constexpr bool has_requests = false;
#else
constexpr bool has_requests = true;
#endif

/// "valgrind-3.19.0"; empty where there is none.
std::string valgrind_version() {
    std::string text = output_of("valgrind --version 2>/dev/null");
    return text.substr(0, text.find('\n'));
}

/// The functions of the C library's allocator: what they take depends on what was freed before.
constexpr std::array allocator{"malloc",   "calloc",        "realloc",       "free",
                               "memalign", "aligned_alloc", "posix_memalign"};

/// Counts what is done in `collect`, in a process that was started to do neither: callgrind counts
/// where it both instruments, which is slow, and collects, which entering and leaving the allocator
/// toggles.
class Instructions {
  public:
    explicit Instructions(fs::path dumps) : dumps_(std::move(dumps)) {}

    template <class Body> void collect(Body body) const {
        CALLGRIND_START_INSTRUMENTATION;
        CALLGRIND_TOGGLE_COLLECT;
        body();
        CALLGRIND_TOGGLE_COLLECT;
        CALLGRIND_STOP_INSTRUMENTATION;
    }
    /// All that was collected since the last call.
    std::uint64_t taken() {
        CALLGRIND_DUMP_STATS;
        const fs::path dump = fmt::format("{}.{}", dumps_.string(), ++n_dumps_);
        const std::string text = read_text(dump.string());
        fs::remove(dump);
        constexpr std::string_view label = "\ntotals: ";
        const std::size_t at = text.find(label);
        std::uint64_t count = 0;
        if (at == std::string::npos ||
            std::from_chars(text.data() + at + label.size(), text.data() + text.size(), count).ec !=
                std::errc())
            throw std::runtime_error(fmt::format("callgrind gave no totals in {}", dump.string()));
        return count;
    }

  private:
    fs::path dumps_;
    unsigned n_dumps_ = 0;
};

/// Another's updates and queries, collected.
class Collected final : public Contender {
  public:
    Collected(Contender& inner, const Instructions& instructions)
        : inner_(inner), instructions_(instructions) {}
    void build() override { inner_.build(); }
    void update(const Frame& frame) override {
        instructions_.collect([&] { inner_.update(frame); });
    }
    void query(Answers& answers) override {
        instructions_.collect([&] { inner_.query(answers); });
    }

  private:
    Contender& inner_;
    const Instructions& instructions_;
};

class Count {
  public:
    Count(results::Results& out, const fs::path& dumps) : out_(out), instructions_(dumps) {}

    void count(const PlannedCell& cell, const results::Check& check) {
        choose_scene(cell.scene);
        const Job job{&scene_, cell.task, cell.executor, cell.threads, cell.isa};
        if (cell.contender.unsupported(job)) // here, though not where it was prepared
            return;
        const KeepFloatingPointMode keep;
        const InstructionSetLimit limit(cell.isa);
        const std::unique_ptr<Contender> contender = cell.contender.make(job);
        const std::unique_ptr<Answers> answers = cell.task->make_answers();
        const auto add = [&](const char* counter) {
            out_.counters.push_back({check.cell_id, counter, instructions_.taken()});
        };
        contender->build();
        if (cell.task->phases() != Phases::query) {
            instructions_.collect([&] { contender->build(); });
            add("instructions_build");
        }
        if (cell.task->phases() == Phases::frames) {
            const auto pass = [&](Contender& played) {
                play(played, cell.task->plays_own_frames() ? nullptr : &*frames_, *answers, times_,
                     [](std::size_t, const Frame&) {});
            };
            pass(*contender);
            contender->build();
            Collected collected(*contender, instructions_);
            pass(collected);
            add("instructions_frames");
        } else if (cell.task->phases() != Phases::build) {
            answers->reserve(check.n_got);
            contender->query(*answers);
            instructions_.collect([&] { contender->query(*answers); });
            add("instructions_query");
        }
    }

  private:
    void choose_scene(const SceneSpec& spec) {
        if (std::string key = scene_key(spec); std::exchange(key_, key) == key)
            return;
        frames_.reset();
        scene_ = make_scene(spec);
        if (spec.moving) {
            frames_.emplace(spec.moving);
            times_.assign(frames_->size(), FrameTime{});
        }
    }

    results::Results& out_;
    Instructions instructions_;
    // Of the scene at hand.
    std::string key_;
    Scene scene_;
    std::optional<Frames> frames_; ///< if it moves
    std::vector<FrameTime> times_; ///< which say nothing here
};

} // namespace

bool is_counted(const PlannedCell& cell) {
    return !cell.contender.is_peer && cell.threads == 1 && !is_device(cell.executor);
}

std::vector<std::string> under_callgrind(const fs::path& dumps) {
    if (!has_requests)
        throw BadInput("--count: boxwood was built where there was no valgrind/callgrind.h: "
                       "install valgrind and build again");
    if (!sanitizers().empty())
        throw BadInput("--count: valgrind cannot run a build with sanitizers");
    if (valgrind_version().empty())
        throw BadInput("--count: there is no valgrind here: install it (Debian: apt-get install "
                       "valgrind)");
    std::string pattern;
    for (const char c : dumps.string())
        pattern += c == '%' ? "%%" : std::string(1, c);
    std::vector<std::string> words{"valgrind",
                                   "--command-line-only=yes", // none of files or the environment
                                   "--tool=callgrind",
                                   "--quiet",
                                   "--instr-atstart=no",
                                   "--callgrind-out-file=" + pattern};
    for (const char* function : allocator)
        words.push_back(fmt::format("--toggle-collect={}", function));
    words.push_back(fs::read_symlink("/proc/self/exe").string());
    return words;
}

results::Results count_instructions(const Plan& plan, results::Results prepared,
                                    const fs::path& dumps, const Report& report) {
    if (RUNNING_ON_VALGRIND == 0)
        throw BadInput("instructions are counted under valgrind alone: use boxwood sweep --count");
    const Calibrations calibrations = calibrations_of(prepared.texts.at("calibration"));
    std::map<std::uint32_t, results::Check> check_of;
    for (const results::Check& check : prepared.checks)
        check_of.emplace(check.cell_id, check);
    std::map<std::string, std::uint32_t, std::less<>> id_of;
    for (const results::Cell& cell : prepared.cells)
        id_of.emplace(cell.name, cell.cell_id);
    prepared.texts["instructions_by"] = fmt::format("{}, {}, {}, glibc {}", valgrind_version(),
                                                    isa_used(), compiler(), gnu_get_libc_version());
    Count count(prepared, dumps);
    const auto total = static_cast<std::size_t>(std::ranges::count_if(plan.cells, is_counted));
    std::size_t done = 0;
    for (const PlannedCell& cell : plan.cells) {
        if (!is_counted(cell))
            continue;
        report(done++, total, cell.name);
        if (calibrations.contains(cell.name))
            count.count(cell, check_of.at(id_of.at(cell.name)));
    }
    return prepared;
}

} // namespace boxwood::bench
