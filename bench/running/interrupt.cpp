#include "bench/running/interrupt.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace boxwood::bench {

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

} // namespace boxwood::bench
