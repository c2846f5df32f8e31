#pragma once

#include <stdexcept>
#include <string>

namespace boxwood {

/// What f says by the exception E that it throws; "no error" if it throws none.
template <class E = std::invalid_argument, class F> std::string complaint_of(const F& f) {
    try {
        f();
    } catch (const E& error) {
        return error.what();
    }
    return "no error";
}

} // namespace boxwood
