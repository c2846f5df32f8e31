/// tight_inclusion against rationals, and these against themselves: with the corners of the face in
/// another order, and backward in time.

#include "bench/fuzz/motion.h"

namespace boxwood::fuzz {

void vertex_face(Bytes bytes) {
    LinearMotion motion;
    oracle::RationalMotion exact;
    if (!read_motion(bytes, motion, exact))
        return;
    const Impact truth = oracle::vertex_face(exact);
    judge(fast_tight_inclusion().vertex_face(motion), truth);
    require_same(oracle::vertex_face(swapped(exact, 1, 3)), truth, "for the face turned over");
    require_same(oracle::vertex_face(swapped(swapped(exact, 1, 2), 2, 3)), truth,
                 "for the corners turned round");
    require(oracle::vertex_face(backward(exact)).answer == truth.answer,
            "the exact answer is another backward in time");
}

} // namespace boxwood::fuzz
