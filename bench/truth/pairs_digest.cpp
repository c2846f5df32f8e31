#include "bench/truth/pairs_digest.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace boxwood::bench {

PairsDigest digest_of(std::span<const Pair> pairs) {
    PairsDigest digest;
    for (const Pair p : pairs)
        digest.add(p);
    return digest;
}

std::vector<Pair> sorted_pairs(std::vector<std::vector<Pair>> parts) {
    std::vector<Pair> all;
    for (std::vector<Pair>& part : parts) {
        all.insert(all.end(), part.begin(), part.end());
        part = {}; // never twice in memory
    }
    std::ranges::sort(all);
    return all;
}

PairsDifference difference(std::span<const Pair> expected, std::vector<Pair> got) {
    std::ranges::sort(got);
    std::vector<Pair> missing, extra;
    std::ranges::set_difference(expected, got, std::back_inserter(missing));
    std::ranges::set_difference(got, expected, std::back_inserter(extra));
    PairsDifference wrong{missing.size(), extra.size(), {}};
    if (!missing.empty())
        wrong.witness = fmt::format("missing ({},{})", missing[0].a, missing[0].b);
    else if (!extra.empty())
        wrong.witness = fmt::format("extra ({},{})", extra[0].a, extra[0].b);
    return wrong;
}

} // namespace boxwood::bench
