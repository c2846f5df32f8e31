#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>

namespace boxwood {

/// Calls test() with each instruction set that was compiled in and that this machine has.
template <class Test> void on_every_target(const Test& test) {
    const auto use = [](std::int64_t targets) {
        hwy::SetSupportedTargetsForTest(targets);
        // What dispatches next would keep the old choice.
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    };
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        use(target);
        test();
    }
    use(0);
}

} // namespace boxwood
