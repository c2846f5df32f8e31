#pragma once

#include <stdexcept>

namespace boxwood {

/// Bad usage or bad input: the message says what, where and how to fix it.
class BadInput : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace boxwood
