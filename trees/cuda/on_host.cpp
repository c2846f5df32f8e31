#undef _FORTIFY_SOURCE // its longjmp refuses to go from stack to stack
#include "trees/cuda/on_host.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstddef>
#include <memory>
#include <new>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <ucontext.h>
#include <utility>
#include <vector>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif

namespace boxwood::on_host {
namespace {

constexpr std::size_t stack_bytes = std::size_t{64} << 10;
constexpr std::size_t max_threads = 1024;

std::uint64_t current_seed = 1;

/// The threads of one block as fibres: each with a stack of its own, one at a time.
class Block {
  public:
    Block(unsigned n_threads, const std::function<void()>& thread, std::uint64_t seed)
        : thread_(thread), random_(seed), fibres_(n_threads) {
        if (n_threads == 0 || n_threads > max_threads)
            throw Fault("a block has 1 to 1024 threads, not " + std::to_string(n_threads));
    }

    void run() {
        running = this;
        static std::vector<Context> contexts(max_threads);
        for (std::size_t i = 0; i < fibres_.size(); ++i)
            begin(*(fibres_[i].own = &contexts[i]));
        std::vector<unsigned> ready;
        for (unsigned left = static_cast<unsigned>(fibres_.size()); left > 0;) {
            ready.clear();
            for (unsigned i = 0; i < fibres_.size(); ++i)
                if (fibres_[i].state == State::ready)
                    ready.push_back(i);
            if (ready.empty())
                end("no thread can go on: " + waiting_text());
            // Some turns, then another choice: to look for the ready ones at each turn is slow.
            std::shuffle(ready.begin(), ready.end(), random_);
            ready.resize(1 + random_() % ready.size()); // some get ahead of others
            for (const unsigned i : ready) {
                current_ = i;
                threadIdx = {i, 0, 0};
                enter(fibres_[i]);
                if (!fault_.empty())
                    end(fault_);
                left -= fibres_[i].state == State::done;
            }
        }
    }

    std::uint64_t meet(Meeting meeting, unsigned mask, std::uint64_t value, unsigned from) {
        Fibre& self = fibres_[current_];
        const unsigned lane = current_ % 32;
        if (meeting != Meeting::block && (mask >> lane & 1) == 0)
            fail("lane " + std::to_string(lane) + " is not in its own mask");
        if (meeting == Meeting::shuffle && (mask >> from & 1) == 0)
            fail("lane " + std::to_string(lane) + " reads lane " + std::to_string(from) +
                 ", which is not in the mask");
        if (!fault_.empty())
            leave();
        self.meeting = meeting;
        self.mask = mask;
        self.value = value;
        self.from = from;
        self.state = State::waiting;
        if (meeting == Meeting::block)
            meet_block();
        else
            meet_warp(self);
        leave();
        return fibres_[current_].result;
    }

    void give_way() {
        if (random_() % 4 == 0)
            leave();
    }

    static Block* running;

  private:
    enum class State : std::uint8_t { ready, waiting, done };
    /// A stack, and where on it a thread goes on. One whose thread has ended takes another.
    struct Context {
        std::unique_ptr<std::byte[]> stack;
        ucontext_t start;
        std::jmp_buf at;
        bool begun = false;
    };
    struct Fibre {
        Context* own = nullptr;
        State state = State::ready;
        Meeting meeting = Meeting::block;
        unsigned mask = 0, from = 0;
        std::uint64_t value = 0, result = 0;
    };

    static void begin(Context& context) {
        if (context.begun)
            return;
        if (!context.stack)
            context.stack = std::make_unique_for_overwrite<std::byte[]>(stack_bytes);
        getcontext(&context.start);
        context.start.uc_stack.ss_sp = context.stack.get();
        context.start.uc_stack.ss_size = stack_bytes;
        context.start.uc_link = nullptr;
        makecontext(&context.start, &Block::main, 0);
    }

    static void main() {
        for (;;) {
            switched_from(nullptr);
            running->thread_();
            running->fibres_[running->current_].state = State::done;
            running->leave();
        }
    }

    [[noreturn]] void end(const std::string& fault) {
        for (Fibre& fibre : fibres_)
            if (fibre.state != State::done)
                fibre.own->begun = false;
        throw Fault(fault);
    }

