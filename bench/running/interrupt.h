#pragma once

#include <csignal>

namespace boxwood::bench {

/// Turns Ctrl-C and SIGTERM into something to look at: while it lives the signals are blocked, and
/// arrive at a descriptor that can be polled. They end nothing by themselves.
class Interrupt {
  public:
    /// Throws std::system_error if the descriptor cannot be made.
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;

    /// Readable as soon as there was a signal.
    int descriptor() const { return descriptor_; }
    /// Whether there was one; stays true.
    bool requested();
    /// What was blocked before, for child processes.
    const sigset_t& mask_before() const { return before_; }

  private:
    sigset_t before_;
    int descriptor_ = -1;
    bool requested_ = false;
};

/// For work in threads of this process: while it lives, the first Ctrl-C or SIGTERM is noted, and a
/// second one ends the process as it did before. One at a time.
class CtrlC {
  public:
    CtrlC();
    ~CtrlC();
    CtrlC(const CtrlC&) = delete;

    static bool pressed();

  private:
    struct sigaction before_[2];
};

} // namespace boxwood::bench
