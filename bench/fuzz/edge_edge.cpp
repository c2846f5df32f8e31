/// tight_inclusion against rationals, and these against themselves: with the edges, and the ends of
/// one, in the other order, and backward in time.

#include "bench/fuzz/motion.h"

namespace boxwood::fuzz {

void edge_edge(Bytes bytes) {
    LinearMotion motion;
    oracle::RationalMotion exact;
    if (!read_motion(bytes, motion, exact))
        return;
    const Impact truth = oracle::edge_edge(exact);
    judge(fast_tight_inclusion().edge_edge(motion), truth);
    require_same(oracle::edge_edge(swapped(exact, 0, 1)), truth, "for an edge turned round");
    require_same(oracle::edge_edge(swapped(swapped(exact, 0, 2), 1, 3)), truth,
                 "for the edges in the other order");
    require(oracle::edge_edge(backward(exact)).answer == truth.answer,
            "the exact answer is another backward in time");
}

} // namespace boxwood::fuzz
