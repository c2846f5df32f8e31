#pragma once

#include "trees/builder.h"

#include <gtest/gtest.h>

#include <string>

namespace boxwood {

/// A test of one builder, run for each of the registry and named after it: TEST_P(EachBuilder, ...)
/// in any file is found by `scripts/test --only NAME`.
class EachBuilder : public testing::TestWithParam<std::string> {
  protected:
    const BuilderEntry& builder_ = find_builder(GetParam());

    Tree build(Boxes boxes, const Executor& executor = serial()) const {
        return builder_.make({})(boxes, executor);
    }
};

} // namespace boxwood
