/// `query pairs`: two trees print the same, or refuse the same.

#include "bench/fuzz/csv.h"

namespace boxwood::fuzz {

void box_csv(Bytes bytes) {
    static const ScratchFile file(".csv");
    bench::PairsQuery query;
    query.boxes = file.holding(bytes).string();
    query.tree = tree_of("median", "binary");
    const auto first = printed(query);
    query.tree = tree_of("ploc", "packed");
    require(printed(query) == first, "two trees print different pairs");
}

} // namespace boxwood::fuzz
