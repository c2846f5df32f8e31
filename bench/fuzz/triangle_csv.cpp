/// `query triangles`: an exact kernel prints what rationals do.

#include "bench/fuzz/csv.h"

namespace boxwood::fuzz {

void triangle_csv(Bytes bytes) {
    static const ScratchFile file(".csv");
    bench::TrianglesQuery query;
    query.pairs = file.holding(bytes).string();
    const auto first = printed(query);
    query.kernel = "rational";
    require(printed(query) == first, "the exact kernel prints what rationals do not");
    query.kernel = {};
    query.distance = query.format.json = true;
    require(printed(query).has_value() == first.has_value(), "distances refuse what touch takes");
}

} // namespace boxwood::fuzz