    void enter(Fibre& fibre) {
        about_to_switch(&fake_stack_, fibre.own->stack.get(), stack_bytes);
        go(*fibre.own);
        switched_from(fake_stack_);
    }
    void leave() {
        Fibre& self = fibres_[current_];
        void* fake = nullptr;
        about_to_switch(self.state == State::done ? nullptr : &fake, main_stack_, main_bytes_);
        go_back(*self.own);
        switched_from(fake);
    }

#if defined(__SANITIZE_ADDRESS__)
    void go(Context& context) { swapcontext(&scheduler_, &context.start); }
    void go_back(Context& context) { swapcontext(&context.start, &scheduler_); }
#else
    // Without the system call that swapcontext makes each time.
    void go(Context& context) {
        if (_setjmp(back_) != 0)
            return;
        if (std::exchange(context.begun, true))
            _longjmp(context.at, 1);
        setcontext(&context.start);
    }
    void go_back(Context& context) {
        if (_setjmp(context.at) == 0)
            _longjmp(back_, 1);
    }
    std::jmp_buf back_;
#endif

    /// run() throws it once this thread leaves, for good: it holds nothing then that would leak.
    void fail(const std::string& what) {
        fault_ = "thread " + std::to_string(current_) + ": " + what;
    }

    void meet_block() {
        if (++at_barrier_ < fibres_.size())
            return;
        at_barrier_ = 0;
        for (Fibre& fibre : fibres_)
            fibre.state = State::ready;
    }

    void meet_warp(const Fibre& self) {
        const std::size_t first = current_ / 32 * 32;
        unsigned& waiting = waiting_[current_ / 32];
        const unsigned others = waiting & self.mask;
        waiting |= 1u << current_ % 32;
        if (others != 0 && (waiting & self.mask) != self.mask) { // all of it when all have come
            const Fibre& other =
                fibres_[first + static_cast<std::size_t>(std::countr_zero(others))];
            if (other.meeting == self.meeting && other.mask == self.mask)
                return;
        }
        const auto each_lane = [&](auto&& visit) {
            for (unsigned lane = 0; lane < 32; ++lane)
                if (self.mask >> lane & 1)
                    visit(lane);
        };
        std::uint64_t votes = 0;
        bool all = true;
        each_lane([&](unsigned lane) {
            if (first + lane >= fibres_.size())
                return fail("the mask has lane " + std::to_string(lane) +
                            ", which the block has not");
            const Fibre& other = fibres_[first + lane];
            if (other.state == State::waiting && other.meeting != Meeting::block &&
                (other.meeting != self.meeting || other.mask != self.mask))
                fail("lane " + std::to_string(lane) +
                     " of its mask waits at another operation or with another mask");
            all = all && other.state == State::waiting && other.meeting == self.meeting;
            votes |= std::uint64_t{other.value != 0} << lane;
        });
        if (!all || !fault_.empty())
            return;
        waiting &= ~self.mask;
        each_lane([&](unsigned lane) {
            Fibre& other = fibres_[first + lane];
            other.result = self.meeting == Meeting::ballot    ? votes
                           : self.meeting == Meeting::shuffle ? fibres_[first + other.from].value
                                                              : 0;
            other.state = State::ready;
        });
    }

    std::string waiting_text() const {
        const char* const names[] = {"__syncthreads", "__syncwarp", "a vote", "a shuffle"};
        std::size_t done = 0;
        std::string text;
        for (std::size_t i = 0; i < fibres_.size(); ++i)
            if (fibres_[i].state == State::done)
                ++done;
            else if (text.empty())
                text = "thread " + std::to_string(i) + " waits at " +
                       names[static_cast<std::size_t>(fibres_[i].meeting)];
        return text + "; " + std::to_string(done) + " of " + std::to_string(fibres_.size()) +
               " threads have ended";
    }

#if defined(__SANITIZE_ADDRESS__)
    static void about_to_switch(void** fake, const void* bottom, std::size_t size) {
        __sanitizer_start_switch_fiber(fake, bottom, size);
    }
    static void switched_from(void* fake) {
        const void* bottom = nullptr;
        std::size_t size = 0;
        __sanitizer_finish_switch_fiber(fake, &bottom, &size);
        if (!running->main_stack_) { // the first switch is from the thread that runs the grid
            running->main_stack_ = bottom;
            running->main_bytes_ = size;
        }
    }
#else
    static void about_to_switch(void**, const void*, std::size_t) {}
    static void switched_from(void*) {}
#endif

