#pragma once

#include "scenes/hard_cases/rounded.h"

namespace boxwood {

/// Pairs of size 1 near the origin, which other families move or scale. What they do before their
/// coordinates are rounded is in the name; only an oracle knows what they do after it.

/// Half of the pairs hit, by far.
TrianglePairCase draw_generic_pair(Draws& draws);
/// a.a lies on the face of b, every fourth time on its edge; the rest of a on one side.
TrianglePairCase draw_vertex_on_face(Draws& draws);
/// The edges a.a a.b and b.a b.b cross; the rest is on two sides of them.
TrianglePairCase draw_edge_on_edge(Draws& draws);

} // namespace boxwood
