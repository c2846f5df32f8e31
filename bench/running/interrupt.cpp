#include "bench/running/interrupt.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

namespace boxwood::bench {
namespace {

constexpr int ending_signals[] = {SIGINT, SIGTERM};
std::atomic<bool> ctrl_c_pressed = false;
static_assert(std::atomic<bool>::is_always_lock_free); // a signal handler may set it

} // namespace

Interrupt::Interrupt() {
    sigset_t caught;
    sigemptyset(&caught);
    sigaddset(&caught, SIGINT);
    sigaddset(&caught, SIGTERM);
    descriptor_ = signalfd(-1, &caught, SFD_CLOEXEC);
    if (descriptor_ < 0)
        throw std::system_error(errno, std::generic_category(), "signalfd");
    pthread_sigmask(SIG_BLOCK, &caught, &before_);
}

Interrupt::~Interrupt() {
    while (requested_) { // take what is pending, lest it arrive when unblocked
        pollfd waiting{descriptor_, POLLIN, 0};
        signalfd_siginfo info;
        if (poll(&waiting, 1, 0) != 1 || read(descriptor_, &info, sizeof info) != sizeof info)
            break;
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    close(descriptor_);
}

bool Interrupt::requested() {
    pollfd waiting{descriptor_, POLLIN, 0};
    if (poll(&waiting, 1, 0) == 1)
        requested_ = true;
    return requested_;
}

CtrlC::CtrlC() {
    ctrl_c_pressed = false;
    struct sigaction note {};
    note.sa_handler = [](int) { ctrl_c_pressed = true; };
    note.sa_flags = SA_RESTART | SA_RESETHAND;
    for (int i = 0; i < 2; ++i) {
        sigaction(ending_signals[i], nullptr, &before_[i]);
        if (before_[i].sa_handler != SIG_IGN)
            sigaction(ending_signals[i], &note, nullptr);
    }
}

CtrlC::~CtrlC() {
    for (int i = 0; i < 2; ++i)
        sigaction(ending_signals[i], &before_[i], nullptr);
}

bool CtrlC::pressed() { return ctrl_c_pressed.load(std::memory_order_relaxed); }

} // namespace boxwood::bench