    const std::function<void()>& thread_;
    std::mt19937_64 random_;
    std::vector<Fibre> fibres_;
    [[maybe_unused]] ucontext_t scheduler_{};
    unsigned current_ = 0;
    std::size_t at_barrier_ = 0;
    std::array<unsigned, max_threads / 32> waiting_{}; ///< lanes of each warp, at its operations
    std::string fault_;
    void* fake_stack_ = nullptr;
    const void* main_stack_ = nullptr;
    std::size_t main_bytes_ = 0;
};

Block* Block::running = nullptr;

} // namespace

void set_seed(std::uint64_t seed) { current_seed = seed; }

void run_grid(unsigned n_blocks, unsigned n_threads, const std::function<void()>& thread) {
    std::vector<unsigned> order(n_blocks);
    std::iota(order.begin(), order.end(), 0u);
    std::mt19937_64 random(current_seed);
    std::shuffle(order.begin(), order.end(), random);
    gridDim = {n_blocks, 1, 1};
    blockDim = {n_threads, 1, 1};
    for (const unsigned block : order) {
        blockIdx = {block, 0, 0};
        Block(n_threads, thread, random()).run();
    }
}

namespace {

constexpr std::size_t line = 64; ///< before each allocation stands its size
constexpr std::byte released{0xdd};
std::uint64_t memory = std::uint64_t{1} << 36, taken = 0;
unsigned watchers = 0; ///< of what is released
std::vector<std::byte*> watched;
std::vector<std::function<void()>>* recording = nullptr;

std::size_t& size_of(std::byte* block) { return *reinterpret_cast<std::size_t*>(block); }
void free(std::byte* block) { ::operator delete (block, std::align_val_t{line}); }

} // namespace

void set_free_memory(std::uint64_t bytes) { memory = taken + bytes; }
std::uint64_t free_memory() { return memory > taken ? memory - taken : 0; }

void* allocate(std::size_t bytes) {
    if (bytes > free_memory())
        throw Fault("an array of " + std::to_string(bytes) + " bytes is more than the " +
                    std::to_string(free_memory()) + " that are free");
    auto* const block =
        static_cast<std::byte*>(::operator new (bytes + line, std::align_val_t{line}));
    size_of(block) = bytes;
    taken += bytes;
    return block + line;
}
void release(void* at) {
    auto* const block = static_cast<std::byte*>(at) - line;
    taken -= size_of(block);
    if (watchers == 0)
        return free(block);
    std::fill_n(block + line, size_of(block), released);
    watched.push_back(block);
}

Released::Released() { ++watchers; }
Released::~Released() {
    if (--watchers > 0)
        return;
    std::ranges::for_each(watched, free);
    watched.clear();
}
void Released::require_untouched() const {
    for (std::byte* block : watched)
        if (std::ranges::any_of(std::span(block + line, size_of(block)),
                                [](std::byte byte) { return byte != released; }))
            throw Fault("an array of " + std::to_string(size_of(block)) +
                        " bytes was written to after it was released");
}

void in_turn(std::function<void()> work) {
    if (recording)
        recording->push_back(std::move(work));
    else
        work();
}
std::vector<std::function<void()>> record(const std::function<void()>& enqueue) {
    std::vector<std::function<void()>> work;
    const auto* const before = std::exchange(recording, &work);
    try {
        enqueue();
    } catch (...) {
        recording = nullptr;
        throw;
    }
    recording = nullptr;
    if (before)
        throw Fault("a graph within a graph");
    return work;
}
bool is_recording() { return recording != nullptr; }

std::uint64_t meet(Meeting meeting, unsigned mask, std::uint64_t value, unsigned from) {
    return Block::running->meet(meeting, mask, value, from);
}

void give_way() { Block::running->give_way(); }

} // namespace boxwood::on_host
