#include "trees/executor.h"

#include "kernels/arithmetic/float_mode.h"

namespace boxwood {
namespace {

class Serial final : public Executor {
  public:
    unsigned threads() const override { return 1; }
    void for_each(std::size_t n, FunctionRef<void(std::size_t)> body) const override {
        const DenormalFlushing off(false);
        for (std::size_t i = 0; i < n; ++i)
            body(i);
    }
};

} // namespace

const Executor& serial() {
    static const Serial executor;
    return executor;
}

ExecutorEntry serial_executor() {
    return {"serial", "one thread, the caller's own",
            [](unsigned) -> std::unique_ptr<Executor> { return std::make_unique<Serial>(); }, 1};
}

} // namespace boxwood
