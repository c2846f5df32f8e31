#include "bench/truth/truth.h"

namespace boxwood::bench {

std::string_view to_string(Status status) {
    switch (status) {
    case Status::exact:
        return "exact";
    case Status::conservative:
        return "conservative";
    case Status::within_bound:
        return "within_bound";
    case Status::wrong:
        return "wrong";
    case Status::unsupported:
        break;
    }
    return "unsupported";
}

} // namespace boxwood::bench
